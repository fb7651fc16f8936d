// Definitions of moving_pieces.hpp.
#pragma once

#include <palpate/contact/detail/contact_samples.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/cut/detail/cut_view.hpp>
#include <palpate/cut/moving_pieces.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(TissueModel<MovingPieces>);

namespace detail {

/// a x b = cross_matrix(a) b
inline Matrix3 cross_matrix(const Vector3& a) noexcept {
  const double rows[3][3] = {{0.0, -a[2], a[1]}, {a[2], 0.0, -a[0]}, {-a[1], a[0], 0.0}};
  return matrix_of_rows(rows);
}

}  // namespace detail

/// step^2 (1 / m - [r_i] I^-1 [r_j])
PALPATE_INLINE Matrix3 MovingPieces::View::compliance(int i, int j) const noexcept {
  const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
  if (piece[a] != piece[b]) return Matrix3::Zero();
  const auto p = static_cast<std::size_t>(piece[a]);
  Matrix3 c = -1.0 * (detail::cross_matrix(arm[a]) * (by_moment[p] * detail::cross_matrix(arm[b])));
  for (int k = 0; k < 3; ++k) c(k, k) += by_force[p];
  return c;
}

PALPATE_INLINE MovingPieces::MovingPieces(const PieceParameters& parameters) : parameters_(parameters) {
  if (!(parameters.step > 0.0 && parameters.step < infinity))
    raise(SetupErrorKind::bad_argument, "pieces with a step that is not positive",
          "Set PieceParameters::step to about 0.002 s");
  if (!(parameters.friction >= 0.0 && parameters.friction < infinity))
    raise(SetupErrorKind::bad_argument, "pieces with friction that is negative or not finite",
          "Set PieceParameters::friction to about 0.2");
  set_gravity(parameters.gravity);
  given_.fill({std::vector<VertexForce>(most_forces), 0});
  make_surface();
  publish();
  views_.update();
}

PALPATE_INLINE void MovingPieces::set_gravity(const Vector3& gravity) {
  if (!all_finite(gravity))
    raise(SetupErrorKind::bad_argument, "gravity of pieces that is not finite", "Set it in m/s^2");
  const std::scoped_lock lock(changes_);
  parameters_.gravity = gravity;
}

PALPATE_INLINE int MovingPieces::add(DetachedPiece piece, const Vector3& velocity) {
  const int points = static_cast<int>(piece.points.size());
  const Matrix3& inertia = piece.inertia;
  const bool is_positive = inertia(0, 0) > 0.0 && inertia(0, 0) * inertia(1, 1) > inertia(0, 1) * inertia(1, 0) &&
                           determinant(inertia) > 0.0 && all_finite(inertia);
  if (!(piece.mass > 0.0 && piece.mass < infinity) || !is_positive)
    raise(SetupErrorKind::bad_density, "a piece whose mass or inertia is not positive and finite", "Give it both");
  bool is_finite = all_finite(piece.centre) && all_finite(velocity);
  for (const Vector3& p : piece.points) is_finite = is_finite && all_finite(p);
  if (!is_finite)
    raise(SetupErrorKind::non_finite, "a piece with a centre, point or velocity that is not finite",
          "Give all in SI units");
  if (piece.triangles.empty())
    raise(SetupErrorKind::bad_argument, "a piece without surface", "Give it triangles, outward");
  for (const auto& t : piece.triangles)
    for (const int v : t)
      if (v < 0 || v >= points)
        raise(SetupErrorKind::index_out_of_range,
              "a triangle with point " + std::to_string(v) + " of a piece with " + std::to_string(points));
  const std::scoped_lock lock(changes_);
  Piece made = make_piece(std::move(piece), velocity);
  reserve({&made, 1});
  insert(std::move(made));
  return static_cast<int>(pieces_.size()) - 1;
}

