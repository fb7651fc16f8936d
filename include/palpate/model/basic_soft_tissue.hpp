// Tissue in motion, felt at the rate of the device.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/assembly/hyperelastic_body.hpp>
#include <palpate/assembly/viscous_forces.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/material.hpp>
#include <palpate/concepts/tissue_model.hpp>
#include <palpate/contact/contact.hpp>
#include <palpate/contact/contact_surface.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/realtime.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>
#include <palpate/haptic/triple_buffer.hpp>
#include <palpate/mesh/admission.hpp>
#include <palpate/mesh/mechanisms.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/surface.hpp>
#include <palpate/model/deformable_body.hpp>
#include <palpate/model/nodal_rotation.hpp>
#include <palpate/model/tissue_motion.hpp>
#include <palpate/model/touchable.hpp>
#include <palpate/model/warped_compliance.hpp>

#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

template <class Body>
const auto& mesh_of(const Body& body) noexcept {
  if constexpr (requires { body.rest.mesh; })
    return body.rest.mesh;
  else if constexpr (requires { body.fast.mesh; })
    return body.fast.mesh;
  else
    return body.mesh;
}

}  // namespace detail

/// A body, hyperelastic or at small strain, with memory or without, that moves at its own rate, in a thread of its own,
/// while a servo solves the contact anew in every tick (the architecture of Duriez et al. 2006 and Courtecuisse et al.
/// 2015).
///
/// After every step the tissue publishes where its surface would be without the tools, and how much each vertex has
/// turned. Between two steps the servo solves the contact on that surface with the compliance of a step as the body
/// settled, turned with the vertices: C_ij = R_i C0_ij R_j^T (compliance warping, Saupin et al. 2008). What presses at
/// the end of a step corrects the step and loads the next one. In a steady hold the force is that of the non-linear
/// equilibrium, whatever the step and however rough C is: C only says how a change goes on until the next step has seen
/// it.
///
/// Two threads: `advance` belongs to one (see TissueThread), the functions of TissueModel to the one that ticks; they
/// exchange through triple buffers and never wait for each other. Satisfies TissueModel.
template <class Motion>
class BasicSoftTissue {
 public:
  using Options = TissueOptions<Motion>;
  /// On vertices, three to a contact; of more the first are felt by the tissue.
  static constexpr std::size_t most_forces = 3 * default_contact_capacity;

  /// One material everywhere, or one per region. Throws what make_deformable_body and statics throw, bad_argument for a
  /// step that is none, not_converged when there is no equilibrium to settle in. Set-up solves once per touchable dof.
  template <Element E, Material M>
  BasicSoftTissue(const Mesh<E>& mesh, const Scene& scene, const M& material, const Options& options = {})
      : BasicSoftTissue(mesh, scene, RegionMaterials<M>{{everywhere, material}}, options) {}
  template <Element E, Material M>
  BasicSoftTissue(const Mesh<E>& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                  const Options& options = {})
      : BasicSoftTissue(prepare(mesh, scene, materials, options), options) {}
  BasicSoftTissue(const BasicSoftTissue&) = delete;
  BasicSoftTissue& operator=(const BasicSoftTissue&) = delete;

  // The tissue's thread

  /// Takes in what pressed since the last step, and moves on by one step. No allocation; as long as it takes.
  auto advance() noexcept {
    const FlushDenormals flush;
    pressing_.update();
    full_.setZero();
    add(pressing_.front(), 1.0, full_);
    add(used_, -1.0, full_);
    const bool corrected = motion_.correct(full_) || full_.isZero(0.0) || steps_ == 0;
    used_ = pressing_.front();
    full_ = motion_.body().load;
    add(used_, 1.0, full_);
    motion_.set_load(full_);
    const auto report = motion_.step(step_);
    publish(report, corrected);
    return report;
  }
  const Motion& motion() const noexcept { return motion_; }
  double step() const noexcept { return step_; }
  /// Steps published so far.
  std::uint64_t steps() const noexcept { return steps_; }

  // TissueModel: the thread that ticks

  /// Brings in the newest surface. `inverted` while elements are inside out, solver_not_converged when the last step
  /// was cut off far from the answer, degraded_model when what pressed since the step before could only be taken in by
  /// the next, or was more than most_forces, non_finite_force when the last `end_tick` had forces that are none.
  Status begin_tick() noexcept {
    if (views_.update()) {
      surface_.move_to(views_.front().free);
      ++revision_;
    }
    return views_.front().status | ticked_;
  }
  /// Forces that are not finite are dropped.
  void end_tick(std::span<const VertexForce> forces) noexcept {
    Forces& out = pressing_.back();
    out.count = 0;
    ticked_ = {};
    for (const VertexForce& f : forces)
      if (!all_finite(f.force))
        ticked_.set(StatusFlag::non_finite_force);
      else if (out.count < most_forces)
        out.item[out.count++] = f;
      else
        ticked_.set(StatusFlag::degraded_model);
    pressing_.publish();
  }
  const ContactSurface& contact_surface() const noexcept { return surface_; }
  Status require_columns(std::span<const int>) noexcept { return {}; }
  Matrix3 compliance(int i, int j) const noexcept { return compliance_.turned(views_.front().rotation, i, j); }
  std::uint64_t compliance_revision() const noexcept { return revision_; }
  /// Surfaces brought in so far.
  std::uint64_t updates() const noexcept { return revision_; }
  double compliance_bound(int j) const noexcept { return compliance_.bound(j); }
  double compliance_floor() const noexcept { return compliance_.floor(); }
  const Eigen::Isometry3d& to_world() const noexcept { return world_; }

