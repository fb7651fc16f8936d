// Definitions of tissue_group.hpp.
#pragma once

#include <palpate/contact/subfacet_compliance.hpp>
#include <palpate/contact/tissue_group.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(TissueModel<TissueGroup>);

PALPATE_INLINE void TissueGroup::add(const TissueView& tissue) {
  const ContactSurface& surface = tissue.contact_surface();
  const int first = members_.empty() ? 0 : members_.back().first + members_.back().count;
  if (members_.empty()) world_ = tissue.to_world();
  Member& m = members_.emplace_back(Member{tissue, first, surface.vertex_count(), {}, true});
  place(m);
  for (const Vector3& x : surface.positions()) moved_.push_back(m.placed(x));
  for (const Triangle& t : surface.triangles()) triangles_.push_back({t[0] + first, t[1] + first, t[2] + first});
  floor_ = std::min(floor_, tissue.compliance_floor());  // so that it is tiny compared with the stiffest member, too
}

PALPATE_INLINE void TissueGroup::place(Member& m) const noexcept {
  const Eigen::Isometry3d& pose = m.tissue.to_world();
  m.in_place = std::equal(pose.data(), pose.data() + 16, world_.data());
  m.place = m.in_place ? Eigen::Isometry3d::Identity() : inverse(world_) * pose;
}
PALPATE_INLINE Vector3 TissueGroup::Member::placed(const Vector3& x) const noexcept {
  return in_place ? x : Vector3(place * x);
}

PALPATE_INLINE void TissueGroup::build() {
  if (members_.empty()) raise(SetupErrorKind::bad_argument, "a TissueGroup has no members");
  // That of a single member is copied: its contact points are those of the surface at the member's set-up, which loads
  // or a pose may have moved since.
  if (members_.size() == 1) {
    surface_ = members_.front().tissue.contact_surface();
  } else {
    surface_ = ContactSurface(moved_, std::move(triangles_));
    surface_.set_unloaded(unloaded());
  }
  surface_.set_materials(materials());
  surface_.set_subfacet(joined_subfacet());
  join_errors();
  own_.resize(moved_.size());
  add_shells();
}

/// The members' shells, with vertices numbered after those of all members.
PALPATE_INLINE void TissueGroup::add_shells() {
  const auto vertices = moved_.size();
  std::vector<Triangle> shell;
  for (const Member& m : members_) {
    const ContactSurface& own = m.tissue.contact_surface();
    const int after = static_cast<int>(moved_.size()) - m.count;
    for (Triangle t : own.shell()) {
      for (int& v : t) v += v < m.count ? m.first : after;
      shell.push_back(t);
    }
    for (const Vector3& x : own.shell_positions()) moved_.push_back(m.placed(x));
  }
  if (members_.size() > 1) surface_.add_shell(std::span(moved_).subspan(vertices), shell);
}

PALPATE_INLINE ContactSurface::Unloaded TissueGroup::unloaded() const {
  ContactSurface::Unloaded all;
  for (const Member& m : members_) {
    const ContactSurface::Unloaded& own = m.tissue.contact_surface().unloaded();
    if (static_cast<int>(own.positions.size()) != m.count) return {};
    for (const Vector3& x : own.positions) all.positions.push_back(m.placed(x));
    all.loads += (all.loads.empty() ? "" : "; ") + own.loads;
  }
  return all;
}

PALPATE_INLINE std::vector<ContactMaterial> TissueGroup::materials() const {
  std::vector<ContactMaterial> materials;
  for (const Member& m : members_) {
    const ContactSurface& own = m.tissue.contact_surface();
    for (int t = 0; t < static_cast<int>(own.triangles().size()); ++t)
      materials.push_back(m.tissue.has_contact_materials() ? own.material(t) : ContactMaterial{});
  }
  return materials;
}

/// Each body in its own frame; unknown for a member whose compliance is not that of its surface.
PALPATE_INLINE std::shared_ptr<const SubfacetCompliance> TissueGroup::joined_subfacet() const {
  std::vector<SubfacetCompliance::Body> bodies;
  for (const Member& m : members_)
    bodies.push_back(
        {m.tissue.has_contact_materials() ? m.tissue.contact_surface().subfacet().get() : nullptr, m.count});
  if (bodies.size() == 1 && bodies.front().own != nullptr) return members_.front().tissue.contact_surface().subfacet();
  if (std::none_of(bodies.begin(), bodies.end(), [](const auto& b) { return b.own != nullptr; })) return nullptr;
  return std::make_shared<SubfacetCompliance>(bodies);
}

/// Nothing is known of a member whose compliance is not that of its surface. Allocates in the first call only.
PALPATE_INLINE void TissueGroup::join_errors() {
  errors_.clear();
  for (const Member& m : members_) {
    const ContactSurface& own = m.tissue.contact_surface();
    for (int b = 0; b < own.body_count(); ++b) {
      KnownErrors body = own.known_errors(b);
      if (!m.tissue.has_contact_materials()) body = {body.first, body.end};
      body.first += m.first;
      body.end += m.first;
      errors_.push_back(body);
    }
  }
  surface_.set_known_errors(errors_);
}

