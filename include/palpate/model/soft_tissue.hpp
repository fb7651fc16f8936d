// Tissue at large deformation and in motion, felt at the rate of the device.
#pragma once

#include <palpate/contact/contact_surface.hpp>
#include <palpate/core/realtime.hpp>
#include <palpate/concepts/tissue_model.hpp>
#include <palpate/haptic/triple_buffer.hpp>
#include <palpate/mesh/admission.hpp>
#include <palpate/model/equilibrium.hpp>
#include <palpate/model/implicit_dynamics.hpp>
#include <palpate/model/nodal_rotation.hpp>
#include <palpate/model/touchable.hpp>

namespace palpate::inline PALPATE_ABI {

struct SoftTissueOptions {
  double step = 0.01;  ///< of the motion [s]
  DynamicsParameters motion{.newton = {.maximum_iterations = 2, .tolerance = 1e-9}};
  bool settle = true;  ///< start in equilibrium under the scene's loads
  AdmissionPolicy admission{};
  SetupLimits limits{};
};

/// A hyperelastic body that moves at its own rate, in a thread of its own, while a servo solves the contact anew in
/// every tick (the architecture of Duriez et al. 2006 and Courtecuisse et al. 2015).
///
/// After every step the tissue publishes where its surface would be without the tools, and how much each vertex has
/// turned. Between two steps the servo solves the contact on that surface with the compliance of a step at rest, turned
/// with the vertices: C_ij = R_i C0_ij R_j^T (compliance warping, Saupin et al. 2008). What presses at the end of a
/// step corrects the step and loads the next one. In a steady hold the force is that of the non-linear equilibrium,
/// whatever the step and however rough C is: C only says how a change goes on until the next step has seen it.
///
/// Two threads: `advance` belongs to one (see TissueThread), the functions of TissueModel to the one that ticks; they
/// exchange through triple buffers and never wait for each other. Satisfies TissueModel.
class SoftTissue {
 public:
  static constexpr std::size_t most_forces = 192;  ///< on vertices; of more the first are felt by the tissue

  /// One material everywhere, or one per region. Throws what make_deformable_body and statics throw, bad_argument for a
  /// step that is none, not_converged when there is no equilibrium to settle in. Set-up solves once per touchable dof.
  template <Element E, HyperelasticMaterial M>
  SoftTissue(const Mesh<E>& mesh, const Scene& scene, const M& material, const SoftTissueOptions& options = {})
      : SoftTissue(mesh, scene, RegionMaterials<M>{{everywhere, material}}, options) {}
  template <Element E, HyperelasticMaterial M>
  SoftTissue(const Mesh<E>& mesh, const Scene& scene, const RegionMaterials<M>& materials,
             const SoftTissueOptions& options = {})
      : SoftTissue(prepare(mesh, scene, materials, options), options) {}
  SoftTissue(const SoftTissue&) = delete;
  SoftTissue& operator=(const SoftTissue&) = delete;

  // The tissue's thread

  /// Takes in what pressed since the last step, and moves on by one step. No allocation; as long as it takes.
  StepReport advance() noexcept {
    const FlushDenormals flush;
    pressing_.update();
    full_.setZero();
    add(pressing_.front(), 1.0, full_);
    add(used_, -1.0, full_);
    motion_.correct(full_);
    used_ = pressing_.front();
    full_ = motion_.body().load;
    add(used_, 1.0, full_);
    motion_.set_load(full_);
    const StepReport report = motion_.step(step_);
    publish(report);
    return report;
  }
  const ImplicitDynamics& motion() const noexcept { return motion_; }
  double step() const noexcept { return step_; }
  /// Steps published so far.
  std::uint64_t steps() const noexcept { return steps_; }

  // TissueModel: the thread that ticks

  /// Brings in the newest surface. `inverted` while elements are inside out, solver_not_converged when the last step
  /// was cut off far from the answer.
  Status begin_tick() noexcept {
    if (views_.update()) {
      surface_.move_to(views_.front().free);
      ++revision_;
    }
    return views_.front().status;
  }
  void end_tick(std::span<const VertexForce> forces) noexcept {
    Forces& out = pressing_.back();
    out.count = std::min(forces.size(), most_forces);
    std::copy_n(forces.begin(), out.count, out.item.begin());
    pressing_.publish();
  }
  const ContactSurface& contact_surface() const noexcept { return surface_; }
  Status require_columns(std::span<const int>) noexcept { return {}; }
  Matrix3 compliance(int i, int j) const noexcept { return warped(views_.front(), i, j); }
  std::uint64_t compliance_revision() const noexcept { return revision_; }
  /// Surfaces brought in so far.
  std::uint64_t updates() const noexcept { return revision_; }
  double compliance_bound(int j) const noexcept { return bound_[static_cast<std::size_t>(j)]; }
  double compliance_floor() const noexcept { return floor_; }
  const Eigen::Isometry3d& pose() const noexcept { return world_; }

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
    DeformableBody body;
    Touchable touchable;
    Vector3 origin;
    VectorX settled;
  };