  /// Node of the admitted mesh of every vertex.
  const std::vector<NodeId>& touchable_nodes() const noexcept { return touchable_; }

 private:
  struct Forces {
    std::array<VertexForce, most_forces> item{};
    std::size_t count = 0;
  };
  struct View {
    std::vector<Vector3> free;
    std::vector<Matrix3> rotation;
    Status status;
  };
  struct Prepared {
    typename TissueMotion<Motion>::Source source;
    Touchable touchable;
    OriginalIds ids;
    Vector3 origin;
    VectorX settled;
    std::string loads;
  };

  template <Element E, Material M>
  static Prepared prepare(const Mesh<E>& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                          const Options& options) {
    if (!(options.step > 0.0 && options.step < infinity))
      raise(SetupErrorKind::bad_argument, "a step of " + number(options.step), "Give a positive time in seconds");
    Admitted<E> admitted = admit<E>(mesh, options.admission);
    Prepared prepared;
    prepared.ids = original_ids(admitted);
    const ScopedIdTranslation translation(prepared.ids);
    prepared.origin = 0.5 * (admitted.admitted.box_min + admitted.admitted.box_max);
    const Scene mapped = scene.mapped(admitted.node_map, prepared.origin);
    for (Vector3& x : admitted.mesh.positions) x -= prepared.origin;
    auto body = detail::make_any_body(std::move(admitted.mesh), materials);
    const Mesh<E>& rest = detail::mesh_of(body);
    prepared.touchable = resolve_touchable(mesh_ref(rest), extract_boundary<E>(rest), mapped);
    prepared.loads = loads_in_words(scene.gravity(), scene.loads_in_words());
    prepared.settled = VectorX::Zero(3 * rest.node_count());
    if (options.settle)
      require_constrained(rest, resolve_essential(rest, extract_boundary<E>(rest), mapped).constrained,
                          prepared.origin);
    prepared.source = TissueMotion<Motion>::source(std::move(body), mapped, options.limits);
    if (options.settle) prepared.settled = TissueMotion<Motion>::settle(prepared.source, options.limits);
    return prepared;
  }

  BasicSoftTissue(Prepared prepared, const Options& options)
      : BasicSoftTissue(prepared, options, ScopedIdTranslation(prepared.ids)) {}
  BasicSoftTissue(Prepared& prepared, const Options& options, const ScopedIdTranslation&)
      : step_(options.step),
        world_(make_pose(Matrix3::Identity(), prepared.origin)),
        touchable_(std::move(prepared.touchable.nodes)),
        motion_(std::move(prepared.source), options.motion, options.limits),
        rotations_(motion_.body().pattern, motion_.body().positions, touchable_),
        full_(motion_.displacement()) {
    motion_.set_state(prepared.settled, VectorX::Zero(full_.size()));
    compliance_ = WarpedCompliance(motion_, step_, touchable_, rotations_, options.limits);
    View view{std::vector<Vector3>(touchable_.size()), std::vector<Matrix3>(touchable_.size()), {}};
    look(view);
    surface_ = ContactSurface(view.free, std::move(prepared.touchable.triangles));
    std::vector<Vector3> unloaded;
    for (const NodeId node : touchable_) unloaded.push_back(motion_.body().positions[static_cast<std::size_t>(node)]);
    surface_.set_unloaded({std::move(unloaded), std::move(prepared.loads)});
    views_.fill(view);
  }

  void add(const Forces& forces, double factor, VectorX& load) const noexcept {
    for (std::size_t k = 0; k < forces.count; ++k)
      add_node_vector(load, touchable_[vertex(forces.item[k])], factor * forces.item[k].force);
  }

  /// Where the surface is without the forces in use, by the compliance that the servo uses: then the same forces bring
  /// it back to where it is.
  void look(View& view) const noexcept {
    const VectorX& u = motion_.displacement();
    const std::size_t n = touchable_.size();
    for (std::size_t i = 0; i < n; ++i) view.rotation[i] = rotations_(i, u);
    std::array<Vector3, most_forces> turned_back;
    for (std::size_t k = 0; k < used_.count; ++k)
      turned_back[k] = view.rotation[vertex(used_.item[k])].transpose() * used_.item[k].force;
    for (std::size_t i = 0; i < n; ++i) {
      Vector3 moved = Vector3::Zero();
      for (std::size_t k = 0; k < used_.count; ++k)
        moved += compliance_.at_rest(i, vertex(used_.item[k])) * turned_back[k];
      const NodeId node = touchable_[i];
      view.free[i] =
          motion_.body().positions[static_cast<std::size_t>(node)] + node_vector(u, node) - view.rotation[i] * moved;
    }
  }
  static std::size_t vertex(const VertexForce& f) noexcept { return static_cast<std::size_t>(f.vertex); }
  void publish(const auto& report, bool corrected) noexcept {
    View& view = views_.back();
    look(view);
    view.status = {};
    if (report.deformation.inverted > 0) view.status.set(StatusFlag::inverted);
    if (!TissueMotion<Motion>::close(report)) view.status.set(StatusFlag::solver_not_converged);
    if (!corrected) view.status.set(StatusFlag::degraded_model);
    views_.publish();
    ++steps_;
  }

  double step_;
  Eigen::Isometry3d world_;
  std::vector<NodeId> touchable_;
  Motion motion_;
  NodalRotations rotations_;
  VectorX full_;
  WarpedCompliance compliance_;
  Forces used_;
  std::uint64_t steps_ = 0;
  TripleBuffer<View> views_;
  TripleBuffer<Forces> pressing_;
  ContactSurface surface_;
  std::uint64_t revision_ = 0;
  Status ticked_;  // of the last end_tick
};

}}  // namespace palpate
