#include "direct_reference.hpp"

#include <palpate/element/tet10.hpp>
#include <palpate/assembly/assembled.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/model/policies.hpp>

#include <Eigen/Geometry>

#include "../common/timing.hpp"
#include "pressed_forces.hpp"

namespace tradeoff {
namespace {

RegionMaterials<NeoHookean> large_strain(const RegionMaterials<LinearElastic>& materials) {
  RegionMaterials<NeoHookean> laws;
  for (const auto& [region, m] : materials) laws.push_back({region, {m.youngs_modulus, m.poisson_ratio, m.density}});
  return laws;
}

/// Of a node [N/m]: a ball sinks in by some thousandths of the small depth.
double contact_stiffness(const PressScene& scene) {
  double softest = infinity;
  for (const auto& region : scene.materials) softest = std::min(softest, region.second.youngs_modulus);
  return 60.0 * softest * scene.radius;
}

std::vector<double> depths(const PressScene& scene) {
  std::vector<double> d{0.5 * scene.small, scene.small};
  constexpr int more = 3;
  for (int i = 1; i <= more; ++i) d.push_back(scene.small + (scene.large - scene.small) * i / more);
  return d;
}

/// Force, displacement of the nodes of the mesh as given.
struct Pressed {
  std::vector<Vector3> force;
  VectorX displacement;
};

void require_balance(const Pressed& pressed, Vector3 support, double depth) {
  double largest = 0.0;
  for (const Vector3& f : pressed.force) {
    support -= f;
    largest = std::max(largest, f.norm());
  }
  if (!(support.norm() < 1e-4 * largest))
    raise(SetupErrorKind::not_converged, "the reference is no equilibrium at a depth of " + number(depth) +
                                             " m: supports are off by " + number(support.norm() / largest));
}

/// Newton's method to the end at every depth.
std::vector<Pressed> press(const PressScene& scene, DeformableBody body, const std::vector<NodeId>& nodes) {
  PressedEquilibrium equilibrium(std::move(body), nodes, scene.radius, contact_stiffness(scene));
  std::vector<Pressed> all;
  for (const double depth : depths(scene)) {
    equilibrium.move_to(scene.centres(depth));
    all.push_back({equilibrium.forces_on_balls(), equilibrium.displacement().head(3 * scene.mesh.node_count())});
    require_balance(all.back(), equilibrium.support(), depth);
    if (!(equilibrium.largest_depth() < 2e-2 * scene.small))
      raise(SetupErrorKind::not_converged,
            "the ball of the reference sinks in by " + number(equilibrium.largest_depth()) + " m");
  }
  return all;
}

/// Linear tissue and rigid balls: nodes are kept out of them by forces along the normals, exactly, on the compliance of
/// the nodes that press. One factorisation.
template <class E>
class LinearPress {
 public:
  LinearPress(const PressScene& scene, const Mesh<E>& mesh)
      : scene_(scene),
        mesh_(mesh),
        conditions_(resolve_essential(mesh, extract_boundary<E>(mesh), scene.scene(near_group))),
        stiffness_(assemble_stiffness<E>(make_body(mesh, scene.materials), {})),
        load_(conditions_.free_count()),
        answer_(conditions_.free_count()) {
    DofLayout layout{{}, mesh.positions, {}};
    for (const Index dof : conditions_.free_dofs) layout.node_of_dof.push_back(dof / 3);
    for (const NodeId node : mesh.find_group(near_group)->nodes) {
      if (conditions_.is_constrained(3 * Index{node})) continue;
      nodes_.push_back(node);
      for (int c = 0; c < 3; ++c)
        layout.kept.push_back(conditions_.free_index[static_cast<std::size_t>(3 * Index{node} + c)]);
    }
    solver_ = SolverTraits<Condensed<SelectiveInverse>>::make(stiffness_, conditions_, layout, {});
    columns_.resize(nodes_.size());
    force_.assign(nodes_.size(), Vector3::Zero());
  }

  Pressed at(double depth) {
    const std::vector<Vector3> centres = scene_.centres(depth);
    Pressed pressed{std::vector<Vector3>(centres.size()), {}};
    double change = infinity;
    for (int round = 0; change > 1e-5; ++round) {
      if (round == 300) raise(SetupErrorKind::not_converged, "the linear reference finds no contact forces");
      const std::vector<Vector3> before = pressed.force;
      push(centres, pressed.force);
      change = 0.0;
      for (std::size_t b = 0; b < before.size(); ++b)
        change = std::max(change, (pressed.force[b] - before[b]).norm() / pressed.force[b].norm());
    }
    VectorX force = VectorX::Zero(conditions_.dof_count()), u(force.size()), answer(force.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) force.segment<3>(3 * Index{nodes_[i]}) = force_[i];
    solve(force, u);
    stiffness_.apply(u, answer);
    Vector3 support = Vector3::Zero();
    for (Index dof = 0; dof < answer.size(); ++dof)
      if (conditions_.is_constrained(dof)) support[dof % 3] += answer[dof];
    pressed.displacement = u.head(3 * scene_.mesh.node_count());
    require_balance(pressed, support, depth);
    return pressed;
  }

