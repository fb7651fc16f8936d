// Definitions of interface_problem.hpp.
#pragma once

#include <palpate/contact/detail/interface_problem.hpp>
#include <palpate/core/rigid_motion.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

using InterfaceVector = Eigen::Map<Eigen::VectorXd>;
using ConstInterfaceVector = Eigen::Map<const Eigen::VectorXd>;

PALPATE_INLINE InterfaceProblem::InterfaceProblem(std::vector<InterfaceTissue> tissues, int capacity, bool self_contact)
    : problem_(capacity), capacity_(capacity), self_contact_(self_contact) {
  for (const InterfaceTissue& tissue : tissues) bodies_.push_back(make_body(tissue));
  for (std::size_t k = 0; k < bodies_.size(); ++k) load(k, {});
}

PALPATE_INLINE InterfaceProblem::Body InterfaceProblem::make_body(const InterfaceTissue& tissue) {
  Body body{tissue, tissue.view().to_world()};
  const ContactSurface& surface = tissue.surface();
  const ContactSurface& boundary = surface.boundary();
  body.triangles = surface.triangles();
  body.parts.assign(tissue.parts().begin(), tissue.parts().end());
  body.number = tissue.surface_number();
  body.base = body.now = surface.positions();
  body.bvh = surface.bvh();
  body.depths =
      interface_depths(body.triangles, surface.positions(), boundary.triangles(), boundary.positions(), boundary.bvh());
  for (const Triangle& t : body.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      body.edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  std::ranges::sort(body.edges);
  body.edges.erase(std::unique(body.edges.begin(), body.edges.end()), body.edges.end());
  for (const double depth : body.depths) body.deepest = std::max(body.deepest, depth);
  for (int t = 0; t < static_cast<int>(body.triangles.size()); ++t) body.facet_length += surface.facet_length(t);
  body.facet_length /= std::max(1.0, static_cast<double>(body.triangles.size()));
  return body;
}

PALPATE_INLINE void InterfaceProblem::load(std::size_t k, std::span<const VertexForce> tools) {
  Body& body = bodies_[k];
  const Eigen::Isometry3d before = body.pose;
  body.pose = body.tissue.view().to_world();
  const ContactSurface& surface = body.tissue.surface();
  const bool is_placed = before.matrix() != body.pose.matrix(), is_cut = body.number != body.tissue.surface_number();
  const bool is_renewed = surface.revision() != body.revision;
  if (is_cut) renew(k);
  body.revision = surface.revision();
  if (is_placed || is_cut || (is_renewed && !body.tissue.moves())) moved_at_rest_ = true;
  if (is_placed || (is_renewed && body.tissue.moves())) mark_stale(k);
  for (int v = 0; v < surface.vertex_count(); ++v)
    body.base[at(v)] = surface.position(v) + body.tissue.displacement(v, tools);
}

/// The triangles are others, and the compliance. Forces stay on the vertices that are still on a triangle; edges that
/// press are found again.
PALPATE_INLINE void InterfaceProblem::renew(std::size_t k) {
  bodies_[k] = make_body(bodies_[k].tissue);
  const int body = static_cast<int>(k);
  const ContactSurface& surface = bodies_[k].tissue.surface();
  const auto is_gone = [&](const InterfaceTerm& t) {
    return t.body == body && (t.vertex >= surface.vertex_count() || surface.triangles_at(t.vertex).empty());
  };
  std::erase_if(rows_, [&](const Row& r) {
    return r.side_of(body) >= 0 && (r.row.key.part == InterfacePart::edge || std::ranges::any_of(r.row.terms, is_gone));
  });
  pressing_.clear();
  for (Row& r : rows_)
    if (r.side_of(body) >= 0)
      for (std::vector<double>& column : r.response) column.clear();
}

/// The compliance of a tissue that moves changes with every step; columns are in the frame of the body.
PALPATE_INLINE void InterfaceProblem::mark_stale(std::size_t k) noexcept {
  for (Row& r : rows_) r.stale = r.stale || r.side_of(static_cast<int>(k)) >= 0;
}

PALPATE_INLINE InterfaceSurface InterfaceProblem::surface(std::size_t k) const noexcept {
  const Body& body = bodies_[k];
  return {static_cast<int>(k), body.triangles, body.now, &body.bvh, body.depths, body.parts};
}

/// The normal of a row in the frame of a body.
PALPATE_INLINE Vector3 InterfaceProblem::direction(const InterfaceRow& row, int body) const noexcept {
  return palpate::rotation_of(bodies_[at(body)].pose).transpose() * row.normal;
}

PALPATE_INLINE void InterfaceProblem::displacement(std::size_t k, std::vector<double>& u) const {
  u.assign(3 * bodies_[k].base.size(), 0.0);
  for (const Row& r : rows_) {
    const int side = r.side_of(static_cast<int>(k));
    if (side < 0 || !(r.force > 0.0)) continue;
    const auto n = static_cast<Eigen::Index>(u.size());
    InterfaceVector(u.data(), n) += r.force * ConstInterfaceVector(r.response[at(side)].data(), n);
  }
}

PALPATE_INLINE void InterfaceProblem::forces(std::size_t k, std::vector<VertexForce>& forces) const {
  std::vector<Vector3> sum(bodies_[k].base.size(), Vector3(0.0, 0.0, 0.0));
  for (const Row& r : rows_)
    for (const InterfaceTerm& t : r.row.terms)
      if (at(t.body) == k && r.followed > 0.0) sum[at(t.vertex)] += r.followed * t.weight * direction(r.row, t.body);
  forces.clear();
  for (std::size_t v = 0; v < sum.size(); ++v)
    if (sum[v].squaredNorm() > 0.0) forces.push_back({static_cast<int>(v), ModelVector(sum[v])});
}

/// Whether parts move so far from the last solution that they could pass through another body.
PALPATE_INLINE bool InterfaceProblem::find_paths() noexcept {
  constexpr double considerable = 0.25;  // of a mean facet
  bool found = false;
  for (Body& body : bodies_) {
    body.path = 0.0;
    for (std::size_t v = 0; v < body.base.size() && !body.parts.empty(); ++v)
      body.path = std::max(body.path, (body.pose * body.base[v] - body.now[v]).norm());
    found = found || body.path > considerable * body.facet_length;
  }
  return found;
}

/// Returns by how much a vertex moves at most, relative to what rows displace one. Of parts, which rows displace by
/// what a step moves them, a thousandth of a facet is nothing.
PALPATE_INLINE double InterfaceProblem::move_bodies() {
  constexpr double nothing = 1e-3;  // of a mean facet
  double change = 0.0, largest = 0.0;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    Body& body = bodies_[k];
    displacement(k, moved_);
    const double least = body.parts.empty() ? 0.0 : nothing * body.facet_length;
    for (std::size_t v = 0; v < body.base.size(); ++v) {
      const Vector3 u(moved_[3 * v], moved_[3 * v + 1], moved_[3 * v + 2]), now = body.pose * (body.base[v] + u);
      const double moved = (now - body.now[v]).squaredNorm();
      if (moved > least * least) change = std::max(change, moved);
      largest = std::max(largest, u.squaredNorm());
      body.now[v] = now;
    }
    body.bvh.refit(body.triangles, body.now);
  }
  return change > 0.0 ? std::sqrt(change / std::max(change, largest)) : 0.0;
}

