// Removal of elements from a moving body, against a body without these elements, and conservation.
#include <palpate/assembly/detail/batched_tetrahedra.hpp>
#include <palpate/assembly/detail/element_frequency.hpp>
#include <palpate/cut/detail/cut_physics.hpp>
#include <palpate/cut/detail/cut_topology.hpp>
#include <palpate/cut/detail/motion_of_part.hpp>
#include <palpate/integrator/explicit_motion.hpp>
#include <palpate/integrator/explicit_schemes.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/model/moving/detail/corotated_motion.hpp>
#include <palpate/testing/allocation_counter.hpp>

#include <Eigen/Geometry>

#include "catch.hpp"
#include "refused.hpp"

#include <numeric>

using namespace palpate;

namespace {

using CorotatedMaterial = Corotational<LinearElastic>;
using CorotatedBody = HyperelasticBody<Tet4, CorotatedMaterial>;
template <class Preconditioner = BlockJacobi>
using CorotatedSteps = CorotatedMotion<LinearElastic, double, Preconditioner>;
using Explicit = ExplicitMotion<BatchedTetrahedra<NeoHookean>, CentralDifference>;

const NeoHookean rubber{.youngs_modulus = 3e3, .poisson_ratio = 0.4, .density = 1000.0};
const Vector3 gravity(0.0, 0.0, -9.81);

Mesh<Tet4> bar() {
  return box_tet4({0.12, 0.04, 0.04}, {6, 2, 2}, BoxSplit::six);
}
/// The elements of the two middle layers of cells.
std::vector<char> middle_of(const Mesh<Tet4>& mesh) {
  std::vector<char> gone;
  for (Index e = 0; e < mesh.element_count(); ++e) {
    double x = 0.0;
    for (int a = 0; a < 4; ++a) x += 0.25 * mesh.position(mesh.element_node(e, a))[0];
    gone.push_back(x > 0.04 && x < 0.08 ? 1 : 0);
  }
  return gone;
}
/// The mesh without these elements and without nodes that only they use; `number` gets the new ids, -1 if removed.
Mesh<Tet4> without(const Mesh<Tet4>& mesh, const std::vector<char>& gone, std::vector<NodeId>& number) {
  Mesh<Tet4> rest;
  number.assign(mesh.positions.size(), -1);
  for (Index e = 0; e < mesh.element_count(); ++e)
    if (gone[static_cast<std::size_t>(e)] == 0)
      for (int a = 0; a < 4; ++a) number[static_cast<std::size_t>(mesh.element_node(e, a))] = 0;
  for (std::size_t i = 0; i < number.size(); ++i)
    if (number[i] == 0) {
      number[i] = static_cast<NodeId>(rest.positions.size());
      rest.positions.push_back(mesh.positions[i]);
    }
  for (Index e = 0; e < mesh.element_count(); ++e) {
    if (gone[static_cast<std::size_t>(e)] != 0) continue;
    auto& nodes = rest.elements.emplace_back();
    for (int a = 0; a < 4; ++a)
      nodes[static_cast<std::size_t>(a)] = number[static_cast<std::size_t>(mesh.element_node(e, a))];
    rest.regions.push_back(mesh.region(e));
  }
  rest.region_names = mesh.region_names;
  return rest;
}
VectorX pick(const VectorX& all, const std::vector<NodeId>& number) {
  VectorX some(3 * std::ranges::count_if(number, [](NodeId n) { return n >= 0; }));
  for (std::size_t i = 0; i < number.size(); ++i)
    if (number[i] >= 0) some.segment<3>(3 * Index{number[i]}) = all.segment<3>(3 * static_cast<Index>(i));
  return some;
}
std::vector<Index> all_free(Index nodes) {
  std::vector<Index> dofs(static_cast<std::size_t>(3 * nodes));
  std::iota(dofs.begin(), dofs.end(), Index{0});
  return dofs;
}
/// Displacement of a bar that is stretched and rotates.
VectorX drawn_out(const Mesh<Tet4>& mesh) {
  VectorX u(3 * mesh.node_count());
  for (Index i = 0; i < mesh.node_count(); ++i) u.segment<3>(3 * i) = Vector3(0.1 * (mesh.position(i)[0] - 0.06), 0, 0);
  return u;
}
VectorX spinning(const Mesh<Tet4>& mesh) {
  VectorX v(3 * mesh.node_count());
  for (Index i = 0; i < mesh.node_count(); ++i)
    v.segment<3>(3 * i) = Vector3(0.3, 0.1, -0.2) + Vector3(0, 3.0, 8.0).cross(mesh.position(i));
  return v;
}
Vector3 momentum(const VectorX& nodal_mass, const VectorX& v) {
  Vector3 sum = Vector3::Zero();
  for (Index i = 0; i < nodal_mass.size(); ++i) sum += nodal_mass[i] * v.segment<3>(3 * i);
  return sum;
}
Explicit explicit_bar(const Mesh<Tet4>& mesh) {
  const auto body = make_hyperelastic_body<Tet4, NeoHookean>(mesh, std::vector<NeoHookean>{rubber});
  return {BatchedTetrahedra<NeoHookean>(body), lumped_mass(body.rest), all_free(mesh.node_count()),
          element_frequency_bound(body.rest)};
}
VectorX mass_of(const Mesh<Tet4>& mesh, const std::vector<char>& gone) {
  return lumped_mass(make_hyperelastic_body<Tet4, NeoHookean>(mesh, std::vector<NeoHookean>{rubber}).rest,
                     [&](Index e) { return gone[static_cast<std::size_t>(e)] != 0; });
}
double largest(const VectorX& x) {
  return x.cwiseAbs().maxCoeff();
}

CorotatedBody corotated(const Mesh<Tet4>& mesh) {
  return make_hyperelastic_body(mesh, std::vector<CorotatedMaterial>{{{5e3, 0.4, 1000.0}}});
}
CorotatedMotionOptions solved(TimeScheme scheme) {
  return {.scheme = scheme, .mass_damping = 0.3, .stiffness_damping = 2e-4, .solve = {3000, 1e-14}};
}

/// Removes elements from a falling, bent body during its motion; compares with a body that starts without them.
template <class Preconditioner>
double difference_to_fresh(TimeScheme scheme) {
  const auto mesh = bar();
  const auto gone = middle_of(mesh);
  const auto is_gone = [&](Index e) { return gone[static_cast<std::size_t>(e)] != 0; };
  std::vector<NodeId> number;
  const auto rest = without(mesh, gone, number);
  const Scene scene = Scene().gravity(gravity);
  CorotatedSteps<Preconditioner> motion(corotated(mesh), scene, solved(scheme));
  motion.set_state(drawn_out(mesh), spinning(mesh));
  for (int k = 0; k < 20; ++k) REQUIRE(motion.step(1e-3).taken);

  CorotatedSteps<Preconditioner> fresh(corotated(rest), scene, solved(scheme));
  fresh.set_state(pick(motion.displacement(), number), pick(motion.velocity(), number));
  const CutPhysics<Tet4> physics(corotated(mesh).rest, extract_boundary<Tet4>(mesh), scene);
  motion.remove_elements(is_gone, lumped_mass(corotated(mesh).rest, is_gone), physics.load_left(is_gone));
  const VectorX where = motion.displacement();
  double worst = 0.0;
  for (int k = 0; k < 60; ++k) {
    REQUIRE(motion.step(1e-3).taken);
    REQUIRE(fresh.step(1e-3).taken);
    worst = std::max(worst, largest(pick(motion.displacement(), number) - fresh.displacement()));
  }
  for (std::size_t i = 0; i < number.size(); ++i)  // nodes without an element do not move
    if (number[i] < 0) {
      const Index at = 3 * static_cast<Index>(i);
      CHECK((motion.displacement() - where).template segment<3>(at).norm() == 0.0);
      CHECK(motion.velocity().template segment<3>(at).norm() == 0.0);
    }
  return worst / largest(fresh.displacement());
}

}  // namespace

