// Example 10: the constraint approach of Berkley et al. (IEEE TVCG 10(3), 2004). There the tool does not apply a force:
// it prescribes the positions of the points in contact, the active nodes, and the force is the reaction. A contact
// inside a face is distributed to its three nodes with barycentric weights.
//
// The contact of palpate is that approach for bilateral contact (grasping), and the same with inequalities for
// unilateral contact. A grasped point under rigid coupling is exactly Berkley's active point. The example shows this
// for a node and for a point inside a face, and compares both with full solutions without contact:
//   1. a node: force = reaction of a model in which that node's displacement is prescribed;
//   2. a point in a face: with the distributed forces as loads on the whole body, the point is at the tool position,
//      and the work of the force on the point equals that of the distributed forces on the nodes.
// The exit code is 0 when both agree.
#include <palpate/palpate.hpp>

#include <cstdio>

using namespace palpate;

namespace {

using Tissue = HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>>;

const Vector3 size(0.03, 0.03, 0.02);
const LinearElastic material{.youngs_modulus = 1e4, .poisson_ratio = 0.4, .density = 1000.0};
constexpr double radius = 4e-3;

Mesh<Tet4> mesh() {
  return box_tet4(size, {4, 4, 4}, BoxSplit::six);
}
Scene scene() {
  return Scene().fix("z0").touch("z1");
}

struct GraspedPoint {
  Vector3 force;  ///< of the hand on the tissue [N]
  std::vector<VertexForce> shared;
};

/// Grasps the point of the top surface below the sphere and moves it.
GraspedPoint grasp_and_move(Tissue& tissue, const Vector3& point, const Vector3& by) {
  ServoOptions options;
  options.coupling_stiffness = infinity;  // device and point coincide
  options.grasp_buttons = 1;
  options.contact.sample_spacing = 0.4;
  HapticServo servo(tissue, SphereTool{.radius = radius}, options);
  ToolState state;
  const Vector3 above = point + Vector3(0, 0, radius);
  for (int k = 0; k <= 100; ++k) {
    state.time = 1e-3 * k;
    state.position = above + by * std::max(0, k - 20) / 80.0;
    state.buttons = k >= 10 ? 1u : 0u;
    servo.tick(state);
  }
  const auto forces = servo.read_snapshot().vertex_forces();
  return {-servo.tick_view().contact_force(), {forces.begin(), forces.end()}};
}

bool agree(const char* what, const Vector3& a, const Vector3& b) {
  const double error = (a - b).norm() / b.norm();
  std::printf("%-34s (%8.5f %8.5f %8.5f) and (%8.5f %8.5f %8.5f): difference %.1e\n", what, a[0], a[1], a[2], b[0],
              b[1], b[2], error);
  return error < 2e-6;
}

}  // namespace

int main() {
  Tissue tissue(mesh(), scene(), material);
  const Vector3 by(1e-3, -5e-4, 2e-3);

  // 1. The node in the middle of the top, pulled up and sideways.
  int vertex = 0;
  const ContactSurface& top = tissue.contact_surface();
  const Vector3 middle = tissue.to_world().inverse() * Vector3(0.5 * size[0], 0.5 * size[1], size[2]);
  for (int v = 0; v < top.vertex_count(); ++v)
    if ((top.position(v) - middle).norm() < (top.position(vertex) - middle).norm()) vertex = v;
  const NodeId node = tissue.touchable_nodes()[static_cast<std::size_t>(vertex)];
  const GraspedPoint at_node = grasp_and_move(tissue, tissue.to_world() * top.position(vertex), by);
  const Tissue prescribed(mesh(), scene().prescribe(std::vector<NodeId>{node}, {by[0], by[1], by[2]}), material);
  const Vector3 reaction = prescribed.reactions().segment<3>(3 * Index{node});
  bool right = agree("force at an active node, reaction", at_node.force, reaction);

  // 2. A point inside a face: its contact point nearest to a third of each corner.
  const Triangle& face = top.triangle(top.triangles_at(vertex)[0]);
  const Vector3 third = (top.position(face[0]) + top.position(face[1]) + top.position(face[2])) / 3.0;
  const GraspedPoint inside = grasp_and_move(tissue, tissue.to_world() * third, by);
  const VectorX u = tissue.displacement(inside.shared);
  Vector3 sum = Vector3::Zero(), moved = Vector3::Zero();
  double work = 0.0;
  for (const VertexForce& f : inside.shared) {
    const Vector3 displacement = u.segment<3>(3 * Index{tissue.touchable_nodes()[static_cast<std::size_t>(f.vertex)]});
    const Vector3& force = f.force.in_model_axes();  // equal to the world axes: the model has no pose
    sum += force;
    moved += displacement * force.dot(inside.force) / inside.force.squaredNorm();  // weight = share of the force
    work += displacement.dot(force);
  }
  std::printf("the force on a point inside a face is distributed to %zu nodes\n", inside.shared.size());
  right = inside.shared.size() == 3 && right;
  right = agree("sum of distributed forces, force", sum, inside.force) && right;
  right = agree("displacement of point and of tool", moved, by) && right;
  std::printf("work on the nodes %.9g J, on the point %.9g J\n", work, inside.force.dot(by));
  return right && std::abs(work - inside.force.dot(by)) < 2e-6 * work ? 0 : 1;
}