/// False where rows that contradict each other have moved a body by more than its size.
PALPATE_INLINE bool InterfaceProblem::keeps_shape() const noexcept {
  for (const Body& body : bodies_) {
    if (body.triangles.empty()) continue;  // all of it has been cut away
    const double size = body.tissue.surface().bvh().bounds().size().norm() + body.path;
    for (std::size_t v = 0; v < body.now.size(); ++v)
      if (!((body.now[v] - body.pose * body.base[v]).norm() <= size)) return false;
  }
  return true;
}

/// Whether a row may keep the columns of another one: forces then differ by about as much.
inline bool is_like(const InterfaceRow& a, const InterfaceRow& b) noexcept {
  constexpr double same = 5e-3;
  if (a.terms.size() != b.terms.size() || (a.normal - b.normal).norm() > same) return false;
  for (std::size_t k = 0; k < a.terms.size(); ++k)
    if (a.terms[k].body != b.terms[k].body || a.terms[k].vertex != b.terms[k].vertex ||
        std::abs(a.terms[k].weight - b.terms[k].weight) > same)
      return false;
  return true;
}

/// The surface with shorter facets has the rows.
PALPATE_INLINE void InterfaceProblem::find_rows(bool along_paths) {
  constexpr double reach = 0.25;  // of a mean facet: what may touch in the next linearisation
  geometry_.clear();
  for (std::size_t k = 0; k < bodies_.size(); ++k)
    for (std::size_t l = k; l < bodies_.size(); ++l) {
      const bool touches = k != l || self_contact_ || !bodies_[k].parts.empty();
      if (!touches || bodies_[k].triangles.empty() || bodies_[l].triangles.empty()) continue;
      const bool first = bodies_[k].facet_length <= bodies_[l].facet_length;
      const InterfaceSurface one = surface(first ? k : l), two = surface(first ? l : k);
      const double paths = along_paths ? bodies_[k].path + bodies_[l].path : 0.0;
      geometry_.add(one, two, reach * std::min(bodies_[k].facet_length, bodies_[l].facet_length) + paths);
    }
  note_closed(geometry_.rows());
  for (std::size_t k = 0; k < bodies_.size(); ++k)
    for (std::size_t l = 0; l < bodies_.size(); ++l)
      if (k != l) {
        add_entered(k, l);
        add_crossings(k, l);
      }
  std::ranges::sort(geometry_.rows(), {}, &InterfaceRow::key);
  before_.swap(rows_);
  rows_.clear();
  auto old = before_.begin();
  for (InterfaceRow& row : geometry_.rows()) {
    while (old != before_.end() && old->row.key < row.key) ++old;
    const bool known = old != before_.end() && old->row.key == row.key;
    rows_.push_back({std::move(row), known ? old->force : 0.0});
    if (!known || old->stale || !is_like(old->row, rows_.back().row)) continue;
    rows_.back().row = old->row;
    rows_.back().response.swap(old->response);
  }
}

