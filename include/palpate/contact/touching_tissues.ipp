// Definitions of touching_tissues.hpp.
#pragma once

#include <palpate/contact/touching_tissues.hpp>

#include <palpate/core/platform.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(TissueModel<TouchingTissue>);

PALPATE_INLINE TouchingTissue::TouchingTissue(const detail::InterfaceTissue& tissue, TouchingTissues& owner,
                                              int capacity)
    : owner_(owner), tissue_(tissue), claimed_(tissue_.view().claim()) {
  std::vector<int> all(static_cast<std::size_t>(tissue_.surface().vertex_count()));
  std::iota(all.begin(), all.end(), 0);
  if (!tissue_.can_touch_others())
    raise(SetupErrorKind::unsupported,
          "contact with other tissues for one that stiffens, or for a class around one that moves or is cut",
          "Use Condensed<...>, Implicit<...> or Cuttable<...> of these for a tissue that touches others");
  if (tissue_.surface().triangles().empty() && !tissue_.has_parts())
    raise(SetupErrorKind::bad_argument, "this tissue has no touchable surface",
          "Name a surface group with Scene::touch");
  if (!tissue_.changes() && !tissue_.view().require_columns(all).ok())
    raise(SetupErrorKind::unsupported, "contact with other tissues for one whose compliance columns are not all stored",
          "Use Condensed<...>, or ColumnFill::synchronous with compliance_slots for every touchable vertex");
  for (const int v : all) largest_bound_ = std::max(largest_bound_, tissue_.view().compliance_bound(v));
  View view;
  renew(view, tissue_.surface_number());
  views_.fill(view);
  number_ = exchanged_ = view.number;
  near_ = {all.size(), most_near};
  pressed_ = {all.size(), most_pressed};
  sum_.resize(capacity);
  const std::size_t most_forces = std::max(all.size(), tissue_.has_parts() ? most_on_parts : 0);
  given_.fill(
      {std::vector<VertexForce>(most_forces), 0, detail::VertexCopy(most_near), detail::VertexCopy(most_pressed)});
}

PALPATE_INLINE void TouchingTissue::renew(View& view, std::uint64_t number) {
  view.surface = tissue_.surface();
  accuracy_ = view.surface.shared_force_accuracy();
  if (!tissue_.view().has_contact_materials()) {
    view.surface.set_materials({});
    view.surface.set_subfacet(nullptr);
    accuracy_ = nullptr;
  }
  view.surface.expect(view.surface.positions(), {});
  const std::size_t vertices = view.surface.positions().size();
  view.near_compliance.resize(vertices, most_near, most_pressed);
  view.near_room = {vertices, most_near};
  view.pressed_room = {vertices, most_pressed};
  view.contact = tissue_.contact();
  view.number = number;
}

PALPATE_INLINE Matrix3 TouchingTissue::restrained(const View& view, int i, int j, const Matrix3& c) noexcept {
  if (view.rows == 0) return c;
  return c - restraint(view, i).transpose().lazyProduct(restraint(view, j));
}

PALPATE_INLINE Status TouchingTissue::require_columns(std::span<const int> vertices) noexcept {
  for (const int v : vertices) pressed_.add(v);
  return tissue_.view().require_columns(vertices);
}

PALPATE_INLINE Matrix3 TouchingTissue::compliance(int i, int j) const noexcept {
  const View& view = views_.front();
  near_.add(i);
  const Matrix3* const ready = view.near_compliance.find(i, j);
  return ready != nullptr ? *ready : restrained(view, i, j, tissue_.view().compliance(i, j));
}

PALPATE_INLINE Vector3 TouchingTissue::displacement_of(int i, std::span<const VertexForce> forces) const noexcept {
  const View& view = views_.front();
  near_.add(i);
  Vector3 u(0.0, 0.0, 0.0), others = u;
  auto sum = sum_.head(view.rows);
  sum.setZero();
  view.near_compliance.multiply(i, forces, u, [&](const VertexForce& f) {
    others += tissue_.view().compliance(i, f.vertex) * f.force.in_model_axes();
    sum += restraint(view, f.vertex).lazyProduct(f.force.in_model_axes());
  });
  if (view.rows > 0) others -= restraint(view, i).transpose().lazyProduct(sum);
  return u + others;
}

PALPATE_INLINE double TouchingTissue::compliance_bound(int j) const noexcept {
  const double bound = tissue_.view().compliance_bound(j);
  return std::sqrt(bound * std::max(bound, largest_bound_));
}

