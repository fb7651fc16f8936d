// Definitions of moving_tissue.hpp.
#pragma once

#include <palpate/model/moving/moving_tissue.hpp>

#include <palpate/contact/detail/requested_vertices.hpp>
#include <palpate/contact/subfacet_compliance.hpp>
#include <palpate/core/detail/attempt.hpp>
#include <palpate/core/platform.hpp>
#include <palpate/model/admission_report.hpp>
#include <palpate/model/detail/elastic_body.hpp>
#include <palpate/model/detail/stage_timer.hpp>
#include <palpate/model/detail/touchable.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(TissueModel<MovingTissue>);

PALPATE_INLINE MovingTissue::MovingTissue(const SetupOptions& options) : ModelBase(options) {
  if (!options.cache_file.empty())
    raise(SetupErrorKind::unsupported, "a cache file for moving tissue, which has nothing to store",
          "Leave cache_file empty");
}
PALPATE_INLINE MovingTissue::~MovingTissue() = default;

PALPATE_INLINE void MovingTissue::set_up(const detail::Touchable& touchable, PreparedMotion prepared, double step,
                                         const detail::BlockPattern& pattern) {
  const ScopedIdTranslation translation(original_ids());
  const detail::StageTimer timer(setup_report(), "compliance");
  step_ = step;
  motion_ = std::move(prepared.motion);
  accepts_initial_strains_ = prepared.accepts_initial_strains;
  stretches_ = prepared.large_strain;
  start_ = std::move(prepared.start);
  const EssentialConditions conditions = elastic_body().conditions(scene());
  start_prescribed_ = conditions.prescribed;
  mass_ = elastic_body().nodal_mass();
  loaded_ = scene();
  applied_ = load_of(loaded_, Vector3::Zero());
  load_ = start_load_ = load_of(scene(), gravity());
  full_ = response_ = start_load_;
  rotations_ = detail::NodalRotations(pattern, elastic_body().positions(), touchable.nodes);
  motion_->set_load(load_);
  motion_->rest_at(start_);
  compliance_ =
      detail::VertexCompliance(detail::WarpedCompliance(*motion_, step_, touchable.nodes, rotations_, limits()));
  motion_->rest_at(start_);  // the state that reset() restores
  nodes_ = touchable.nodes;
  for (const NodeId node : nodes_) rest_.push_back(elastic_body().positions()[static_cast<std::size_t>(node)]);
  list_every_vertex();
  const double near_bytes =
      3.0 * detail::NearCompliance::bytes(nodes_.size(), most_near, most_pressed);  // one per view
  limits().require_memory(near_bytes, "the compliance near the contacts");
  triangles_ = touchable.triangles;
  if (motion_->is_quasi_static()) start_secants();
  takes_springs_ = motion_->set_springs({});
  springs_ = detail::ContactSprings(nodes_.size(), most_forces, most_points);
  agreement_ = detail::ForceAgreement(nodes_.size());
  if (stretches_) stretch_ = detail::SurfaceStretch(rest_, triangles_);
  View view = make_view();
  view.near_compliance = {nodes_.size(), most_near, most_pressed};
  update_view(view);
  view.surface = ContactSurface(view.free, triangles_);
  view.surface.expect(view.pressed, {});
  view.surface.set_unloaded(unloaded());
  view.surface.set_large_strain(stretches_);
  view.surface.set_materials(elastic_body().contact_materials(touchable.elements));
  if (!touchable.elements.empty())
    view.surface.set_subfacet(
        std::make_shared<SubfacetCompliance>(elastic_body().half_space(touchable.nodes, conditions, limits())));
  views_.fill(view);
  drawn_.fill(start_);
  setup_report().compliance_bytes = compliance_.bytes() + static_cast<std::size_t>(near_bytes);
  setup_report().free_dofs = conditions.free_count();
  setup_report().kept_dofs = 3 * setup_report().touchable_vertices;
  if (accepts_initial_strains_) detail::report_displacement(elastic_body().positions(), start_, setup_report());
}