/// Of rows that have none.
PALPATE_INLINE void InterfaceProblem::find_responses() {
  struct Load {
    int vertex;
    std::size_t row, side;
    Vector3 force;
  };
  std::vector<std::size_t> fresh;
  for (std::size_t r = 0; r < rows_.size(); ++r)
    if (rows_[r].response.front().empty()) fresh.push_back(r);
  std::vector<Load> loads;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    loads.clear();
    const int vertices = static_cast<int>(bodies_[k].base.size());
    for (const std::size_t r : fresh) {
      const int side = rows_[r].side_of(static_cast<int>(k));
      if (side < 0) continue;
      rows_[r].response[at(side)].assign(3 * at(vertices), 0.0);
      const Vector3 normal = direction(rows_[r].row, static_cast<int>(k));
      for (const InterfaceTerm& t : rows_[r].row.terms)
        if (at(t.body) == k) loads.push_back({t.vertex, r, at(side), t.weight * normal});
    }
    std::ranges::stable_sort(loads, {}, &Load::vertex);
    column_.resize(9 * at(vertices));
    for (std::size_t i = 0; i < loads.size();) {
      const int vertex = loads[i].vertex;
      bodies_[k].tissue.column(vertex, column_);
      const std::size_t n = 3 * at(vertices);
      for (; i < loads.size() && loads[i].vertex == vertex; ++i) {
        const auto column = [&](std::size_t b) {
          return ConstInterfaceVector(column_.data() + b * n, static_cast<Eigen::Index>(n));
        };
        InterfaceVector(rows_[loads[i].row].response[loads[i].side].data(), static_cast<Eigen::Index>(n)) +=
            loads[i].force[0] * column(0) + loads[i].force[1] * column(1) + loads[i].force[2] * column(2);
      }
    }
  }
}