PALPATE_INLINE void TissueGroup::update() noexcept {
  if (members_.size() == 1) world_ = members_.front().tissue.to_world();
  auto shell = static_cast<std::size_t>(surface_.vertex_count());
  for (Member& m : members_) {
    m.tissue.look();
    place(m);
    for (int v = 0; v < m.count; ++v) moved_[at(m.first + v)] = m.placed(m.tissue.contact_surface().position(v));
    for (const Vector3& x : m.tissue.contact_surface().shell_positions()) moved_[shell++] = m.placed(x);
  }
  surface_.move_to(moved_);
  join_errors();
  if (members_.size() > 1) ++updates_;  // the compliance of one member alone stays that of the member
}

PALPATE_INLINE std::size_t TissueGroup::forces_on(int member, std::span<const VertexForce> forces,
                                                  std::span<VertexForce> own) const noexcept {
  const Member& m = members_[at(member)];
  std::size_t count = 0;
  for (const VertexForce& f : forces)
    if (m.has(f.vertex) && count < own.size())
      own[count++] = {f.vertex - m.first,
                      m.in_place ? f.force : ModelVector::from_world(f.force.in_model_axes(), m.place)};
  return count;
}

PALPATE_INLINE std::vector<std::string> TissueGroup::notes() const {
  std::vector<std::string> all;
  for (const Member& m : members_)
    for (std::string& note : m.tissue.notes()) all.push_back(std::move(note));
  return all;
}
PALPATE_INLINE bool TissueGroup::refuses_suspicious_units() const noexcept {
  return std::any_of(members_.begin(), members_.end(),
                     [](const Member& m) { return m.tissue.refuses_suspicious_units(); });
}

PALPATE_INLINE Status TissueGroup::require_columns(std::span<const int> vertices) noexcept {
  Status status;
  for (const Member& m : members_) {
    const std::span<const int> own = part_of(m, vertices);
    if (vertices.empty() || !own.empty()) status |= m.tissue.require_columns(own);
  }
  return status;
}
PALPATE_INLINE void TissueGroup::prefetch(std::span<const int> vertices) noexcept {
  for (const Member& m : members_)
    if (const std::span<const int> own = part_of(m, vertices); !own.empty()) m.tissue.prefetch(own);
}
PALPATE_INLINE Matrix3 TissueGroup::compliance(int i, int j) const noexcept {
  const Member& m = member_of(j);
  if (!m.has(i)) return Matrix3::Zero();
  if (m.in_place) return m.tissue.compliance(i - m.first, j - m.first);
  const Matrix3 turn = rotation_of(m.place);
  return turn * m.tissue.compliance(i - m.first, j - m.first) * turn.transpose();
}
/// As the member sums it where the forces are in its own numbers and frame.
PALPATE_INLINE Vector3 TissueGroup::displacement_of(int i, std::span<const VertexForce> forces) const noexcept {
  const Member& m = member_of(i);
  const auto is_own = [&m](const VertexForce& f) { return m.has(f.vertex); };
  Vector3 u = Vector3::Zero();
  if (m.in_place && m.first == 0 && std::all_of(forces.begin(), forces.end(), is_own)) {
    m.tissue.displacement(i, forces, u);
    return u;
  }
  for (const VertexForce& f : forces)
    if (is_own(f)) u.noalias() += compliance(i, f.vertex) * f.force.in_model_axes();
  return u;
}
PALPATE_INLINE Matrix3 TissueGroup::half_space_map(int v) const noexcept {
  const Member& m = member_of(v);
  const Matrix3 own = m.tissue.half_space_map(v - m.first);
  return m.in_place ? own : Matrix3(rotation_of(m.place) * own);
}
PALPATE_INLINE double TissueGroup::compliance_bound(int j) const noexcept {
  const Member& m = member_of(j);
  return m.tissue.compliance_bound(j - m.first);
}
PALPATE_INLINE std::uint64_t TissueGroup::compliance_revision() const noexcept {
  std::uint64_t revision = updates_;  // counts poses; hashed with the members' revisions so that changes do not cancel
  for (const Member& m : members_) revision = revision * 0x9e3779b97f4a7c15u + m.tissue.compliance_revision();
  return revision;
}

PALPATE_INLINE const TissueGroup::Member& TissueGroup::member_of(int vertex) const noexcept {
  std::size_t k = 0;
  while (!members_[k].has(vertex)) ++k;
  return members_[k];
}
/// Those of the vertices that belong to the member, in its own numbers.
PALPATE_INLINE std::span<const int> TissueGroup::part_of(const Member& m, std::span<const int> vertices) noexcept {
  std::size_t count = 0;
  for (const int v : vertices)
    if (m.has(v) && count < own_.size()) own_[count++] = v - m.first;
  return {own_.data(), count};
}

}}  // namespace palpate