PALPATE_INLINE void MovingTissue::list_every_vertex() {
  every_.resize(nodes_.size());
  std::iota(every_.begin(), every_.end(), 0);
}

PALPATE_INLINE void MovingTissue::start_secants() {
  secants_ = detail::SecantCompliance(nodes_.size(), most_forces);
  moved_.resize(nodes_.size());
  find_moved(moved_);
  moved_before_ = moved_;
}

PALPATE_INLINE MovingTissue::View MovingTissue::make_view() const {
  const std::size_t vertices = nodes_.size();
  View view;
  view.free.resize(vertices);
  view.pressed.resize(vertices);
  view.rotation.resize(vertices);
  view.half_space.resize(vertices);
  if (motion_->is_quasi_static())
    for (detail::SecantTerms::Term& term : view.secants.term) term.resize(vertices);
  view.compliance = compliance_;
  view.requested.assign(vertices, ~std::uint64_t{0});
  view.required = view.requested;
  return view;
}

PALPATE_INLINE MotionStep MovingTissue::advance() noexcept {
  const std::scoped_lock lock(changes_);
  const FlushDenormals flush;
  report_failed(false);
  if (!prepare_step()) return {};
  const bool is_new = take_forces();
  if (is_new) agreement_.add({given().item.data(), given().count});
  springs_.set_stiffness(agreement_.spring_stiffness());
  full_.setZero();
  if (!has_springs_) add(used_, -1.0, full_);
  if (is_new || given().number != changed_.number) set_springs(given());
  const bool had_springs = std::exchange(has_springs_, !springs_.empty());
  if (!has_springs_) add(given(), 1.0, full_);
  const bool same = !had_springs && !has_springs_ && full_.isZero(0.0);
  const bool corrected = same || motion_->correct(full_) || steps_ == 0;
  Forces before = used_;
  used_ = given();
  if (!motion_->is_static()) springs_.read(motion_->displacement(), {used_.item.data(), used_.count});
  // With a history, the correction changes the displacement by the change of forces alone; a step also by creep.
  if (motion_->is_quasi_static() && !motion_->is_static() && corrected) record_pair(before, 0.0);
  if (used_.number != changed_.number) used_.count = split_.divide(used_.item, used_.count);
  const bool was_slit = std::exchange(was_slit_, false);
  full_ = load_;
  if (springs_.empty()) add(used_, 1.0, full_);
  motion_->set_load(full_);
  const MotionStep done = motion_->step(step_);
  springs_.read(motion_->displacement(), {used_.item.data(), used_.count});
  if (motion_->is_quasi_static()) {
    if (loads_changed_)
      secants_.clear();
    else if (done.taken && motion_->is_static())
      record_pair(before, done.relative_residual);
    loads_changed_ = false;
    find_moved(moved_);
    if (was_slit && presses_beside_slit()) record_response(before, done);
  }
  Status status = done.status;
  if (!corrected || (others_ && others_->left_out)) status.set(StatusFlag::degraded_model);
  publish(status);
  ++steps_;
  return done;
}

PALPATE_INLINE bool MovingTissue::take_forces() noexcept {
  const bool is_new = pressing_.update() || (others_ && others_->changed);
  drop_gone();
  if (others_ && is_new) add_others();
  return is_new;
}

/// Forces on vertices that a reset has dropped since the tick.
PALPATE_INLINE void MovingTissue::drop_gone() noexcept {
  Forces& given = pressing_.front();
  if (given.number == changed_.number) return;
  const auto is_gone = [&](int v) { return vertex(v) >= nodes_.size(); };
  detail::drop_items(given.item, given.count, [&](const VertexForce& f) { return is_gone(f.vertex); });
  detail::drop_items(given.pressed.item, given.pressed.count, is_gone);
  detail::drop_items(given.near_vertices.item, given.near_vertices.count, is_gone);
}

