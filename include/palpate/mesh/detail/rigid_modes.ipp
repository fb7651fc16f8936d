// Definitions of rigid_modes.hpp.
#pragma once

#include <palpate/core/detail/box.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/detail/rigid_modes.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Three numbers with three digits, or more if they are large compared with `scale`: a point far from zero is accurate
/// to a hundredth of `scale`. Rounding errors print as 0.
inline std::string short_triple(const Vector3& v, double scale) {
  std::string text = "(";
  for (int i = 0; i < 3; ++i) {
    std::array<char, 32> one{};
    const double ratio = std::abs(v[i]) / scale;
    const int digits = ratio > 1.0 ? 4 + static_cast<int>(std::min(std::log10(ratio), 12.0)) : 3;
    std::snprintf(one.data(), one.size(), "%.*g", digits, ratio < 1e-6 ? 0.0 : v[i]);
    text += (i > 0 ? ", " : "") + std::string(one.data());
  }
  return text + ')';
}

/// Reduced row echelon form in place; entries below 1e-7 are zero. Rows that span coordinate axes are reduced to these
/// axes.
inline void reduce_rows(RigidMotions& rows) {
  std::size_t top = 0;
  for (int column = 0; column < 6 && top < rows.size(); ++column) {
    std::size_t pivot = top;
    for (std::size_t r = top + 1; r < rows.size(); ++r)
      if (std::abs(rows[r][column]) > std::abs(rows[pivot][column])) pivot = r;
    if (std::abs(rows[pivot][column]) < 1e-7) continue;
    std::swap(rows[top], rows[pivot]);
    const Vector6 unit = rows[top] / rows[top][column];
    for (Vector6& row : rows) row = row - row[column] * unit;
    rows[top] = unit;
    ++top;
  }
}

inline std::string name_translation(const Vector3& t) {
  const Vector3 d = t.normalized();
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(d[axis]) > 1.0 - 1e-9) return std::string("translation ") + "xyz"[axis];
  return "translation along " + short_triple(d, 1.0);
}

/// Name of u = t + w x (x - centre) / size. It is a rotation if w and t are perpendicular, else a screw motion.
inline std::string name_rotation(const Vector3& w, const Vector3& t, const Vector3& centre, double size) {
  const double square = w.squaredNorm();
  const Vector3 through = centre + size * cross(w, t) / square;
  const bool screw = std::abs(w.dot(t)) > 1e-6 * square;
  return std::string(screw ? "screw" : "rotation") + " about the axis " + short_triple(w / std::sqrt(square), 1.0) +
         " through " + short_triple(through, size);
}

PALPATE_INLINE std::vector<std::string> name_rigid_motions(const RigidMotions& motions, const Vector3& centre,
                                                           double size) {
  RigidMotions rows = motions;
  reduce_rows(rows);
  std::vector<std::string> translations, rotations;
  Matrix3 slide = Matrix3::Zero();  // projector on the free translations, built from an orthonormal basis
  for (const Vector6& row : rows) {
    const Vector3 w = rotation_of(row), t = shift_of(row);
    if (w.norm() > 1e-7) continue;
    translations.push_back(name_translation(t));
    const Vector3 d = (t - slide * t).normalized();
    slide += d * d.transpose();
  }
  for (const Vector6& row : rows) {
    const Vector3 w = rotation_of(row);
    Vector3 t = shift_of(row);
    if (w.norm() <= 1e-7) continue;
    const Vector3 along = slide * w;  // with a free translation along the axis, a screw reduces to a rotation
    if (along.norm() > 1e-6 * w.norm()) t -= w.dot(t) / w.dot(along) * along;
    rotations.push_back(name_rotation(w, t, centre, size));
  }
  translations.insert(translations.end(), rotations.begin(), rotations.end());
  return translations;
}

PALPATE_INLINE std::vector<std::vector<NodeId>> nodes_by_component(std::span<const NodeId> component) {
  NodeId last = -1;
  for (NodeId c : component) last = std::max(last, c);
  std::vector<std::vector<NodeId>> nodes(static_cast<std::size_t>(last + 1));
  for (std::size_t i = 0; i < component.size(); ++i)
    if (component[i] >= 0) nodes[static_cast<std::size_t>(component[i])].push_back(static_cast<NodeId>(i));
  return nodes;
}

PALPATE_INLINE RigidFrame::RigidFrame(std::span<const Vector3> positions, std::span<const NodeId> nodes,
                                      std::span<const std::uint8_t> constrained) {
  const auto at = [&](NodeId node) -> const Vector3& { return positions[static_cast<std::size_t>(node)]; };
  const Vector3 origin = at(nodes.front());  // offsets do not lose digits far from zero
  Box box;
  Vector3 all = Vector3::Zero(), supported = Vector3::Zero();
  Index supported_count = 0;
  double farthest = 0.0;
  for (NodeId node : nodes) {
    const Vector3 x = at(node) - origin;
    box.include(x);
    all += x;
    farthest = std::max(farthest, max_abs(at(node)));
    if ((constrained[static_cast<std::size_t>(node)] & 7u) == 0) continue;
    supported += x;
    ++supported_count;
  }
  centre = origin + (supported_count > 0 ? Vector3(supported / static_cast<double>(supported_count))
                                         : Vector3(all / static_cast<double>(nodes.size())));
  const double diagonal = box.size().norm();
  if (diagonal > 0.0) size = diagonal;
  resolution = 8.0 * std::numeric_limits<double>::epsilon() * farthest / size;
}