PALPATE_INLINE Status TouchingTissue::begin_tick() noexcept {
  Status status = tissue_.order_status();
  const bool is_behind = is_behind_.load(std::memory_order_acquire);
  if (is_behind) status.set(StatusFlag::degraded_model);
  // While a cut is made, the newest compliance may be that after it, and the surface that before.
  const bool may_differ = is_behind && !tissue_.moves();
  if (!may_differ && views_.update()) take_view();
  status |= of_tissue_ | ticked_ | views_.front().status;
  if (slow_.load(std::memory_order_relaxed)) status.set(StatusFlag::slow_tissue);
  if (failed_.load(std::memory_order_relaxed)) status.set(StatusFlag::stalled_tissue);
  return status;
}

/// A tissue that moves or is cut has another compliance then: it is taken together with that of the contact.
PALPATE_INLINE void TouchingTissue::take_view() noexcept {
  of_tissue_ = tissue_.begin_tick();
  ++revision_;
  View& view = views_.front();
  if (std::exchange(number_, view.number) != view.number) {
    std::swap(near_, view.near_room);
    std::swap(pressed_, view.pressed_room);
  }
  near_.clear();
  pressed_.clear();
  taken_.store(view.surface.revision(), std::memory_order_release);
  for (int v = 0; tissue_.changes() && v < contact_surface().vertex_count(); ++v)
    largest_bound_ = std::max(largest_bound_, tissue_.view().compliance_bound(v));
}

PALPATE_INLINE void TouchingTissue::exchange_contacts(ContactProblem& problem) noexcept {
  View& view = views_.front();
  if (std::exchange(exchanged_, number_) != number_ && view.contact != nullptr)
    problem.move_to(*view.contact, view.surface);
}

PALPATE_INLINE void TouchingTissue::end_tick(std::span<const VertexForce> forces,
                                             std::span<const PointForce> points) noexcept {
  Forces& out = given_.back();
  ticked_ = detail::copy_finite(forces, out.item, out.count);
  out.near_vertices.copy(near_.all());
  out.pressed.copy(pressed_.all());
  given_.publish();
  tissue_.view().end_tick(forces, points);
}

/// The surface of a tissue that can be cut, and of pieces, is made again, since its contact points depend on the tools.
PALPATE_INLINE void TouchingTissue::prepare_tools(const ToolRadii& radii, const ContactParameters& parameters) {
  const std::scoped_lock lock(owner_.changes_);
  tissue_.view().prepare_tools(radii, parameters);
  end_tick({});  // the tools of a servo before
  if (can_be_cut() || tissue_.surface_number() != number_) owner_.find_forces();
  begin_tick();
  end_tick({});
  exchanged_ = number_;
}

/// Blades cut a tissue that does not move as these forces displace it; one that moves knows its displacement.
PALPATE_INLINE void TouchingTissue::set_forces_for_blades(std::span<const VertexForce> of_others,
                                                          std::span<const VertexForce> of_tools) {
  if (!can_be_cut() || tissue_.moves()) return;
  std::vector<VertexForce> all(of_others.begin(), of_others.end());
  all.insert(all.end(), of_tools.begin(), of_tools.end());
  tissue_.set_contact_forces(all);
}

PALPATE_INLINE VectorX TouchingTissue::pushed_by(const View& view, std::span<const VertexForce> forces) {
  VectorX pushed = VectorX::Zero(view.rows);
  for (const VertexForce& f : forces) pushed += restraint(view, f.vertex) * f.force.in_model_axes();
  return pushed;
}

PALPATE_INLINE void TouchingTissue::move_surface(View& view, const VectorX& pushed, detail::InterfaceProblem& problem,
                                                 std::size_t body) {
  problem.displacement(body, moved_);
  std::vector<Vector3> free(tissue_.surface().positions()), pressed(free);
  for (std::size_t v = 0; v < free.size(); ++v) {
    const Vector3 moved(moved_[3 * v], moved_[3 * v + 1], moved_[3 * v + 2]);
    pressed[v] = problem.base(body)[v] + moved;
    free[v] += moved;
    if (view.rows > 0) free[v] += restraint(view, static_cast<int>(v)).transpose() * pushed;
  }
  view.surface.move_to(free, ++published_);
  view.surface.expect(pressed, given_.front().all());
}