PALPATE_INLINE void MovingTissue::set_contact_forces(std::span<const VertexForce> forces) {
  const std::scoped_lock lock(changes_);
  if (!others_) others_ = std::make_unique<OtherForces>();
  const auto same = [](const VertexForce& a, const VertexForce& b) {
    return a.vertex == b.vertex && a.force == b.force;
  };
  others_->changed = others_->changed || !std::ranges::equal(others_->item, forces, same);
  others_->item.assign(forces.begin(), forces.end());
}

/// Where there is no room for the points, the forces act as loads.
PALPATE_INLINE void MovingTissue::add_others() noexcept {
  Forces& all = others_->all;
  all = pressing_.front();
  others_->changed = false;
  if (all.view == nullptr) {  // before the first tick
    all.view = &newest();
    all.number = all.view->number;
  }
  const bool has_points = all.points > 0 || all.count == 0;
  bool has_room = all.points + others_->item.size() <= most_points;
  const std::size_t ticked = all.count;
  for (const VertexForce& f : others_->item) {
    const auto end = all.item.begin() + static_cast<std::ptrdiff_t>(ticked);
    const auto same = std::find_if(all.item.begin(), end, [&](const VertexForce& g) { return g.vertex == f.vertex; });
    if (same != end)
      same->force += f.force;
    else if (all.count < most_forces)
      all.item[all.count++] = f;
    else
      has_room = false;  // not even for the force
    if (has_room) all.point[all.points++] = {{f.vertex, f.vertex, f.vertex}, {1.0, 0.0, 0.0}, f.force, false, true};
  }
  if (!has_room || !has_points) all.points = 0;
  others_->left_out = !has_room && takes_springs_;
}

/// Forces on a surface that a cut has changed since are loads: their points may no longer exist.
PALPATE_INLINE void MovingTissue::set_springs(const Forces& forces) noexcept {
  static_assert(detail::ContactSprings::most_per_point * most_points <= most_springs);
  springs_.clear();
  if (!takes_springs_) return;
  if (forces.points > 0 && forces.number == changed_.number) {
    const View& view = *forces.view;
    springs_.set(
        {forces.item.data(), forces.count}, {forces.point.data(), forces.points}, has_friction_, nodes_,
        [&](int v) { return Vector3(view.free[vertex(v)] - rest_[vertex(v)]); },
        [&](int i, int j) {
          const Matrix3* const ready = view.near_compliance.find(i, j);
          return ready != nullptr ? *ready : evaluate(view, i, j);
        });
  }
  motion_->set_springs(springs_.all());
}

/// Records the change of displacement since `moved_` that the change of forces since `before` has caused.
PALPATE_INLINE void MovingTissue::record_pair(const Forces& before, double error) noexcept {
  moved_before_.swap(moved_);
  find_moved(moved_);
  const bool is_recorded = secants_.record({before.item.data(), before.count}, {used_.item.data(), used_.count},
                                           moved_before_, moved_, error);
  found_stiffness_ = found_stiffness_ || (is_recorded && motion_->is_static());
}

PALPATE_INLINE bool MovingTissue::presses_beside_slit() const noexcept {
  const auto last = used_.item.begin() + static_cast<std::ptrdiff_t>(used_.count);
  return std::any_of(used_.item.begin(), last,
                     [&](const VertexForce& f) { return compliance_.is_beside_slit(vertex(f)); });
}

/// A body with a slit under the tool has another compliance. The iterations of the step have found it near the
/// direction of the forces.
PALPATE_INLINE void MovingTissue::record_response(Forces& part, const MotionStep& done) noexcept {
  constexpr double fraction = 0.85;
  full_.setZero();
  add(used_, 1.0 - fraction, full_);
  if (!done.taken || !motion_->respond_here(full_, response_)) return;
  part = used_;
  for (std::size_t k = 0; k < part.count; ++k)
    part.item[k].force = ModelVector(fraction * used_.item[k].force.in_model_axes());
  for (std::size_t i = 0; i < moved_.size(); ++i) moved_before_[i] = moved_[i] - node_vector(response_, nodes_[i]);
  secants_.record({part.item.data(), part.count}, {used_.item.data(), used_.count}, moved_before_, moved_, 0.0);
}