 private:
  struct Row {
    std::size_t node, ball;
    Vector3 normal;
    double gap;
  };

  void solve(const VectorX& force, VectorX& u) {
    conditions_.gather(force, load_);
    solver_.solve_into(load_, answer_);
    conditions_.scatter(answer_, u);
  }
  /// Displacements of the touchable nodes per force on one of them.
  const Eigen::Matrix<double, Eigen::Dynamic, 3>& column(std::size_t i) {
    auto& c = columns_[i];
    if (c.rows() > 0) return c;
    c.resize(3 * static_cast<Index>(nodes_.size()), 3);
    VectorX response(c.rows());
    for (int k = 0; k < 3; ++k) {
      solver_.compliance_column(3 * static_cast<Index>(i) + k, response);
      c.col(k) = response;
    }
    return c;
  }
  Vector3 moved(std::size_t node) {
    Vector3 u = Vector3::Zero();
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (!force_[i].isZero(0.0)) u += column(i).template middleRows<3>(3 * static_cast<Index>(node)) * force_[i];
    return u;
  }
  /// One linearisation of the distances at where the nodes are, solved by projected Gauss-Seidel.
  void push(const std::vector<Vector3>& centres, std::vector<Vector3>& on_balls) {
    std::vector<Row> rows;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Vector3 u = moved(i);
      for (std::size_t b = 0; b < centres.size(); ++b) {
        const Vector3 off = mesh_.position(nodes_[i]) + u - centres[b];
        if (off.norm() < scene_.radius * 1.02)
          rows.push_back({i, b, off.normalized(), off.norm() - scene_.radius - off.normalized().dot(u)});
      }
    }
    const auto n = static_cast<Index>(rows.size());
    MatrixX w(n, n);
    VectorX lambda(n);
    for (Index j = 0; j < n; ++j) {
      const Row& from = rows[static_cast<std::size_t>(j)];
      const Eigen::Matrix<double, Eigen::Dynamic, 1> response = column(from.node) * from.normal;
      lambda[j] = std::max(0.0, force_[from.node].dot(from.normal));
      for (Index i = 0; i < n; ++i) {
        const Row& to = rows[static_cast<std::size_t>(i)];
        w(i, j) = to.normal.dot(response.segment<3>(3 * static_cast<Index>(to.node)));
      }
    }
    for (int sweep = 0; sweep < 3000; ++sweep) {
      double change = 0.0;
      for (Index i = 0; i < n; ++i) {
        const double next =
            std::max(0.0, lambda[i] - (rows[static_cast<std::size_t>(i)].gap + w.row(i).dot(lambda)) / w(i, i));
        change = std::max(change, std::abs(next - lambda[i]));
        lambda[i] = next;
      }
      if (n == 0 || change <= 1e-9 * lambda.maxCoeff()) break;
    }
    std::ranges::fill(force_, Vector3::Zero());
    std::ranges::fill(on_balls, Vector3::Zero());
    for (Index i = 0; i < n; ++i) {
      const Row& row = rows[static_cast<std::size_t>(i)];
      force_[row.node] += lambda[i] * row.normal;
      on_balls[row.ball] -= lambda[i] * row.normal;
    }
  }

