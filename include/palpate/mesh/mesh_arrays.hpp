// A mesh view of arrays owned by the caller.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh.hpp>

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// An argument that a view may refer to: an lvalue, or a range that does not own its elements.
template <class Range>
concept Outlives = std::is_lvalue_reference_v<Range> || std::ranges::borrowed_range<std::remove_cvref_t<Range>>;

/// A view of a simulator's arrays as a mesh, without a copy: `positions` contains x y z per node, `connectivity`
/// E::nodes ids per element (zero based), `regions` one number per element or nothing. Groups are added with `group()`.
/// The arrays must outlive the view; temporaries are rejected at compile time. Any floating-point and any integral type
/// is allowed.
template <Element E, std::floating_point Real, std::integral Integer>
class MeshArrays {
 public:
  static constexpr int nodes_per_element = E::nodes;

  /// Any contiguous ranges that outlive the view: lvalues, or spans of them. Throws bad_argument if a length is not a
  /// multiple of 3 or E::nodes, or `regions` has the wrong length; index_out_of_range for a region number that is
  /// negative or larger than the number of elements.
  template <class Positions, class Connectivity, class Regions = std::span<const int>>
  requires(Outlives<Positions>&& Outlives<Connectivity>&& Outlives<Regions>)
      MeshArrays(Positions&& positions, Connectivity&& connectivity, Regions&& regions = {})
      : positions_(positions), connectivity_(connectivity), regions_(regions) {
    require_complete();
  }
  template <class Positions, class Connectivity, class Regions = std::span<const int>>
  requires(!(Outlives<Positions> && Outlives<Connectivity> && Outlives<Regions>))
      MeshArrays(Positions&&, Connectivity&&, Regions&& = {})
  = delete;  // a view of a temporary would dangle

  /// Adds or extends a named group of nodes.
  MeshArrays& group(std::string_view name, std::span<const NodeId> nodes) {
    Group& g = groups_.get_or_add(name, 0);
    g.nodes.insert(g.nodes.end(), nodes.begin(), nodes.end());
    groups_.tidy();
    return *this;
  }
  /// Direction of the fibres in every element, x y z each: any contiguous range that outlives the view. Throws
  /// bad_argument if its length is wrong.
  template <class Fibres>
  requires(Outlives<Fibres>) MeshArrays& fibres(Fibres&& directions) {
    const std::span<const Real> given(directions);
    if (static_cast<Index>(given.size()) != 3 * element_count())
      raise(SetupErrorKind::bad_argument, "fibres holds " + std::to_string(given.size()) + " numbers",
            "It needs x y z per element: " + std::to_string(3 * element_count()));
    fibres_ = given;
    return *this;
  }
  template <class Fibres>
  requires(!Outlives<Fibres>) MeshArrays& fibres(Fibres&&) = delete;  // a view of a temporary would dangle

  MeshArrays& name_region(int region, std::string name) {
    region_names_.at(static_cast<std::size_t>(region)) = std::move(name);
    return *this;
  }

  Index node_count() const noexcept { return static_cast<Index>(positions_.size() / 3); }
  Index element_count() const noexcept { return static_cast<Index>(connectivity_.size()) / E::nodes; }
  Vector3 position(Index i) const noexcept {
    const auto* p = positions_.data() + 3 * i;
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
  }
  Index element_node(Index e, int a) const noexcept {
    return static_cast<Index>(connectivity_[static_cast<std::size_t>(e * E::nodes + a)]);
  }
  int region(Index e) const noexcept { return regions_.empty() ? 0 : regions_[static_cast<std::size_t>(e)]; }
  bool has_fibres() const noexcept { return !fibres_.empty(); }
  Vector3 fibre(Index e) const noexcept {
    const auto* f = fibres_.data() + 3 * e;
    return {static_cast<double>(f[0]), static_cast<double>(f[1]), static_cast<double>(f[2])};
  }
  int region_count() const noexcept { return static_cast<int>(region_names_.size()); }
  const std::string& region_name(int r) const noexcept { return region_names_[static_cast<std::size_t>(r)]; }
  const Group* find_group(std::string_view name) const noexcept { return groups_.find(name); }

 private:
  void require_complete() {
    if (positions_.size() % 3 != 0)
      raise(SetupErrorKind::bad_argument, "positions holds " + std::to_string(positions_.size()) + " numbers",
            "It needs x y z per node");
    if (connectivity_.size() % static_cast<std::size_t>(E::nodes) != 0)
      raise(SetupErrorKind::bad_argument, "connectivity holds " + std::to_string(connectivity_.size()) + " ids",
            "It needs " + std::to_string(E::nodes) + " per element");
    if (!regions_.empty() && static_cast<Index>(regions_.size()) != element_count())
      raise(SetupErrorKind::bad_argument, "regions holds " + std::to_string(regions_.size()) + " numbers",
            "It needs one per element: " + std::to_string(element_count()));
    Index count = 1;
    for (int r : regions_) {
      if (r < 0 || r > element_count())
        raise(SetupErrorKind::index_out_of_range, "an element is in region " + std::to_string(r),
              "Number regions from zero");
      count = std::max(count, Index{r} + 1);
    }
    for (Index r = 0; r < count; ++r) region_names_.push_back(count == 1 ? "body" : "region " + std::to_string(r));
  }

  std::span<const Real> positions_, fibres_;
  std::span<const Integer> connectivity_;
  std::span<const int> regions_;
  std::vector<std::string> region_names_;
  GroupTable groups_;
};

}}  // namespace palpate
