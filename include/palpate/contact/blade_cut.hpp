// Cutting resistance of a blade.
#pragma once

#include <palpate/contact/tools.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Surfaces swept by an edge of fixed direction, as strips: each is a segment across the edge, and the range of the
/// middle of the edge along itself. The newest `most` are kept. Points have no component along the edge. Neither throws
/// nor allocates.
class BladeSlits {
 public:
  static constexpr int most = 256;
  struct Strip {
    Vector3 from, to;  ///< across the edge [m]
    double low, high;  ///< of the middle of the edge, along it [m]
  };
  /// A motion along a strip.
  struct Slide {
    int strip = -1;  ///< -1: none leads nearer
    Vector3 to;
    double fresh = 0.0;            ///< part of the edge outside what was cut, 0 to 1
    double low = 0.0, high = 0.0;  ///< of the strip with the edge [m]
  };

  void clear() noexcept { count_ = next_ = 0; }
  /// Adds a strip, or makes the newest one longer if it ends in `from` and is shorter than `length`.
  void add(const Vector3& from, const Vector3& to, double along, double length) noexcept;
  /// The nearest point of the strips that cover a part of an edge of `length` at `along`, if it is within `reach` of x.
  bool find_nearest(const Vector3& x, double along, double length, double reach, Vector3& nearest) const noexcept;
  /// The motion along a strip through x that leads nearest to the target, if the pull on a part of the edge outside
  /// what was cut must stretch the coupling by `stretch` times that part.
  Slide find_slide(const Vector3& x, const Vector3& target, double along, double length, double stretch) const noexcept;
  /// Notes that the edge has cut on a slide from a point.
  void widen(const Vector3& from, const Slide& slide, double length) noexcept;

 private:
  static constexpr double touching = 1e-9;  // [m]

  void append(const Strip& made, double length, double largest_bend) noexcept;
  static Vector3 closest(const Strip& strip, const Vector3& x) noexcept;
  /// Part of an edge outside a strip.
  static double fresh(const Strip& strip, double along, double length) noexcept;
  Strip& strip(int i) noexcept { return strips_[static_cast<std::size_t>(i)]; }
  const Strip& strip(int i) const noexcept { return strips_[static_cast<std::size_t>(i)]; }

  std::array<Strip, most> strips_;
  int count_ = 0, next_ = 0;
};

}  // namespace detail

/// The edge as a slider with a threshold: it stays in place until the coupling pulls across it with toughness times the
/// length of the edge in the tissue, in any direction, and then advances under exactly that force. The work done is
/// therefore toughness times the area cut, up to rounding, and no motion of the hand gains energy (Griffith's balance
/// for a sharp cut, as used for haptics by Mahvash and Hayward 2001). In slits that it has cut the edge slides without
/// resistance, and resists motion across them up to the same threshold; a part of the edge that is outside a slit cuts.
/// The flanks have no friction and do not push the tissue aside. World frame.
class BladeCut {
 public:
  /// Throws bad_argument for an invalid blade, or for a stiffness [N/m] of the coupling between hand and edge that is
  /// not finite and positive.
  BladeCut(const BladeTool& tool, double stiffness);

  /// Moves the edge with the hand at `hand` [m]; `width` is the length of the edge in tissue [m]. Returns the force on
  /// the hand [N].
  Vector3 advance(const Vector3& hand, double width) noexcept;
  /// The next advance starts at the position of the hand.
  void lift() noexcept { known_ = false; }
  /// Back to the state after construction.
  void reset() noexcept;

  const BladeTool& tool() const noexcept { return tool_; }
  /// Middle of the edge [m].
  const Vector3& edge() const noexcept { return edge_; }
  /// Where the last advance began to cut [m]: another position than that of the edge before it when the edge slid
  /// through a slit or left the tissue.
  const Vector3& cut_from() const noexcept { return cut_from_; }
  double area() const noexcept { return area_; }  ///< cut against resistance [m^2]
  double work() const noexcept { return work_; }  ///< work done by cutting [J]

 private:
  static constexpr int most_slides = 32;  // per advance

  void enter(double along) noexcept;
  bool slide(const Vector3& target, double along, double width) noexcept;

  BladeTool tool_;
  double stiffness_, length_;  // of the edge
  Vector3 direction_;          // of the edge
  Vector3 edge_ = Vector3::Zero(), cut_from_ = Vector3::Zero(), hand_ = Vector3::Zero();
  detail::BladeSlits slits_;
  Vector3 place_ = Vector3::Zero();  // of the edge in a slit, across it
  double slack_ = 0.0;               // distance from it that is free
  double area_ = 0.0, work_ = 0.0;
  bool known_ = false, inside_ = false;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/blade_cut.ipp>
#endif