TEST_CASE("explicit motion after a removal equals that of a body without the elements", "[model][cut]") {
  const auto mesh = bar();
  const auto gone = middle_of(mesh);
  std::vector<NodeId> number;
  const auto rest = without(mesh, gone, number);
  Explicit motion = explicit_bar(mesh), fresh = explicit_bar(rest);
  motion.set(drawn_out(mesh), spinning(mesh));
  const double dt = 0.7 * std::min(motion.limit(), fresh.limit());
  for (int k = 0; k < 30; ++k) REQUIRE(motion.step(dt).ok());
  fresh.set(pick(motion.state().displacement, number), pick(motion.state().velocity, number));
  motion.remove_elements([&](Index e) { return gone[static_cast<std::size_t>(e)] != 0; }, mass_of(mesh, gone));
  CHECK(std::abs(motion.stored_energy() - fresh.stored_energy()) <= 1e-12 * fresh.stored_energy());
  CHECK(std::abs(motion.limit() - fresh.limit()) <= 0.05 * fresh.limit());
  for (int k = 0; k < 300; ++k) {
    REQUIRE(motion.step(dt).ok());
    REQUIRE(fresh.step(dt).ok());
  }
  CHECK(largest(pick(motion.state().displacement, number) - fresh.state().displacement) <=
        1e-11 * largest(fresh.state().displacement));
  CHECK(motion.deformation().inverted == fresh.deformation().inverted);
  CHECK(std::abs(motion.deformation().smallest_volume_ratio - fresh.deformation().smallest_volume_ratio) < 1e-11);
}