/// Velocities are those in the middle between two steps, so that a step is exact in free flight.
PALPATE_INLINE MovingPieces::Piece MovingPieces::make_piece(DetachedPiece given, const Vector3& velocity) const {
  Piece piece;
  piece.shape = std::make_shared<const DetachedPiece>(std::move(given));
  const DetachedPiece& shape = *piece.shape;
  piece.now.centre = shape.centre;
  piece.inverse_inertia = inverse(shape.inertia);
  piece.velocity = velocity - 0.5 * parameters_.step * parameters_.gravity;
  for (const Vector3& p : shape.points) {
    piece.arms.push_back(p - shape.centre);
    piece.radius = std::max(piece.radius, piece.arms.back().norm());
  }
  predict(piece);
  return piece;
}

/// Allocates room for more pieces.
PALPATE_INLINE void MovingPieces::reserve(std::span<const Piece> more) {
  std::size_t vertices = piece_of_.size();
  for (const Piece& piece : more) vertices += piece.arms.size();
  piece_of_.reserve(vertices);
  pieces_.reserve(pieces_.size() + more.size());
}

/// After `reserve`.
PALPATE_INLINE void MovingPieces::insert(Piece&& piece) noexcept {
  piece.first = piece_of_.size();
  piece_of_.insert(piece_of_.end(), piece.arms.size(), static_cast<int>(pieces_.size()));
  pieces_.push_back(std::move(piece));
  changed_ = true;
}

PALPATE_INLINE void MovingPieces::remove(int id) {
  const std::scoped_lock lock(changes_);
  const auto p = static_cast<std::size_t>(id);
  if (id < 0 || p >= pieces_.size() || pieces_[p].is_removed)
    raise(SetupErrorKind::index_out_of_range, "piece " + std::to_string(id) + " does not exist");
  pieces_[p].is_removed = changed_ = true;
}

PALPATE_INLINE void MovingPieces::clear() {
  const std::scoped_lock lock(changes_);
  pieces_.clear();
  piece_of_.clear();
  others_.clear();
  end_tick({});
  make_surface();
  publish();
  views_.update();
}

PALPATE_INLINE std::vector<MovingPiece> MovingPieces::pieces() const {
  const std::scoped_lock lock(changes_);
  std::vector<MovingPiece> all;
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const Piece& piece = pieces_[p];
    if (piece.is_removed) continue;
    const Matrix3& r = piece.now.rotation;
    all.push_back(
        {static_cast<int>(p), piece.shape, make_pose(r, piece.now.centre - r * piece.shape->centre), piece.velocity});
  }
  return all;
}

PALPATE_INLINE bool MovingPieces::takes_from(const void* tissue) const {
  const std::scoped_lock lock(changes_);
  return std::ranges::any_of(sources_, [tissue](const Source& s) { return s.tissue == tissue; });
}

PALPATE_INLINE void MovingPieces::take_pieces(const void* tissue) {
  const std::scoped_lock lock(changes_);
  for (const Source& source : sources_) {
    if (source.tissue != tissue) continue;
    std::vector<Index> elements;
    std::vector<Piece> found;
    for (DetachedPiece& piece : source.find()) {
      elements.insert(elements.end(), piece.elements.begin(), piece.elements.end());
      found.push_back(make_piece(std::move(piece), Vector3::Zero()));
      found.back().is_fresh = false;  // shown before the next step
    }
    if (found.empty()) continue;
    reserve(found);
    source.remove(elements);  // the last call that may throw: afterwards all pieces are here
    for (Piece& piece : found) insert(std::move(piece));
  }
  if (!changed_) return;
  make_surface();
  publish();
}

PALPATE_INLINE Matrix3 MovingPieces::inverse_inertia(const Piece& piece, const Matrix3& rotation) const noexcept {
  return rotation * (piece.inverse_inertia * rotation.transpose());
}

PALPATE_INLINE void MovingPieces::add_loads(std::span<const VertexForce> forces,
                                            std::vector<Load>& loads) const noexcept {
  for (Load& load : loads) load = {};
  for (const VertexForce& f : forces) {
    const auto v = static_cast<std::size_t>(f.vertex);
    if (v >= piece_of_.size()) continue;
    const auto p = static_cast<std::size_t>(piece_of_[v]);
    const Piece& piece = pieces_[p];
    const Vector3 arm = piece.free.rotation * piece.arms[v - piece.first], force = f.force.in_model_axes();
    loads[p].force += force;
    loads[p].moment += cross(arm, force);
  }
}