PALPATE_INLINE Vector6 constraint_row(const Vector3& p, int axis) {
  const int next = (axis + 1) % 3, last = (axis + 2) % 3;
  Vector6 row = Vector6::Zero();
  row[next] = p[last];  // p x e
  row[last] = -p[next];
  row[3 + axis] = 1.0;
  return row;
}

inline double dot(const Vector6& a, const Vector6& b) noexcept {
  double sum = 0.0;
  for (int i = 0; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}

inline Vector6 normalized(const Vector6& v) noexcept {
  return v / std::sqrt(dot(v, v));
}

PALPATE_INLINE Vector6 remainder(const std::vector<Vector6>& basis, Vector6 v) {
  for (int twice = 0; twice < 2; ++twice) {
    const Vector6 whole = v;
    for (const Vector6& b : basis) v = v - dot(b, whole) * b;
  }
  return v;
}

PALPATE_INLINE RigidMotions free_motions(std::span<const Vector3> positions, std::span<const NodeId> nodes,
                                         std::span<const std::uint8_t> constrained, const RigidFrame& frame) {
  const double tolerance = std::max(1e-6, frame.resolution);
  std::vector<Vector6> basis;
  while (basis.size() < 6) {
    Vector6 best = Vector6::Zero();
    for (NodeId node : nodes) {
      const Vector3 p = (positions[static_cast<std::size_t>(node)] - frame.centre) / frame.size;
      for (int axis = 0; axis < 3; ++axis) {
        if ((constrained[static_cast<std::size_t>(node)] >> axis & 1u) == 0) continue;
        const Vector6 rest = remainder(basis, constraint_row(p, axis));
        if (dot(rest, rest) > dot(best, best)) best = rest;
      }
    }
    if (!(std::sqrt(dot(best, best)) > tolerance)) break;
    basis.push_back(normalized(best));
  }
  const auto seen = static_cast<std::ptrdiff_t>(basis.size());
  while (basis.size() < 6) {  // complete the basis with the remainders of the unit vectors
    Vector6 best = Vector6::Zero();
    for (int i = 0; i < 6; ++i) {
      Vector6 unit = Vector6::Zero();
      unit[i] = 1.0;
      const Vector6 rest = remainder(basis, unit);
      if (dot(rest, rest) > dot(best, best)) best = rest;
    }
    basis.push_back(normalized(best));
  }
  return {basis.begin() + seen, basis.end()};
}

PALPATE_INLINE std::vector<FreeRigidModes> free_rigid_modes(std::span<const Vector3> positions,
                                                            std::span<const NodeId> component,
                                                            std::span<const std::uint8_t> constrained,
                                                            const Vector3& origin) {
  if (component.size() != positions.size() || constrained.size() != positions.size())
    raise(SetupErrorKind::bad_argument, "positions, components and constraints have different lengths",
          "Give one of each per node");
  std::vector<FreeRigidModes> result;
  for (const std::vector<NodeId>& nodes : nodes_by_component(component)) {
    FreeRigidModes modes{static_cast<Index>(result.size()), static_cast<Index>(nodes.size()), {}, {}};
    if (!nodes.empty()) {
      modes.first_nodes.assign(
          nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(std::min(nodes.size(), SetupProblem::max_ids)));
      const RigidFrame frame(positions, nodes, constrained);
      modes.modes =
          name_rigid_motions(free_motions(positions, nodes, constrained, frame), origin + frame.centre, frame.size);
    }
    result.push_back(std::move(modes));
  }
  return result;
}

PALPATE_INLINE void require_constrained(std::span<const Vector3> positions, std::span<const NodeId> component,
                                        std::span<const std::uint8_t> constrained, const Vector3& origin) {
  const std::vector<FreeRigidModes> all = free_rigid_modes(positions, component, constrained, origin);
  std::size_t free = 0, first_free = all.size();
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].count() > 0) ++free, first_free = std::min(first_free, i);
  if (free == 0) return;
  const FreeRigidModes& first = all[first_free];
  SetupProblem p;
  p.kind = SetupErrorKind::unconstrained;
  p.what = "component " + std::to_string(first.component) + " of " + std::to_string(all.size()) + " has " +
           std::to_string(first.count()) + (first.count() == 1 ? " free rigid motion:" : " free rigid motions:");
  for (std::size_t i = 0; i < first.modes.size(); ++i) p.what += (i == 0 ? " " : ", ") + first.modes[i];
  if (free > 1)
    p.what += "; " + std::to_string(free - 1) + " more " + (free == 2 ? "component" : "components") + " can move";
  p.hint = "Prescribe more components of the displacement; a static body needs six independent ones";
  p.ids.assign(first.first_nodes.begin(), first.first_nodes.end());
  p.ids_of = SetupIds::nodes;
  p.count = first.node_count;
  p.value = first.count();
  raise(std::move(p));
}

}}}  // namespace palpate::detail
