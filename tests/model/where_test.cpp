// Every kind of tissue accepts selections by position, in the frame of the mesh as given.
#include <palpate/cut/cuttable.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/mesh_arrays.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/moving/implicit.hpp>

#include "catch.hpp"
#include "orphan_in_front.hpp"
#include "refused.hpp"

using namespace palpate;

namespace {

const Vector3 slab_size(0.06, 0.06, 0.03), slab_place(3.0, -7.0, 0.2);
const LinearElastic tissue_law{.youngs_modulus = 5e3, .poisson_ratio = 0.4, .density = 1000.0};

/// A slab away from the origin, with an orphan node in front, so that ids and positions change at admission.
Mesh<Tet4> distant_slab() {
  Mesh<Tet4> mesh = test::with_orphan_in_front(box_tet4(slab_size, {4, 4, 3}), Vector3(0.5, 0.5, 0.5));
  for (Vector3& x : mesh.positions) x += slab_place;
  return mesh;
}
AdmissionPolicy drop_orphans() {
  AdmissionPolicy policy;
  policy.orphans = Admission::repair;
  return policy;
}

const auto bottom = where::below(slab_place);
const auto top = where::above(Vector3(slab_place + Vector3(0, 0, slab_size[2])));

Scene by_name() {
  return Scene().fix("z0").touch("z1").render("surface").pressure("z1", 5.0).point_load("z1", {0.0, 0.01, 0.0});
}
Scene by_place() {
  return Scene()
      .fix(bottom)
      .touch(top)
      .render(where::inside([](const Vector3&) { return true; }))
      .pressure(top, 5.0)
      .point_load(top, {0.0, 0.01, 0.0});
}
template <class Tissue>
void check_same_surface(const Tissue& named, const Tissue& placed) {
  CHECK(named.contact_surface().positions() == placed.contact_surface().positions());
  CHECK(named.contact_surface().triangles() == placed.contact_surface().triangles());
  CHECK(named.contact_surface().triangles().size() == 32);
}

}  // namespace

TEST_CASE("a linear model accepts positions instead of names", "[model][where]") {
  using Model = HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>>;
  SetupOptions options;
  options.admission = drop_orphans();
  Model named(distant_slab(), by_name(), tissue_law, options), placed(distant_slab(), by_place(), tissue_law, options);
  CHECK(named.displacement() == placed.displacement());
  CHECK(named.touchable_nodes() == placed.touchable_nodes());
  check_same_surface(named, placed);
  CHECK(placed.rendered_nodes().size() == static_cast<std::size_t>(placed.mesh().node_count()));

  // The same for later changes of the loads.
  const Scene other = Scene().fix("z0").traction("x1", {2.0, 0.0, 0.0});
  const auto side = where::above(Vector3(slab_place + Vector3(slab_size[0], 0, 0)), Vector3::UnitX());
  named.set_conditions(other);
  placed.set_conditions(Scene().fix(bottom).traction(side, {2.0, 0.0, 0.0}).touch(top));
  CHECK(named.displacement() == placed.displacement());
  CHECK_REFUSED(SetupErrorKind::unsupported, placed.set_conditions(Scene().fix(bottom).touch(side)));
}

TEST_CASE("only the surface of a set of points is touchable", "[model][where]") {
  const auto upper = where::above(Vector3(slab_place + Vector3(0, 0, 0.5 * slab_size[2])));
  const HapticFEModel<Tet4, LinearElastic, SparseCholesky> model(distant_slab(), Scene().fix(bottom).touch(upper),
                                                                 tissue_law, {.admission = drop_orphans()});
  const std::vector<NodeId> surface = nodes_of(extract_boundary<Tet4>(model.mesh()));
  CHECK(nodes_within(model.mesh(), upper.relative_to(model.origin())).size() > model.touchable_nodes().size());
  for (const NodeId i : model.touchable_nodes()) CHECK(std::ranges::binary_search(surface, i));
  for (int v = 0; v < model.contact_surface().vertex_count(); ++v)
    CHECK(!model.contact_surface().triangles_at(v).empty());
}