PALPATE_INLINE void TouchingTissue::publish(detail::InterfaceProblem& problem, std::size_t body, Status status) {
  View& view = views_.back();
  if (view.number != problem.surface_number(body)) renew(view, problem.surface_number(body));
  const Forces& given = given_.front();
  view.rows = problem.pressing();
  problem.restraint(body, view.restraint);
  VectorX pushed = pushed_by(view, given.all());
  move_surface(view, pushed, problem, body);
  view.near_compliance.set(given.near_vertices.all(), given.pressed.all(),
                           [&](int i, int j) { return restrained(view, i, j, tissue_.compliance(i, j)); });
  view.surface.set_force_accuracy(view.rows > 0 ? nullptr : accuracy_);  // measured without other tissues
  view.status = status;
  problem.forces(body, drawn_.back());
  set_forces_for_blades(drawn_.back(), given.all());
  pushed_.swap(pushed);
  newest_ = &view;
  views_.publish();
  is_behind_.store(false, std::memory_order_release);
  drawn_.publish();
  updates_.fetch_add(1, std::memory_order_relaxed);
}

PALPATE_INLINE TouchingTissues::TouchingTissues(std::vector<detail::InterfaceTissue> tissues,
                                                const TissueContactOptions& options)
    : options_(options) {
  if (tissues.size() < (options.self_contact ? 1u : 2u))
    raise(SetupErrorKind::bad_argument, "contact between tissues for fewer than two",
          "Name all tissues that touch each other, or set self_contact");
  if (options.capacity < 1 || options.capacity > 1024)
    raise(SetupErrorKind::bad_argument, "a capacity of " + std::to_string(options.capacity) + " gaps between tissues",
          "Set TissueContactOptions::capacity to 1 to 1024");
  if (!(options.interval > 0.0 && options.interval < infinity))
    raise(SetupErrorKind::bad_argument, "an interval between contact solutions that is not positive",
          "Set TissueContactOptions::interval to about 0.01 s");
  for (std::size_t k = 0; k < tissues.size(); ++k)
    for (std::size_t l = 0; l < k; ++l)
      if (tissues[k].view().is_same(tissues[l].view()))
        raise(SetupErrorKind::bad_argument, "contact of a tissue with itself as if it were two",
              "Name every tissue once, and set self_contact where it may touch itself");
  for (std::size_t k = 0; k < tissues.size(); ++k)
    for (std::size_t l = 0; l < k; ++l)
      if (tissues[l].takes_from(tissues[k]))
        raise(SetupErrorKind::bad_argument, "pieces named before the tissue that they come from",
              "A tick would be without a piece that is cut off: name MovingPieces last");
  for (const detail::InterfaceTissue& t : tissues) {
    if (options.self_contact && t.view().can_be_cut())
      raise(SetupErrorKind::unsupported, "contact with itself for a tissue that can be cut",
            "The lips of a slit would press each other apart: leave self_contact out");
    tissues_.push_back(std::unique_ptr<TouchingTissue>(new TouchingTissue(t, *this, options.capacity)));
    next_work_.push_back(t.changes() ? 0.0 : infinity);
  }
  problem_ = std::make_unique<detail::InterfaceProblem>(std::move(tissues), options.capacity, options.self_contact);
  constexpr int most_solutions = 10;  // of bodies that overlap at first
  for (int i = 0; i < most_solutions && (i == 0 || report_.status.has(StatusFlag::solver_not_converged)); ++i) solve();
}

PALPATE_INLINE TissueGroup TouchingTissues::group() {
  TissueGroup group;
  for (const auto& t : tissues_) group.add(*t);
  return group;
}

PALPATE_INLINE TouchingTissue& TouchingTissues::tissue(std::size_t k) {
  if (k >= tissues_.size())
    raise(SetupErrorKind::index_out_of_range,
          "tissue " + std::to_string(k) + " of " + std::to_string(tissues_.size()) + " that touch each other");
  return *tissues_[k];
}

PALPATE_INLINE void TouchingTissues::reset() {
  const std::scoped_lock lock(changes_);
  for (const auto& t : tissues_) t->end_tick({});
  problem_->clear();
  find_forces();
}

PALPATE_INLINE void TouchingTissues::report_slow(bool slow) noexcept {
  for (const auto& t : tissues_) t->slow_.store(slow, std::memory_order_relaxed);
}
PALPATE_INLINE void TouchingTissues::report_failed(bool failed) noexcept {
  for (const auto& t : tissues_) t->failed_.store(failed, std::memory_order_relaxed);
}

PALPATE_INLINE std::span<const VertexForce> TouchingTissues::contact_forces(std::size_t k) {
  TouchingTissue& t = tissue(k);
  t.drawn_.update();
  return t.drawn_.front();
}

