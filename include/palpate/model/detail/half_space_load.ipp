// Definitions of half_space_load.hpp.
#pragma once

#include <palpate/model/detail/half_space_load.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE HalfSpaceLoad::HalfSpaceLoad(const HalfSpaceSource& source) : source_(source) {}

PALPATE_INLINE bool HalfSpaceLoad::is_flat(const BoundaryFace& face) const noexcept {
  return std::all_of(face.nodes.begin(), face.nodes.end(),
                     [&](NodeId n) { return std::abs((source_.position(n) - middle_).dot(normal_)) <= tolerance_; });
}

/// Calls add(point, traction times area) for every point of a face.
template <class Nodes, class Add>
void HalfSpaceLoad::for_each_traction(const Nodes& nodes, const FaceRule& rule, Add&& add) const {
  for (const FacePoint& point : rule) {
    Vector3 x = Vector3::Zero(), u = x, v = x;
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const Vector3 p = source_.position(nodes[a]) - middle_;
      x += point.shape[a] * p;
      u += point.along_u[a] * p;
      v += point.along_v[a] * p;
    }
    add(point, field_->traction(x, point.weight * cross(u, v)));
  }
}

PALPATE_INLINE void HalfSpaceLoad::add_boundary_face(const BoundaryFace& face) {
  if (is_flat(face)) return;
  const FaceRules& rules = source_.rules.of(face.nodes.size());
  const auto own =
      static_cast<std::size_t>(std::find(face.nodes.begin(), face.nodes.end(), patch_->middle()) - face.nodes.begin());
  const bool has_middle = own < face.nodes.size();
  for_each_traction(face.nodes, has_middle ? rules.singular_at[own] : rules.smooth,
                    [&](const FacePoint& point, const Matrix3& f) {
                      for (std::size_t a = 0; a < face.nodes.size(); ++a) {
                        const int place = patch_->place(face.nodes[a]);
                        if (place < 0) continue;
                        const double share = a == own ? point.shape[a] - 1.0 : point.shape[a];
                        load_->block<3, 3>(3 * place, 0) += share * f;
                      }
                    });
}

PALPATE_INLINE void HalfSpaceLoad::add_own_load() {
  const ElementLayout& element = source_.mesh.element;
  auto load = load_->block<3, 3>(3 * patch_->place(patch_->middle()), 0);
  for (const NodeId e : source_.around.of(patch_->middle()))
    for (int f = 0; f < element.face_count; ++f) {
      ShortIds<static_cast<std::size_t>(max_face_nodes)> nodes(element.local_face(f).size());
      for (std::size_t a = 0; a < nodes.size(); ++a) nodes[a] = source_.mesh.nodes_of(e)[element.local_face(f)[a]];
      if (std::find(nodes.begin(), nodes.end(), patch_->middle()) != nodes.end()) continue;
      for_each_traction(nodes, source_.rules.of(nodes.size()).near,
                        [&](const FacePoint&, const Matrix3& traction) { load -= traction; });
    }
}

PALPATE_INLINE void HalfSpaceLoad::compute(const NodePatch& patch, const HalfSpaceField& field, const Vector3& normal,
                                           MatrixX& load) {
  constexpr double flat = 1e-9;
  patch_ = &patch;
  field_ = &field;
  load_ = &load;
  middle_ = source_.position(patch.middle());
  normal_ = normal;
  tolerance_ = flat * source_.boundary.length(patch.middle());
  ++number_;
  load.setZero(3 * static_cast<Index>(patch.free().size()), 3);
  const auto own_faces = source_.boundary.faces_at(patch.middle());
  if (std::ranges::all_of(own_faces, [&](int f) { return is_flat(source_.boundary.face(f)); }))
    load.block<3, 3>(3 * patch.place(patch.middle()), 0).setIdentity();
  else
    add_own_load();
  for (const NodeId n : patch.free())
    for (const int f : source_.boundary.faces_at(n)) {
      if (static_cast<std::size_t>(f) >= face_seen_.size()) face_seen_.resize(static_cast<std::size_t>(f) + 1, 0);
      if (std::exchange(face_seen_[static_cast<std::size_t>(f)], number_) != number_)
        add_boundary_face(source_.boundary.face(f));
    }
}

}}  // namespace palpate