TEST_CASE("a stretched bar separates when its middle is removed; both ends conserve momentum", "[model][cut]") {
  const auto mesh = bar();
  const auto gone = middle_of(mesh);
  Explicit motion = explicit_bar(mesh);
  motion.set(drawn_out(mesh), spinning(mesh));
  const VectorX mass = mass_of(mesh, gone);
  motion.remove_elements([&](Index e) { return gone[static_cast<std::size_t>(e)] != 0; }, mass);
  const double dt = 0.5 * motion.limit(), energy = motion.kinetic_energy() + motion.stored_energy();
  VectorX left = mass, right = mass;
  for (Index i = 0; i < mass.size(); ++i) (mesh.position(i)[0] < 0.06 ? right : left)[i] = 0.0;
  const Vector3 before[2] = {momentum(left, motion.state().velocity), momentum(right, motion.state().velocity)};
  const auto steps = static_cast<int>(0.1 / dt);
  const testing::AllocationScope scope;
  for (int k = 0; k < steps; ++k) motion.step(dt);
  const auto calls = scope.allocations();
  CHECK(calls == 0);
  // Neither end acts on the other: each conserves its own momentum, and they separate accordingly.
  CHECK((momentum(left, motion.state().velocity) - before[0]).norm() <= 1e-12 * before[0].norm());
  CHECK((momentum(right, motion.state().velocity) - before[1]).norm() <= 1e-12 * before[1].norm());
  const Vector3 relative = before[1] / right.sum() - before[0] / left.sum();
  const Vector3 parted = (momentum(right, motion.state().displacement - drawn_out(mesh)) / right.sum() -
                          momentum(left, motion.state().displacement - drawn_out(mesh)) / left.sum());
  CHECK((parted - steps * dt * relative).norm() <= 1e-12 * parted.norm());
  CHECK(relative.norm() > 0.1);
  CHECK(std::abs(motion.kinetic_energy() + motion.stored_energy() - energy) <= 0.02 * energy);
}

TEST_CASE("elements are removed from an explicit body one by one, down to the last", "[model][cut][extreme][F1]") {
  const auto mesh = bar();
  std::vector<char> gone(static_cast<std::size_t>(mesh.element_count()), 0);
  Explicit motion = explicit_bar(mesh);
  motion.set(drawn_out(mesh), spinning(mesh));
  const double whole = mass_of(mesh, gone).sum();
  double dt = 0.4 * motion.limit();
  double left = whole;
  for (Index k = 0; k < mesh.element_count(); ++k) {
    gone[static_cast<std::size_t>((k * 37) % mesh.element_count())] = 1;  // 37 is coprime to 144
    const VectorX mass = mass_of(mesh, gone);
    motion.remove_elements([&](Index e) { return gone[static_cast<std::size_t>(e)] != 0; }, mass);
    left -= whole / static_cast<double>(mesh.element_count());
    REQUIRE(std::abs(mass.sum() - left) <= 1e-12 * whole);
    dt = std::min(dt, motion.limit());
    for (int i = 0; i < 5; ++i) {
      const Status status = motion.step(dt);
      REQUIRE((!status.has(StatusFlag::step_refused) && !status.has(StatusFlag::energy_grew)));
      REQUIRE(motion.state().displacement.allFinite());
    }
  }
  CHECK(motion.state().free.empty());
  CHECK(motion.kinetic_energy() == 0.0);
  VectorX heavier = mass_of(mesh, gone);
  heavier[0] = 1.0;
  CHECK_REFUSED(SetupErrorKind::bad_density, motion.remove_elements([](Index) { return true; }, heavier));
}