PALPATE_INLINE BackgroundStep TouchingTissues::background_work() {
  const std::scoped_lock lock(changes_);
  bool changed = false;
  for (std::size_t k = 0; k < tissues_.size(); ++k) {
    if (next_work_[k] > time_) continue;
    const std::uint64_t before = tissues_[k]->tissue_.surface_number();
    changed = work(k) || changed;
    if (tissues_[k]->tissue_.surface_number() == before) continue;
    for (const auto& t : tissues_) t->tissue_.take_pieces(tissues_[k]->tissue_);
  }
  if (changed || next_solution_ <= time_) {
    find_forces();
    next_solution_ = time_ + options_.interval;
  }
  const double before = time_;
  time_ = std::min(next_solution_, *std::ranges::min_element(next_work_));
  return {true, time_ - before};
}

/// Forces on vertices that a reset has dropped since the tick are left out.
PALPATE_INLINE void TouchingTissues::take_forces() {
  for (const auto& t : tissues_) {
    t->given_.update();
    TouchingTissue::Forces& given = t->given_.front();
    const int vertices = t->tissue_.surface().vertex_count();
    const auto is_gone = [vertices](int v) { return v >= vertices; };
    detail::drop_items(given.item, given.count, [&](const VertexForce& f) { return is_gone(f.vertex); });
    given.near_vertices.drop_if(is_gone);
    given.pressed.drop_if(is_gone);
  }
}

/// Gives a tissue that moves the forces of the others that follow from the last tick.
PALPATE_INLINE void TouchingTissues::follow_ticks(std::size_t k) {
  take_forces();
  VectorX pushed = VectorX::Zero(problem_->pressing());
  for (const auto& t : tissues_)
    if (t->pushed_.size() == pushed.size())  // else a solution has failed
      pushed += TouchingTissue::pushed_by(*t->newest_, t->given_.front().all()) - t->pushed_;
  problem_->follow(pushed);
  detail::InterfaceTissue& tissue = tissues_[k]->tissue_;
  problem_->forces(k, forces_);
  const int vertices = tissue.surface().vertex_count();  // fewer where it was reset
  std::erase_if(forces_, [vertices](const VertexForce& f) { return f.vertex >= vertices; });
  tissue.set_contact_forces(forces_);
}

/// Postpones a cut until ticks have the newest surface: with it they take the newest compliance, which must not be that
/// of the next cut. At most ten times, since there may be no ticks.
PALPATE_INLINE bool TouchingTissues::postpone_cut(TouchingTissue& t) noexcept {
  constexpr int most = 10;
  const bool is_taken = t.taken_.load(std::memory_order_acquire) == t.published_;
  t.postponed_ = is_taken || t.postponed_ == most ? 0 : t.postponed_ + 1;
  return t.postponed_ > 0;
}

/// Returns whether the contact must be solved again. A cut waits for the next interval after the last one, so that one
/// solution is for several cuts.
PALPATE_INLINE bool TouchingTissues::work(std::size_t k) {
  TouchingTissue& t = *tissues_[k];
  constexpr double wait = 2e-4;  // [s]
  if (t.tissue_.moves()) follow_ticks(k);
  if (t.tissue_.has_orders()) {
    if (!t.tissue_.moves() && postpone_cut(t)) {
      next_work_[k] = time_ + wait;
      return false;
    }
    t.is_behind_.store(true, std::memory_order_release);
  }
  const std::uint64_t before = t.tissue_.surface_number();
  const double next = t.tissue_.work().next;
  const bool is_cut = t.tissue_.surface_number() != before;
  next_work_[k] = time_ + (is_cut && !t.tissue_.moves() ? std::max(next, options_.interval) : next);
  t.is_behind_.store(is_cut, std::memory_order_release);
  return t.tissue_.moves() || is_cut;
}

PALPATE_INLINE void TouchingTissues::solve() {
  const std::scoped_lock lock(changes_);
  find_forces();
}

PALPATE_INLINE void TouchingTissues::find_forces() {
  const FlushDenormals flush;
  take_forces();
  for (std::size_t k = 0; k < tissues_.size(); ++k) problem_->load(k, tissues_[k]->given_.front().all());
  const Status status = problem_->solve();
  report_ = {static_cast<int>(problem_->rows().size()), 0, 0.0, status};
  for (const auto& r : problem_->rows()) {
    report_.pressing += r.force > 0.0;
    report_.force += r.force;
  }
  // A tick takes the surface of a tissue before that of its pieces: these are then published first.
  for (std::size_t k = tissues_.size(); k-- > 0;) tissues_[k]->publish(*problem_, k, status);
}

}}  // namespace palpate