PALPATE_INLINE void MovingTissue::set_conditions(const Scene& scene) {
  const std::scoped_lock lock(changes_);
  const ScopedIdTranslation translation(original_ids());
  Scene mapped = this->mapped(scene, triangles_);
  const EssentialConditions changed = elastic_body().conditions(mapped);
  changed.require_components(elastic_body().conditions(this->scene()));
  VectorX applied = load_of(mapped, Vector3::Zero());
  VectorX load = load_of(mapped, local(scene.gravity(), pose()));
  std::string others = mapped.loads_in_words();
  motion_->set_prescribed(changed.prescribed);
  loaded_ = std::move(mapped);
  applied_.swap(applied);
  load_.swap(load);
  loads_changed_ = true;
  keep_loads(scene.gravity(), others);
}

PALPATE_INLINE void MovingTissue::set_gravity(const Vector3& gravity) {
  require_finite_gravity(gravity);
  const std::scoped_lock lock(changes_);
  load_ = applied_;
  loads_changed_ = true;
  const Vector3 own = local(gravity, pose());
  for (Index i = 0; i < mass_.size(); ++i) add_node_vector(load_, i, mass_[i] * own);
  keep_gravity(gravity);
}

PALPATE_INLINE void MovingTissue::set_pose(const Eigen::Isometry3d& pose) {
  require_rigid(pose);
  {
    const std::scoped_lock lock(changes_);
    place(pose);
  }
  set_gravity(gravity());
}

PALPATE_INLINE void MovingTissue::reset() {
  const std::scoped_lock lock(changes_);
  restart();
}

PALPATE_INLINE void MovingTissue::rest_at_start() {
  load_ = start_load_;
  motion_->set_load(load_);
  motion_->set_prescribed(start_prescribed_);
  motion_->rest_at(start_);
}

PALPATE_INLINE void MovingTissue::restart() {
  Scene loaded = scene();
  VectorX mass = elastic_body().nodal_mass();
  VectorX applied = load_of(loaded, Vector3::Zero());
  std::string others = loaded.loads_in_words();
  loaded_ = std::move(loaded);
  applied_.swap(applied);
  mass_.swap(mass);  // that of a body that is cut may differ by rounding
  rest_at_start();
  place(Eigen::Isometry3d::Identity());
  keep_loads(scene().gravity(), others);
  pressing_.update();
  pressing_.front() = {};  // of a session before the reset
  others_.reset();
  used_ = {};
  springs_.clear();
  agreement_.clear();
  has_springs_ = false;
  motion_->set_springs({});
  compliance_.set_scale(1.0);
  ticked_ = {};
  near_.count = pressed_.count = 0;  // of ticks before the reset
  secants_.clear();
  find_moved(moved_);
  loads_changed_ = was_slit_ = false;
  steps_ = 0;
  publish({});
}

PALPATE_INLINE void MovingTissue::change_surface(CutVertices surface, const VectorX& mass,
                                                 const detail::BlockPattern& pattern,
                                                 const std::vector<Vector3>& positions) {
  // Swapped, not assigned: a vector whose assignment finds no memory would be broken.
  detail::ForceAgreement agreement(surface.nodes.size());
  VectorX applied = applied_load(loaded_), load = applied;
  const Vector3 own = local(gravity(), pose());
  for (Index i = 0; i < mass.size(); ++i) add_node_vector(load, i, mass[i] * own);
  VectorX full = load, response = VectorX::Zero(load.size()), nodal_mass = mass;
  detail::NodalRotations rotations(pattern, positions, surface.nodes);
  applied_.swap(applied);
  load_.swap(load);
  full_.swap(full);
  response_.swap(response);
  rotations_ = std::move(rotations);
  was_slit_ = was_slit_ || mass.size() > mass_.size();
  loads_changed_ = true;  // a cut moves vertices, too
  mass_.swap(nodal_mass);
  split_ = detail::SplitVertices(surface.parent, nodes_.size(),
                                 [&](int v) { return mass_[Index{surface.nodes[vertex(v)]}]; });
  std::vector<Vector3> rest;
  for (const NodeId node : surface.nodes) rest.push_back(positions[static_cast<std::size_t>(node)]);
  if (stretches_) stretch_ = detail::SurfaceStretch(rest, surface.surface.triangles());
  springs_.resize(surface.nodes.size());
  agreement_ = std::move(agreement);
  compliance_ = detail::VertexCompliance(compliance_, std::move(surface.similar), std::move(surface.side));
  nodes_ = std::move(surface.nodes);
  rest_.swap(rest);
  list_every_vertex();
  if (motion_->is_quasi_static()) start_secants();
  const std::uint64_t number = changed_.number + 1;
  changed_ = make_view();
  changed_.number = number;
  changed_.surface = std::move(surface.surface);
  changed_.surface.expect(rest_, {});
  changed_.status = surface.status;
  changed_.contact = std::move(surface.contact);
}