  template <Element E, HyperelasticMaterial M>
  static Prepared prepare(const Mesh<E>& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                          const SoftTissueOptions& options) {
    Admitted<E> admitted = admit<E>(mesh, options.admission);
    const Scene mapped = scene.mapped(admitted.node_map);
    Prepared prepared;
    prepared.origin = 0.5 * (admitted.admitted.box_min + admitted.admitted.box_max);
    for (Vector3& x : admitted.mesh.positions) x -= prepared.origin;
    auto body = make_hyperelastic_body(std::move(admitted.mesh), materials);
    prepared.touchable = resolve_touchable(body.rest.mesh, extract_boundary<E>(body.rest.mesh), mapped);
    prepared.settled = VectorX::Zero(3 * body.rest.mesh.node_count());
    if (options.settle) {
      Equilibrium statics(body, mapped, options.limits);
      const EquilibriumReport report = statics.solve();
      if (!report.converged)
        raise(SetupErrorKind::not_converged, describe(report), "Set settle = false, or hold it better");
      prepared.settled = statics.displacement();
    }
    prepared.body = make_deformable_body(std::move(body), mapped, options.limits);
    return prepared;
  }

  SoftTissue(Prepared prepared, const SoftTissueOptions& options)
      : step_(options.step),
        world_(Eigen::Translation3d(prepared.origin)),
        touchable_(std::move(prepared.touchable.nodes)),
        rotations_(prepared.body.pattern, prepared.body.positions, touchable_),
        motion_(std::move(prepared.body), options.motion, options.limits),
        full_(motion_.displacement()) {
    if (!(step_ > 0.0 && step_ < infinity))
      raise(SetupErrorKind::bad_argument, "a step of " + number(step_), "Give a positive time in seconds");
    store_compliance(options.limits);
    motion_.set_state(prepared.settled, VectorX::Zero(full_.size()));
    View view{std::vector<Vector3>(touchable_.size()), std::vector<Matrix3>(touchable_.size()), {}};
    look(view);
    surface_ = ContactSurface(view.free, std::move(prepared.touchable.triangles));
    views_.fill(view);
  }

  /// C0: what a force on each touchable dof moves within a step from rest.
  void store_compliance(const SetupLimits& limits) {
    const std::size_t n = touchable_.size();
    limits.require_memory(static_cast<double>(n) * static_cast<double>(n) * sizeof(Matrix3), "the contact compliance");
    rest_.resize(n * n);
    bound_.assign(n, 0.0);
    if (!motion_.prepare_response(step_))
      raise(SetupErrorKind::not_positive_definite, "the body at rest has no stiffness");
    VectorX force = VectorX::Zero(full_.size()), u(full_.size());
    for (std::size_t j = 0; j < n; ++j) {
      if (j % 64 == 0) limits.advance("compliance", static_cast<double>(j) / static_cast<double>(n));
      for (int c = 0; c < 3; ++c) {
        force[3 * Index{touchable_[j]} + c] = 1.0;
        motion_.respond(force, u);
        force[3 * Index{touchable_[j]} + c] = 0.0;
        for (std::size_t i = 0; i < n; ++i) rest_[i + n * j].col(c) = u.segment<3>(3 * Index{touchable_[i]});
      }
      for (std::size_t i = 0; i < n; ++i) bound_[j] = std::max(bound_[j], rest_[i + n * j].norm());
      floor_ = std::max(floor_, 1e-9 * bound_[j]);
    }
    if (floor_ == 0.0) floor_ = 1e-9;
  }

  Matrix3 warped(const View& view, int i, int j) const noexcept {
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
    return view.rotation[a] * rest_[a + touchable_.size() * b] * view.rotation[b].transpose();
  }

  void add(const Forces& forces, double factor, VectorX& load) const noexcept {
    for (std::size_t k = 0; k < forces.count; ++k)
      load.segment<3>(3 * Index{touchable_[static_cast<std::size_t>(forces.item[k].vertex)]}) +=
          factor * forces.item[k].force;
  }

  /// Where the surface is without the forces in use, by the compliance that the servo uses: then the same forces bring
  /// it back to where it is.
  void look(View& view) const noexcept {
    const VectorX& u = motion_.displacement();
    for (std::size_t i = 0; i < touchable_.size(); ++i) view.rotation[i] = rotations_(i, u);
    for (std::size_t i = 0; i < touchable_.size(); ++i) {
      view.free[i] =
          motion_.body().positions[static_cast<std::size_t>(touchable_[i])] + u.segment<3>(3 * Index{touchable_[i]});
      for (std::size_t k = 0; k < used_.count; ++k)
        view.free[i] -= warped(view, static_cast<int>(i), used_.item[k].vertex) * used_.item[k].force;
    }
  }
  void publish(const StepReport& report) noexcept {
    View& view = views_.back();
    look(view);
    view.status = {};
    if (report.deformation.inverted > 0) view.status.set(StatusFlag::inverted);
    if (!report.taken || !(report.newton.relative_residual <= 0.05)) view.status.set(StatusFlag::solver_not_converged);
    views_.publish();
    ++steps_;
  }

  double step_;
  Eigen::Isometry3d world_;
  std::vector<NodeId> touchable_;
  NodalRotations rotations_;
  ImplicitDynamics motion_;
  VectorX full_;
  std::vector<Matrix3> rest_;  // of vertex i per force on j at i + vertices x j
  std::vector<double> bound_;
  double floor_ = 0.0;
  Forces used_;
  std::uint64_t steps_ = 0;
  TripleBuffer<View> views_;
  TripleBuffer<Forces> pressing_;
  ContactSurface surface_;
  std::uint64_t revision_ = 0;
};

static_assert(TissueModel<SoftTissue>);

}  // namespace palpate::inline PALPATE_ABI
