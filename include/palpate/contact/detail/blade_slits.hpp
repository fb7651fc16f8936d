// The surfaces that a blade has cut.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

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

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/blade_slits.ipp>
#endif