PALPATE_INLINE void InterfaceProblem::limit_rows(Status& status) {
  for (Row& r : rows_) {
    r.gap = 0.0;
    for (const InterfaceTerm& t : r.row.terms) {
      const Body& body = bodies_[at(t.body)];
      r.gap += t.weight * r.row.normal.dot(body.pose * body.base[at(t.vertex)]);
    }
  }
  if (rows_.size() <= at(capacity_)) return;
  status.set(StatusFlag::degraded_model);
  std::ranges::sort(rows_, {}, [](const Row& r) { return r.force > 0.0 ? -infinity : r.gap; });
  rows_.resize(at(capacity_));
  std::ranges::sort(rows_, {}, [](const Row& r) { return r.row.key; });
}

PALPATE_INLINE void InterfaceProblem::assemble() {
  const int n = static_cast<int>(rows_.size());
  problem_.resize(n);
  for (int r = 0; r < n; ++r) {
    const InterfaceRow& row = rows_[at(r)].row;
    const Vector3 of_first = direction(row, row.key.body), of_other = direction(row, row.key.other);
    problem_.b[at(r)] = rows_[at(r)].gap;
    problem_.lambda[at(r)] = rows_[at(r)].force;
    for (int s = 0; s <= r; ++s) {
      double w = 0.0;
      for (const InterfaceTerm& t : row.terms) {
        const int side = rows_[at(s)].side_of(t.body);
        if (side < 0) continue;
        const Vector3& d = t.body == row.key.body ? of_first : of_other;
        w += t.weight * rows_[at(s)].response_of(at(side), t.vertex, d);
      }
      problem_.w(r, s) = problem_.w(s, r) = w;
    }
  }
}

/// The relaxation of the problem is taken back by solving again for its rest (proximal point iteration).
PALPATE_INLINE bool InterfaceProblem::find_forces() {
  constexpr int corrections = 2;
  bool solved = problem_.solve();
  for (int i = 0; i < corrections && solved; ++i) {
    for (int r = 0; r < problem_.rows(); ++r)
      problem_.b[at(r)] =
          rows_[at(r)].gap - ComplementarityProblem::relaxation * problem_.w(r, r) * problem_.lambda[at(r)];
    solved = problem_.solve_again();
  }
  for (int r = 0; r < problem_.rows(); ++r) rows_[at(r)].force = rows_[at(r)].followed = problem_.lambda[at(r)];
  return solved;
}

PALPATE_INLINE Status InterfaceProblem::solve() {
  constexpr int most_linearisations = 8;
  constexpr double tolerance = 1e-3, flagged = 0.05;  // of the displacement between two of them
  Status status;
  double change = infinity;
  bool solved = true, is_dropped = false;
  if (std::exchange(moved_at_rest_, false)) overlaps_ = overlap_at_rest();
  find_responses();  // of rows at surfaces that have changed
  const bool along_paths = find_paths();
  if (!along_paths) move_bodies();
  for (int i = 0; i < most_linearisations && change > tolerance; ++i) {
    status = {};
    find_rows(along_paths && i == 0);
    limit_rows(status);
    find_responses();
    assemble();
    solved = find_forces();
    change = move_bodies();
    if (!keeps_shape()) {
      for (Row& r : rows_) r.force = r.followed = 0.0;
      is_dropped = true;
      move_bodies();
    }
  }
  if (!solved || is_dropped || change > flagged) status.set(StatusFlag::solver_not_converged);
  if (has_entered()) status.set(StatusFlag::lost_contact);
  if (overlaps_) status.set(StatusFlag::large_displacement);
  if (is_coarse()) status.set(StatusFlag::coarse_contact);
  factor_pressing();
  return status;
}

