// Several tissues in one scene, touched by the same tools.
#pragma once

#include <palpate/concepts/tissue_model.hpp>
#include <palpate/contact/contact_surface.hpp>
#include <palpate/core/setup_error.hpp>

#include <limits>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

/// Tissues of any types that do not move by themselves as one TissueModel in the world's frame: a ball that touches two
/// organs is one contact problem, with one force and one gate. Vertices are those of the members one after the other.
/// Refers to the members, which must outlive it; the organs do not touch each other.
class TissueGroup {
 public:
  /// Throws bad_argument when there is none. Allocates.
  template <TissueModel... T>
  requires(sizeof...(T) > 0) explicit TissueGroup(T&... members) { (add(members), ...), build(); }
  /// The same for a number of members known at run time.
  template <TissueModel T>
  explicit TissueGroup(std::span<T* const> members) {
    if (members.empty()) raise(SetupErrorKind::bad_argument, "a group of no tissues");
    for (T* member : members) add(*member);
    build();
  }

  /// Takes over loads and poses that members were given since. No allocation; not while a tick runs.
  void update() noexcept {
    for (const Member& m : members_)
      for (int v = 0; v < m.count; ++v) moved_[at(m.first + v)] = *m.pose * m.positions[v];
    surface_.move_to(moved_);
    ++updates_;
  }

  int member_count() const noexcept { return static_cast<int>(members_.size()); }
  /// Those of the group's forces that act on one member, in its own numbers and frame, as `displacement_with` wants
  /// them. Writes as many as fit and returns how many. No allocation.
  std::size_t forces_on(int member, std::span<const VertexForce> forces, std::span<VertexForce> own) const noexcept {
    const Member& m = members_[at(member)];
    std::size_t count = 0;
    for (const VertexForce& f : forces)
      if (m.has(f.vertex) && count < own.size())
        own[count++] = {f.vertex - m.first, m.pose->linear().transpose() * f.force};
    return count;
  }

  // TissueModel
  const ContactSurface& contact_surface() const noexcept { return surface_; }
  Status require_columns(std::span<const int> vertices) noexcept {
    Status status;
    for_each_part(vertices, [&](const Member& m, std::span<const int> own) { status |= m.require(m.model, own); });
    return status;
  }
  void foresee(std::span<const int> vertices) noexcept {
    for_each_part(vertices, [](const Member& m, std::span<const int> own) { m.foresee(m.model, own); });
  }
  Matrix3 compliance(int i, int j) const noexcept {
    const Member& m = member_of(j);
    if (!m.has(i)) return Matrix3::Zero();
    const auto& turn = m.pose->linear();
    return turn * m.compliance(m.model, i - m.first, j - m.first) * turn.transpose();
  }
  double compliance_bound(int j) const noexcept {
    const Member& m = member_of(j);
    return m.bound(m.model, j - m.first);
  }
  std::uint64_t compliance_revision() const noexcept {
    std::uint64_t revision = updates_;  // of poses; numbers of members are spread, so that changes do not cancel
    for (const Member& m : members_) revision = revision * 0x9e3779b97f4a7c15u + m.revision(m.model);
    return revision;
  }
  double compliance_floor() const noexcept { return floor_; }
  const Eigen::Isometry3d& pose() const noexcept { return world_; }

 private:
  struct Member {
    void* model;
    int first, count;  // vertices in the group
    const Vector3* positions;
    const Eigen::Isometry3d* pose;
    Status (*require)(void*, std::span<const int>) noexcept;
    void (*foresee)(void*, std::span<const int>) noexcept;
    Matrix3 (*compliance)(const void*, int, int) noexcept;
    double (*bound)(const void*, int) noexcept;
    std::uint64_t (*revision)(const void*) noexcept;

    bool has(int vertex) const noexcept { return vertex >= first && vertex < first + count; }
  };

  template <class T>
  void add(T& tissue) {
    static_assert(
        !AnnouncesChanges<T>,
        "palpate: a tissue that moves by itself cannot be in a TissueGroup; give it a HapticServo of its own");
    const ContactSurface& surface = tissue.contact_surface();
    const int first = members_.empty() ? 0 : members_.back().first + members_.back().count;
    Member m{&tissue, first, surface.vertex_count(), surface.positions().data(), &tissue.pose(), {}, {}, {}, {}, {}};
    m.require = [](void* t, std::span<const int> v) noexcept { return static_cast<T*>(t)->require_columns(v); };
    m.foresee = [](void* t, std::span<const int> v) noexcept {
      if constexpr (requires(T & model) { model.foresee(v); }) static_cast<T*>(t)->foresee(v);
    };
    m.compliance = [](const void* t, int i, int j) noexcept -> Matrix3 {
      return static_cast<const T*>(t)->compliance(i, j);
    };
    m.bound = [](const void* t, int j) noexcept -> double { return static_cast<const T*>(t)->compliance_bound(j); };
    m.revision = [](const void* t) noexcept -> std::uint64_t {
      return static_cast<const T*>(t)->compliance_revision();
    };
    members_.push_back(m);
    for (const Vector3& x : surface.positions()) moved_.push_back(tissue.pose() * x);
    for (const Triangle& t : surface.triangles()) triangles_.push_back({t[0] + first, t[1] + first, t[2] + first});
    floor_ = std::min(floor_, tissue.compliance_floor());  // tiny beside the hardest of them, too
  }
  void build() {
    surface_ = ContactSurface(moved_, std::move(triangles_));
    own_.resize(moved_.size());
  }

  const Member& member_of(int vertex) const noexcept {
    std::size_t k = 0;
    while (!members_[k].has(vertex)) ++k;
    return members_[k];
  }
  template <class Visit>
  void for_each_part(std::span<const int> vertices, Visit&& visit) noexcept {
    for (const Member& m : members_) {
      std::size_t count = 0;
      for (const int v : vertices)
        if (m.has(v) && count < own_.size()) own_[count++] = v - m.first;
      if (count > 0) visit(m, std::span<const int>(own_.data(), count));
    }
  }
  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

  std::vector<Member> members_;
  std::vector<Vector3> moved_;
  std::vector<Triangle> triangles_;
  std::vector<int> own_;  // workspace
  ContactSurface surface_;
  double floor_ = infinity;
  std::uint64_t updates_ = 0;
  Eigen::Isometry3d world_ = Eigen::Isometry3d::Identity();
};

static_assert(TissueModel<TissueGroup>);

}}  // namespace palpate