  const PressScene& scene_;
  const Mesh<E>& mesh_;
  EssentialConditions conditions_;
  BlockMatrix stiffness_;
  SolverTraits<Condensed<SelectiveInverse>>::System solver_;
  VectorX load_, answer_;
  std::vector<NodeId> nodes_;
  std::vector<Eigen::Matrix<double, Eigen::Dynamic, 3>> columns_;
  std::vector<Vector3> force_;
};

template <class E>
std::vector<Pressed> press_linear(const PressScene& scene, const Mesh<E>& mesh) {
  LinearPress<E> press(scene, mesh);
  std::vector<Pressed> all;
  for (const double depth : depths(scene)) all.push_back(press.at(depth));
  return all;
}

template <class E>
std::vector<Pressed> press_large_strain(const PressScene& scene, const Mesh<E>& mesh) {
  return press(scene,
               make_held_body(make_hyperelastic_body(mesh, large_strain(scene.materials)), scene.scene(near_group)),
               mesh.find_group(near_group)->nodes);
}

Reference reference_of(const PressScene& scene, const std::vector<Pressed>& all) {
  Reference r;
  r.curve.push_back({0.0, std::vector<Vector3>(scene.balls.size(), Vector3::Zero())});
  const std::vector<double> at = depths(scene);
  for (std::size_t i = 0; i < at.size(); ++i) {
    r.curve.push_back({at[i], all[i].force});
    if (at[i] == scene.small) r.displacement_small = all[i].displacement;
    r.displacement_large = all[i].displacement;
  }
  const auto boundary = boundary_triangles(scene.mesh);
  r.volume_small = volume_of(scene.mesh, boundary, r.displacement_small);
  r.volume_large = volume_of(scene.mesh, boundary, r.displacement_large);
  return r;
}

/// What large strain changes on a mesh where it is cheap, put on what the fine mesh says of small strain.
std::vector<Pressed> corrected(const PressScene& scene, std::vector<Pressed> fine) {
  const Mesh<Tet4> cheap = refine_near(scene, 0.3 * scene.radius);
  const auto curved = press_large_strain(scene, cheap), straight = press_linear(scene, cheap);
  for (std::size_t i = 0; i < fine.size(); ++i) {
    for (std::size_t b = 0; b < fine[i].force.size(); ++b) {
      const Vector3 &from = straight[i].force[b], &to = curved[i].force[b];
      const double ratio = to.norm() / from.norm();
      fine[i].force[b] = ratio * (Eigen::Quaterniond::FromTwoVectors(from, to) * fine[i].force[b]);
    }
    fine[i].displacement += curved[i].displacement - straight[i].displacement;
  }
  return fine;
}

double apart(const Reference& a, const Reference& b, double depth) {
  return (a.force(0, depth) - b.force(0, depth)).norm() / a.force(0, depth).norm();
}

Reference make(const PressScene& scene, double edge, bool direct) {
  Reference r, coarse;
  const double seconds = bench::seconds_of([&] {
    const Mesh<Tet10> mesh = promote<Tet10>(refine_near(scene, edge * scene.radius)),
                      half = promote<Tet10>(refine_near(scene, 2.0 * edge * scene.radius));
    const std::vector<Pressed> fine = press_linear(scene, mesh);
    r = reference_of(scene, fine);
    coarse = reference_of(scene, press_linear(scene, half));
    const double small = apart(r, coarse, scene.small), large = apart(r, coarse, scene.large);
    r = reference_of(scene, direct ? press_large_strain(scene, mesh) : corrected(scene, fine));
    r.mesh_error_small = small;
    r.mesh_error_large = large;
    r.nodes = mesh.node_count();
  });
  r.seconds = seconds;
  return r;
}

}  // namespace

Vector3 Reference::force(std::size_t ball, double depth) const {
  if (depth <= 0.0) return Vector3::Zero();
  std::size_t i = 1;
  while (i + 1 < curve.size() && curve[i].depth < depth) ++i;
  const Point &a = curve[i - 1], &b = curve[i];
  if (a.depth == 0.0) return std::pow(depth / b.depth, 1.5) * b.force[ball];
  // F / d^1.5 is nearly straight in d, and that is interpolated
  const double t = (depth - a.depth) / (b.depth - a.depth);
  return std::pow(depth, 1.5) *
         ((1.0 - t) * std::pow(a.depth, -1.5) * a.force[ball] + t * std::pow(b.depth, -1.5) * b.force[ball]);
}

Reference make_reference(const PressScene& scene, double edge) {
  return make(scene, edge, false);
}
Reference make_direct_reference(const PressScene& scene, double edge) {
  return make(scene, edge, true);
}

Stiffening measure_stiffening(const PressScene& scene) {
  // Somewhere else on the touchable surface: a curve that was measured where it is used would prove nothing.
  const std::vector<NodeId>& wide = scene.mesh.find_group(wide_group)->nodes;
  PressScene other = scene;
  const Vector3 from = scene.balls.front().point, wanted = from + 2.0 * scene.radius * Vector3::UnitX();
  const NodeId node =
      *std::ranges::min_element(wide, {}, [&](NodeId i) { return (scene.mesh.position(i) - wanted).squaredNorm(); });
  other.balls = {ball_along_normal(scene.mesh, scene.mesh.position(node), scene.radius)};
  const double k = contact_stiffness(scene);
  PressedEquilibrium real(
      make_held_body(make_hyperelastic_body(scene.mesh, large_strain(scene.materials)), scene.scene(near_group)), wide,
      scene.radius, k),
      linear(make_deformable_body(make_body(scene.mesh, scene.materials), scene.scene(near_group)), wide, scene.radius,
             k);
  Stiffening s;
  for (const double depth : depths(other)) {
    real.move_to(other.centres(depth));
    linear.move_to(other.centres(depth));
    s.depth.push_back(depth);
    s.ratio.push_back(real.forces_on_balls().front().norm() / linear.forces_on_balls().front().norm());
  }
  return s;
}

}  // namespace tradeoff