/// The present step, for the forces at its end. Tissue moves the piece out of its way, but no part of its impulse makes
/// the piece leave faster than it would without: the energy does not grow.
PALPATE_INLINE void MovingPieces::correct(Piece& piece, const Load& tools, const Load& others) const noexcept {
  const double h = parameters_.step, compliance = h * h / piece.shape->mass;
  piece.after_tool = tools.force.squaredNorm() > 0.0 ? steps_after_tool : std::max(0, piece.after_tool - 1);
  piece.mobility = piece.after_tool > 0 ? std::min(1.0, largest_compliance / compliance) : 1.0;
  const double by_force = h * piece.mobility / piece.shape->mass;
  const Matrix3 inverse = inverse_inertia(piece, piece.free.rotation);
  const Vector3 velocity = (piece.free.centre - piece.now.centre) / h + by_force * tools.force;
  const Vector3 momentum = piece.angular_momentum + h * piece.mobility * tools.moment;
  Vector3 pushed = velocity + by_force * others.force, twisted = momentum + h * piece.mobility * others.moment;
  slow_down(piece, others.force, pushed, twisted);
  piece.now.centre += h * pushed;
  piece.now.rotation = rotation_by(h * (inverse * (twisted - piece.angular_momentum))) * piece.free.rotation;

  const double before = others.force.dot(velocity) + others.moment.dot(inverse * momentum);
  const double change =
      by_force * others.force.squaredNorm() + h * piece.mobility * others.moment.dot(inverse * others.moment);
  const double used = change > 0.0 ? std::clamp(-before / change, 0.0, 1.0) : 0.0;
  piece.velocity = velocity + used * by_force * others.force;
  piece.angular_momentum = momentum + used * h * piece.mobility * others.moment;
  slow_down(piece, others.force, piece.velocity, piece.angular_momentum);
}

/// Coulomb friction of the resulting force of the tissue.
PALPATE_INLINE void MovingPieces::slow_down(const Piece& piece, const Vector3& force, Vector3& velocity,
                                            Vector3& angular_momentum) const noexcept {
  const double magnitude = force.norm(), impulse = parameters_.friction * parameters_.step * piece.mobility * magnitude;
  if (!(impulse > 0.0)) return;
  const Vector3 normal = force / magnitude;
  const auto slow = [](Vector3& value, const Vector3& part, double most) {
    const double length = part.norm();
    if (length > 0.0) value -= std::min(1.0, most / length) * part;
  };
  const Vector3 sliding = velocity - normal.dot(velocity) * normal;
  slow(velocity, sliding, impulse / piece.shape->mass);
  const Vector3 twisting = normal.dot(angular_momentum) * normal;
  slow(angular_momentum, twisting, impulse * piece.radius);
}

/// The rotation is that of the velocity in the middle of the step (explicit midpoint rule).
PALPATE_INLINE void MovingPieces::predict(Piece& piece) const noexcept {
  const double h = parameters_.step;
  piece.free.centre = piece.now.centre + h * (piece.velocity + h * piece.mobility * parameters_.gravity);
  const auto spin = [&](const Matrix3& rotation) {
    return Vector3(inverse_inertia(piece, rotation) * piece.angular_momentum);
  };
  const Matrix3 middle = rotation_by(0.5 * h * spin(piece.now.rotation)) * piece.now.rotation;
  piece.free.rotation = rotation_by(h * spin(middle)) * piece.now.rotation;
}

PALPATE_INLINE BackgroundStep MovingPieces::background_work() {
  const std::scoped_lock lock(changes_);
  given_.update();
  by_tools_.resize(pieces_.size());
  by_others_.resize(pieces_.size());
  add_loads({given_.front().item.data(), given_.front().count}, by_tools_);
  add_loads(others_, by_others_);
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    if (pieces_[p].is_removed || std::exchange(pieces_[p].is_fresh, false)) continue;
    correct(pieces_[p], by_tools_[p], by_others_[p]);
    predict(pieces_[p]);
  }
  ++steps_;
  if (changed_) make_surface();
  publish();
  return {true, parameters_.step};
}