TEST_CASE("an empty selection is refused with the extent of the mesh as given", "[model][where]") {
  const auto refused = [](const Scene& scene) {
    return test::refusal([&] {
      HapticFEModel<Tet4, LinearElastic, SparseCholesky>(distant_slab(), scene, tissue_law,
                                                         {.admission = drop_orphans()});
    });
  };
  const auto far = where::sphere({0, 0, 0}, 0.01);
  for (const Scene& scene : {Scene().fix(far), Scene().fix(bottom).touch(far), Scene().fix(bottom).pressure(far, 1.0),
                             Scene().fix(bottom).render(far)}) {
    const SetupProblem p = refused(scene);
    CHECK(p.kind == SetupErrorKind::empty_group);
    CHECK_THAT(p.what, test::contains("the sphere of radius 0.01 around (0, 0, 0)"));
    CHECK(p.hint == "The mesh extends from (3, -7, 0.2) to (3.06, -6.94, 0.23) [m]");
  }
}

TEST_CASE("a view of arrays needs no group", "[model][where]") {
  const Mesh<Tet4> mesh = box_tet4(slab_size, {4, 4, 3});
  const auto count = [](Index n) { return static_cast<std::size_t>(n); };
  const MeshArrays<Tet4, double, NodeId> view(
      std::span<const double>(mesh.positions[0].data(), 3 * count(mesh.node_count())),
      std::span<const NodeId>(mesh.elements[0].data(), 4 * count(mesh.element_count())));
  using Model = HapticFEModel<Tet4, LinearElastic, SparseCholesky>;
  const Scene scene = Scene().fix(where::below(Vector3::Zero())).touch(where::above(slab_size)).gravity({0, 0, -9.81});
  const Model model(view, scene, tissue_law), same(mesh, scene, tissue_law);
  CHECK(model.displacement() == same.displacement());
  check_same_surface(model, same);
}

TEST_CASE("moving tissue accepts positions instead of names", "[model][where]") {
  const auto check = [](const auto& named, const auto& placed) {
    CHECK(named.motion().displacement() == placed.motion().displacement());
    CHECK(named.touchable_nodes() == placed.touchable_nodes());
    check_same_surface(named, placed);
  };
  const SetupOptions repairing{.admission = drop_orphans()};
  using Rubber = HapticFEModel<Tet4, NeoHookean, Implicit<Newton>>;
  const NeoHookean rubber{.youngs_modulus = 5e3, .poisson_ratio = 0.4, .density = 1000.0};
  check(Rubber(distant_slab(), by_name(), rubber, repairing), Rubber(distant_slab(), by_place(), rubber, repairing));
  using Corotated = HapticFEModel<Tet4, Corotational, Implicit<MatrixFreeCG<BlockJacobi>>>;
  const Corotational material{.youngs_modulus = 5e3, .poisson_ratio = 0.4, .density = 1000.0};
  check(Corotated(distant_slab(), by_name(), material, repairing),
        Corotated(distant_slab(), by_place(), material, repairing));
}

TEST_CASE("cuttable tissue accepts positions instead of names", "[model][cut][where]") {
  using Cut = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;
  const CutParameters by_group{.cuttable = Selection("x1")},
      by_point{.cuttable = where::above(Vector3(slab_place + Vector3(slab_size[0], 0, 0)), Vector3::UnitX())};
  const SetupOptions repairing{.admission = drop_orphans()};
  Cut named(distant_slab(), by_name(), tissue_law, repairing, by_group),
      placed(distant_slab(), by_place(), tissue_law, repairing, by_point);
  check_same_surface(named, placed);
  CHECK(named.cut_report().kept == placed.cut_report().kept);
  CHECK(named.displacement() == placed.displacement());

  // Elements inside a tool are removed, independent of the frame of the stored mesh.
  const auto tool =
      where::capsule(slab_place + Vector3(0.03, 0.03, 0.03), slab_place + Vector3(0.03, 0.03, 0.02), 0.015);
  CutOrder order;
  placed.read([&](const auto& topology, const auto&) {
    order.remove = elements_within(topology.mesh(), tool.relative_to(placed.origin()));
  });
  CHECK(order.remove == elements_within(distant_slab(), tool));
  CHECK(order.remove.size() > 4);
  placed.cut(order);
  placed.process_cuts();
  placed.read([&](const auto& topology, const auto&) {
    for (const Index e : order.remove) CHECK(topology.is_removed(e));
  });
}

TEST_CASE("equilibrium accepts positions instead of names", "[model][equilibrium][where]") {
  const Mesh<Tet4> mesh = admit<Tet4>(distant_slab(), drop_orphans()).mesh;
  const std::vector<NeoHookean> materials{{5e3, 0.4, 1000.0}};
  Equilibrium named(make_hyperelastic_body(mesh, materials), by_name()),
      placed(make_hyperelastic_body(mesh, materials), by_place());
  CHECK(named.solve().converged);
  CHECK(placed.solve().converged);
  CHECK(named.displacement() == placed.displacement());
}