PALPATE_INLINE SolveReport MovingTissue::displacement_with(std::span<const VertexForce>, VectorX& u) noexcept {
  drawn_.update();
  u = drawn_.front();
  motion_->complete(u);
  return {true, 0, 0.0};
}

PALPATE_INLINE VectorX MovingTissue::displacement(std::span<const VertexForce> forces) {
  detail::require_vertex_forces(forces, static_cast<int>(touchable_nodes().size()));
  VectorX u;
  displacement_with(forces, u);
  return u;
}

PALPATE_INLINE void MovingTissue::prepare_tools(const ToolRadii&, const ContactParameters& contact) {
  const std::scoped_lock lock(changes_);
  has_friction_ = contact.friction > 0.0;
  take_surface();  // contact points are placed on it
  views_.front().surface.set_loads(detail::loads_in_words(gravity(), other_loads()));
}

PALPATE_INLINE Status MovingTissue::require_columns(std::span<const int> vertices) noexcept {
  for (const int v : vertices) list(v, revision_, views_.front().required, pressed_);
  return {};
}

PALPATE_INLINE Matrix3 MovingTissue::evaluate(const View& view, int i, int j) const noexcept {
  const Matrix3 rotated = view.compliance.rotated(view.rotation, i, j);
  if (view.secants.count == 0) return rotated;
  return rotated + view.secants(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
}

PALPATE_INLINE Vector3 MovingTissue::displacement_of(int i, std::span<const VertexForce> forces) const noexcept {
  const View& view = views_.front();
  list(i, revision_, view.requested, near_);
  Vector3 u = Vector3::Zero(), unrotated = Vector3::Zero();
  const auto row = static_cast<std::size_t>(i);
  view.near_compliance.multiply(i, forces, u, [&](const VertexForce& f) {
    const Vector3& force = f.force.in_model_axes();
    unrotated += view.compliance.at_rest(row, vertex(f)) * (view.rotation[vertex(f)].transpose() * force);
    view.secants.add(row, vertex(f), force, u);
  });
  return u + view.rotation[row] * unrotated;
}

PALPATE_INLINE void MovingTissue::take_surface() noexcept {
  if (!views_.update()) return;
  ++revision_;
  near_.count = pressed_.count = 0;
}

PALPATE_INLINE Status MovingTissue::begin_tick() noexcept {
  take_surface();
  Status status = views_.front().status | ticked_;
  if (slow_.load(std::memory_order_relaxed)) status.set(StatusFlag::slow_tissue);
  if (failed_work_.load(std::memory_order_relaxed)) status.set(StatusFlag::stalled_tissue);
  return status;
}

PALPATE_INLINE void MovingTissue::end_tick(std::span<const VertexForce> forces,
                                           std::span<const PointForce> points) noexcept {
  Forces& out = pressing_.back();
  ticked_ = detail::copy_finite(forces, out.item, out.count);
  out.points = 0;
  const auto is_finite = [](const PointForce& p) { return all_finite(p.force.in_model_axes()); };
  if (points.size() <= most_points && std::all_of(points.begin(), points.end(), is_finite))
    for (const PointForce& p : points) out.point[out.points++] = p;
  else
    ticked_.set(points.size() > most_points ? StatusFlag::degraded_model : StatusFlag::non_finite_force);
  out.view = &views_.front();
  out.number = views_.front().number;
  out.pressed = pressed_;
  out.near_vertices = near_;
  pressing_.publish();
}

PALPATE_INLINE VectorX MovingTissue::applied_load(const Scene& scene) const {
  return elastic_body().applied_load(scene);
}

PALPATE_INLINE VectorX MovingTissue::load_of(const Scene& scene, const Vector3& gravity) const {
  VectorX load = applied_load(scene);
  if (!scene.initial_strains().empty()) {
    if (!accepts_initial_strains_)
      raise(SetupErrorKind::unsupported, "initial strains at large deformation or with viscoelasticity",
            "Use a linear material");
    load += elastic_body().initial_strain_load(elastic_body().initial_strains(scene));
  }
  for (Index i = 0; i < mass_.size(); ++i) add_node_vector(load, i, mass_[i] * gravity);
  if (!all_finite(load)) raise(SetupErrorKind::non_finite, "the loads are not finite");
  return load;
}

PALPATE_INLINE void MovingTissue::add(const Forces& forces, double factor, VectorX& load) const noexcept {
  for (std::size_t k = 0; k < forces.count; ++k)
    add_node_vector(load, nodes_[vertex(forces.item[k])], factor * forces.item[k].force.in_model_axes());
}

PALPATE_INLINE void MovingTissue::find_moved(std::vector<Vector3>& moved) const noexcept {
  for (std::size_t i = 0; i < moved.size(); ++i) moved[i] = node_vector(motion_->displacement(), nodes_[i]);
}

/// Where a press makes the tissue stiffer, ticks with the compliance at rest are unstable: the tool slides off.
PALPATE_INLINE void MovingTissue::follow_stiffness(const std::vector<Matrix3>& rotation) noexcept {
  constexpr double least = 0.2, followed = 0.3;  // part of the difference, in a step
  if (used_.count == 0) compliance_.set_scale(1.0);
  const double before = compliance_.scale(), found = std::clamp(before * found_compliance(rotation), least, 1.0);
  compliance_.set_scale(before + followed * (found - before));
}

/// With inertia displacements change for other reasons than forces, so that changes from step to step do not show the
/// compliance; the response of the last step does. It shows the compliance along the forces only. With friction, ticks
/// would use it across them, too, and sticking points would slip.
PALPATE_INLINE double MovingTissue::found_compliance(const std::vector<Matrix3>& rotation) noexcept {
  if (!motion_->is_quasi_static()) return springs_.empty() || has_friction_ ? 1.0 : response_ratio(rotation);
  return std::exchange(found_stiffness_, false) ? secants_.work_ratio(compliance_, rotation) : 1.0;
}

/// Accurate enough only where the tissue bears neither a small nor a large part of the forces.
PALPATE_INLINE double MovingTissue::response_ratio(const std::vector<Matrix3>& rotation) noexcept {
  constexpr double softest = 0.5, stiffest = 4.5;  // tissue, relative to what the springs were made for
  full_.setZero();
  add(used_, 1.0, full_);
  if (!motion_->respond_here(full_, response_)) return 1.0;
  std::array<VertexForce, most_forces> item = used_.item;
  const std::span<VertexForce> borne(item.data(), used_.count);  // by the tissue
  springs_.add_change(motion_->displacement(), response_, borne);
  double work = 0.0;
  for (const VertexForce& f : borne) work += f.force.in_model_axes().dot(node_vector(response_, nodes_[vertex(f)]));
  const double predicted = compliance_.work(rotation, borne), part = work / full_.dot(response_);
  const double stiffness = springs_.stiffness() * part / (1.0 - part);
  return part < 1.0 && stiffness >= softest && stiffness <= stiffest && predicted > 0.0 ? work / predicted : 1.0;
}

PALPATE_INLINE void MovingTissue::update_view(View& view) noexcept {
  const VectorX& u = motion_->displacement();
  const std::size_t n = nodes_.size();
  for (std::size_t i = 0; i < n; ++i) view.rotation[i] = rotations_(i, u);
  follow_stiffness(view.rotation);
  view.compliance.set_scale(compliance_.scale());
  secants_.find_terms(compliance_, view.rotation, view.secants);
  std::array<Vector3, most_forces> unrotated;
  for (std::size_t k = 0; k < used_.count; ++k)
    unrotated[k] = view.rotation[vertex(used_.item[k])].transpose() * used_.item[k].force.in_model_axes();
  for (std::size_t i = 0; i < n; ++i) {
    Vector3 moved = Vector3::Zero();
    for (std::size_t k = 0; k < used_.count; ++k) moved += compliance_.at_rest(i, vertex(used_.item[k])) * unrotated[k];
    moved = view.rotation[i] * moved;
    for (std::size_t k = 0; k < used_.count && view.secants.count > 0; ++k)
      moved += view.secants(i, vertex(used_.item[k])) * used_.item[k].force.in_model_axes();
    view.pressed[i] = rest_[i] + node_vector(u, nodes_[i]);
    view.free[i] = view.pressed[i] - moved;
  }
  if (stretches_)
    stretch_.find(view.pressed, view.rotation, view.half_space);
  else
    view.half_space = view.rotation;
  view.near_compliance.set(near_vertices(), used_.pressed.all(), [&](int i, int j) { return evaluate(view, i, j); });
}

/// The vertices whose displacement was requested; of a small surface all, since ticks look at further vertices in turn.
PALPATE_INLINE std::span<const int> MovingTissue::near_vertices() const noexcept {
  constexpr std::size_t most_blocks = 32768;
  const std::size_t all = every_.size();
  return all <= most_near && all * used_.pressed.count <= most_blocks ? std::span<const int>(every_)
                                                                      : used_.near_vertices.all();
}

/// By their energy: where parts are stiff, forces that hardly matter go from point to point.
PALPATE_INLINE void MovingTissue::compare_forces(const std::vector<Matrix3>& rotation) noexcept {
  if (springs_.empty()) return agreement_.compare(0.0, 0.0, false);
  const Forces& now = given();  // in the order of used_
  std::array<Vector3, most_forces> force, difference;
  for (std::size_t k = 0; k < used_.count; ++k) {
    const Matrix3 back = rotation[vertex(used_.item[k])].transpose();
    force[k] = back * now.item[k].force.in_model_axes();
    difference[k] = force[k] - back * used_.item[k].force.in_model_axes();
  }
  double of_difference = 0.0, of_force = 0.0;
  for (std::size_t k = 0; k < used_.count; ++k)
    for (std::size_t l = 0; l < used_.count; ++l) {
      const Matrix3 c = compliance_.at_rest(vertex(used_.item[k]), vertex(used_.item[l]));
      of_difference += difference[k].dot(c * difference[l]);
      of_force += force[k].dot(c * force[l]);
    }
  agreement_.compare(of_difference, of_force, has_friction_);
}

PALPATE_INLINE void MovingTissue::publish(Status status) noexcept {
  View& view = views_.back();
  VectorX& drawn = drawn_.back();
  const auto make_room = [&] {  // after a cut
    if (view.number != changed_.number) {
      View made = changed_;
      made.near_compliance.resize(nodes_.size(), most_near, most_pressed);
      view = std::move(made);
    }
    if (drawn.size() != motion_->displacement().size()) VectorX(motion_->displacement()).swap(drawn);
  };
  if (!detail::attempt(make_room)) return;  // no memory: the next step tries again
  update_view(view);
  view.surface.move_to(view.free, ++views_made_);
  view.surface.expect(view.pressed, {used_.item.data(), used_.count});
  compare_forces(view.rotation);
  view.status = status | changed_.status;
  if (agreement_.is_poor()) view.status.set(StatusFlag::solver_not_converged);
  newest_ = &view;
  views_.publish();
  drawn = motion_->displacement();
  drawn_.publish();
}

}}  // namespace palpate