/// Whether two surfaces that press each other do so with a few rows only. The force on rigid parts does not depend on
/// their number.
PALPATE_INLINE bool InterfaceProblem::is_coarse() const noexcept {
  constexpr int few = 7;
  constexpr double considerable = 0.05;  // of all forces
  double all = 0.0;
  for (const Row& r : rows_) all += r.force;
  for (std::size_t k = 0; k < bodies_.size(); ++k)
    for (std::size_t l = k; l < bodies_.size(); ++l) {
      if (!bodies_[k].parts.empty() || !bodies_[l].parts.empty()) continue;
      int pressing = 0;
      double force = 0.0;
      for (const Row& r : rows_)
        if (r.force > 0.0 && r.side_of(static_cast<int>(k)) >= 0 && r.side_of(static_cast<int>(l)) >= 0 &&
            (k != l || r.row.key.body == r.row.key.other)) {
          ++pressing;
          force += r.force;
        }
      if (pressing > 0 && pressing < few && force > considerable * all) return true;
    }
  return false;
}

/// Cholesky factor of W for the rows that press. A row whose pivot vanishes is restrained by the others.
PALPATE_INLINE void InterfaceProblem::factor_pressing() {
  constexpr double least_pivot = 1e-9;
  pressing_.clear();
  for (std::size_t r = 0; r < rows_.size(); ++r)
    if (rows_[r].force > 0.0) pressing_.push_back(r);
  const std::size_t n = pressing_.size();
  factor_.assign(n * n, 0.0);  // by rows
  const auto w = [&](std::size_t i, std::size_t j) {
    return problem_.w(static_cast<int>(pressing_[i]), static_cast<int>(pressing_[j]));
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const double *const a = factor_.data() + i * n, *const b = factor_.data() + j * n;
      double sum = w(i, j);
      for (std::size_t k = 0; k < j; ++k) sum -= a[k] * b[k];
      if (i == j)
        factor_[i * n + i] = sum > least_pivot * w(i, i) ? std::sqrt(sum) : 0.0;
      else
        factor_[i * n + j] = b[j] > 0.0 ? sum / b[j] : 0.0;
    }
}

PALPATE_INLINE void InterfaceProblem::follow(const VectorX& pushed) {
  const std::size_t n = pressing_.size();
  if (static_cast<std::size_t>(pushed.size()) != n) return;
  answer_.assign(pushed.begin(), pushed.end());
  for (std::size_t r = n; r-- > 0;) {
    const double* const l = factor_.data() + r * n;
    answer_[r] = l[r] > 0.0 ? answer_[r] / l[r] : 0.0;
    for (std::size_t s = 0; s < r; ++s) answer_[s] -= l[s] * answer_[r];
    Row& row = rows_[pressing_[r]];
    row.followed = std::max(0.0, row.force - answer_[r]);
  }
}

PALPATE_INLINE void InterfaceProblem::restraint(std::size_t k, std::vector<double>& z) {
  constexpr std::size_t together = 64;  // vertices
  const std::size_t n = pressing_.size(), vertices = bodies_[k].base.size();
  z.resize(3 * n * vertices);
  chunk_.resize(n * 3 * together);
  for (std::size_t first = 0; first < vertices && n > 0; first += together) {
    const std::size_t width = 3 * std::min(together, vertices - first);
    const auto chunk = [&](std::size_t r) {
      return InterfaceVector(chunk_.data() + r * width, static_cast<Eigen::Index>(width));
    };
    for (std::size_t r = 0; r < n; ++r) {
      InterfaceVector own = chunk(r);
      const Row& row = rows_[pressing_[r]];
      const int side = row.side_of(static_cast<int>(k));
      if (side < 0)
        own.setZero();
      else
        own = ConstInterfaceVector(row.response[at(side)].data() + 3 * first, static_cast<Eigen::Index>(width));
      const double* const l = factor_.data() + r * n;
      std::size_t s = 0;
      for (; s + 4 <= r; s += 4)
        own -= l[s] * chunk(s) + l[s + 1] * chunk(s + 1) + l[s + 2] * chunk(s + 2) + l[s + 3] * chunk(s + 3);
      for (; s < r; ++s) own -= l[s] * chunk(s);
      own *= l[r] > 0.0 ? 1.0 / l[r] : 0.0;
    }
    for (std::size_t i = 0; i < width; ++i)
      for (std::size_t r = 0; r < n; ++r) z[(3 * first + i) * n + r] = chunk_[r * width + i];
  }
}

}}}  // namespace palpate::detail