TEST_CASE("co-rotated motion after a removal equals that of a body without the elements", "[model][corotated][cut]") {
  CHECK(difference_to_fresh<BlockJacobi>(TimeScheme::implicit_euler()) <= 1e-10);
  CHECK(difference_to_fresh<BlockJacobi>(TimeScheme::newmark()) <= 1e-10);
  CHECK(difference_to_fresh<CorotatedFactor>(TimeScheme::implicit_euler()) <= 1e-10);  // factor of the full body
}

TEST_CASE("fragments of a co-rotated body conserve momentum, in single precision too", "[model][corotated][cut]") {
  const auto mesh = bar();
  const auto gone = middle_of(mesh);
  const auto is_gone = [&](Index e) { return gone[static_cast<std::size_t>(e)] != 0; };
  CorotatedMotion<LinearElastic, float> motion(corotated(mesh), Scene(), {.solve = {300, 1e-6}});
  motion.set_state(drawn_out(mesh), spinning(mesh));
  const VectorX mass = lumped_mass(corotated(mesh).rest, is_gone);
  motion.remove_elements(is_gone, mass, VectorX::Zero(motion.size()));
  VectorX left = mass;
  for (Index i = 0; i < mass.size(); ++i)
    if (mesh.position(i)[0] > 0.06) left[i] = 0.0;
  const Vector3 before = momentum(mass, motion.velocity()), of_left = momentum(left, motion.velocity());
  for (int k = 0; k < 100; ++k) REQUIRE(motion.step(1e-3).taken);
  CHECK((momentum(mass, motion.velocity()) - before).norm() <= 1e-4 * before.norm());
  CHECK((momentum(left, motion.velocity()) - of_left).norm() <= 1e-4 * before.norm());
  CHECK_REFUSED(SetupErrorKind::bad_argument, motion.remove_elements(is_gone, mass, VectorX::Zero(3)));
}

TEST_CASE("a body split by a blade moves as two bodies: state transferred to a new motion", "[model][cut]") {
  const auto mesh = bar();
  Explicit whole = explicit_bar(mesh);
  whole.set(drawn_out(mesh), spinning(mesh));
  const double dt = 0.4 * whole.limit();
  for (int k = 0; k < 20; ++k) REQUIRE(whole.step(dt).ok());
  const VectorX mass =
      lumped_mass(make_hyperelastic_body<Tet4, NeoHookean>(mesh, std::vector<NeoHookean>{rubber}).rest);
  const Vector3 before = momentum(mass, whole.state().velocity);

  CutTopology<Tet4> topology(mesh, std::vector<std::uint8_t>(mesh.positions.size(), 7));  // all supported
  CutOrder order;
  for (Index e = 0; e < mesh.element_count(); ++e)
    for (std::size_t f = 0; f < 4; ++f)
      if (const Index other = topology.neighbour(e, f); other > e) {
        const auto x = [&](Index i) {
          double sum = 0.0;
          for (int a = 0; a < 4; ++a) sum += 0.25 * mesh.position(mesh.element_node(i, a))[0];
          return sum < 0.06;
        };
        if (x(e) != x(other)) order.open.push_back({e, static_cast<int>(f)});
      }
  const auto change = topology.apply(order);
  REQUIRE(change.copies.size() == 9);  // nodes of the cross-section
  const MotionOfPart<Tet4> part(topology, ElementState::supported);
  Explicit split = explicit_bar(part.mesh());
  split.set(part.carried(whole.state().displacement), part.carried(whole.state().velocity));
  const VectorX now =
      lumped_mass(make_hyperelastic_body<Tet4, NeoHookean>(part.mesh(), std::vector<NeoHookean>{rubber}).rest);
  CHECK(std::abs(now.sum() - mass.sum()) <= 1e-14 * mass.sum());
  CHECK((momentum(now, split.state().velocity) - before).norm() <= 1e-12 * before.norm());
  CHECK(std::abs(split.stored_energy() - whole.stored_energy()) <= 1e-12 * whole.stored_energy());
  for (int k = 0; k < 200; ++k) REQUIRE(split.step(std::min(dt, split.limit())).ok());
  CHECK((momentum(now, split.state().velocity) - before).norm() <= 1e-12 * before.norm());
  double gap = 0.0;
  for (const NodeCopy& copy : change.copies)
    gap = std::max(gap, (split.state().displacement.segment<3>(3 * Index{part.node(copy.node)}) -
                         split.state().displacement.segment<3>(3 * Index{part.node(copy.parent)}))
                            .norm());
  CHECK(gap > 1e-3);
}
