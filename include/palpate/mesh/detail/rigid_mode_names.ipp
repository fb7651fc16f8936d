// Definitions of rigid_mode_names.hpp.
#pragma once

#include <palpate/mesh/detail/rigid_mode_names.hpp>

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

}}}  // namespace palpate::detail