/// Of the pieces as they are now. Facets that are too long for contact points are left out.
PALPATE_INLINE void MovingPieces::make_surface() {
  positions_.clear();
  std::vector<Triangle> triangles;
  parts_.clear();
  double longest = 0.0;
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const Piece& piece = pieces_[p];
    for (const Vector3& arm : piece.arms) positions_.push_back(piece.free.centre + piece.free.rotation * arm);
    longest = std::max(longest, 2.0 * piece.radius);
    if (piece.is_removed) continue;
    const int first = static_cast<int>(piece.first);
    for (const auto& t : piece.shape->triangles) triangles.push_back({first + t[0], first + t[1], first + t[2]});
    parts_.resize(triangles.size(), static_cast<Index>(p));
  }
  const ToolRadii radii = radii_.smallest > 0.0 ? radii_ : ToolRadii(longest > 0.0 ? longest : 1.0);
  left_out_ = detail::erase_stretched(positions_, detail::ContactSamples::maximum_subdivision * radii.smallest,
                                      triangles, parts_);
  surface_ = ContactSurface(positions_, std::move(triangles));
  surface_.set_rigid(true);
  contact_ = std::make_shared<ContactProblem>(surface_, radii, contact_parameters_);
  ++number_;
  changed_ = false;
}

PALPATE_INLINE void MovingPieces::publish() {
  View& view = views_.back();
  const bool is_new = view.number != number_;
  if (is_new) {
    view.surface = surface_;
    view.piece = piece_of_;
    view.contact = contact_;
    view.left_out = left_out_;
    view.number = number_;
  }
  positions_.resize(piece_of_.size());
  view.arm.resize(piece_of_.size());
  view.bound.assign(piece_of_.size(), 0.0);
  view.by_force.resize(pieces_.size());
  view.by_moment.resize(pieces_.size());
  const double squared = parameters_.step * parameters_.step;
  double largest = 0.0, smallest = infinity;
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const Piece& piece = pieces_[p];
    view.by_force[p] = piece.mobility * squared / piece.shape->mass;
    view.by_moment[p] = piece.mobility * squared * inverse_inertia(piece, piece.free.rotation);
    for (std::size_t k = 0; k < piece.arms.size(); ++k) {
      const std::size_t v = piece.first + k;
      view.arm[v] = piece.free.rotation * piece.arms[k];
      positions_[v] = piece.free.centre + view.arm[v];
      view.bound[v] = view.by_force[p] + view.by_moment[p].norm() * piece.radius * piece.arms[k].norm();
      largest = std::max(largest, view.bound[v]);
      smallest = std::min(smallest, view.bound[v]);
    }
  }
  view.floor = largest > 0.0 ? std::min(1e-9 * largest, 1e-7 * smallest) : 1e-12;
  view.revision = ++revision_;
  view.surface.move_to(positions_, revision_);
  newest_ = &view;
  views_.publish();
}

PALPATE_INLINE Status MovingPieces::begin_tick() noexcept {
  views_.update();
  Status status = ticked_;
  if (slow_.load(std::memory_order_relaxed)) status.set(StatusFlag::slow_tissue);
  if (failed_.load(std::memory_order_relaxed)) status.set(StatusFlag::stalled_tissue);
  if (views_.front().left_out) status.set(StatusFlag::degraded_model);
  return status;
}

PALPATE_INLINE void MovingPieces::end_tick(std::span<const VertexForce> forces, std::span<const PointForce>) noexcept {
  Forces& out = given_.back();
  ticked_ = detail::copy_finite(forces, out.item, out.count);
  given_.publish();
}

PALPATE_INLINE void MovingPieces::exchange_contacts(ContactProblem& problem) noexcept {
  const View& view = views_.front();
  if (std::exchange(seen_, view.number) != view.number) problem.move_to(*view.contact, view.surface);
}

PALPATE_INLINE void MovingPieces::prepare_tools(const ToolRadii& radii, const ContactParameters& contact) {
  const std::scoped_lock lock(changes_);
  radii_ = radii;
  contact_parameters_ = contact;
  make_surface();
  publish();
  views_.update();
  seen_ = views_.front().number;
}

}}  // namespace palpate
