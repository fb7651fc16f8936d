// The data for the script of the page, compressed: displacement in 16 bits, stress in 8.
#pragma once

#include "pictures.hpp"

#include <bit>

namespace touch {

/// Bytes in the order of little-endian machines, as base64.
class Packed {
 public:
  template <class T>
  void add(T value) {
    static_assert(sizeof(T) == 1 || sizeof(T) == 2 || sizeof(T) == 4);
    std::uint32_t bits = 0;
    if constexpr (std::same_as<T, float>)
      bits = std::bit_cast<std::uint32_t>(value);
    else
      bits = static_cast<std::uint32_t>(value);
    for (std::size_t i = 0; i < sizeof(T); ++i) bytes_ += static_cast<char>(bits >> (8 * i) & 0xffu);
  }
  void add(const Vector3& v) {
    for (const double x : v) add(static_cast<float>(x));
  }
  void add(std::string_view bytes) { bytes_ += bytes; }
  std::string json() const { return '"' + base64() + '"'; }
  std::string base64() const {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes_.size(); i += 3) {
      std::uint32_t three = 0;
      for (std::size_t k = 0; k < 3; ++k)
        three = three << 8 | (i + k < bytes_.size() ? static_cast<unsigned char>(bytes_[i + k]) : 0u);
      for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes_.size() ? '=' : digits[three >> (18 - 6 * k) & 63u];
    }
    return out;
  }

 private:
  std::string bytes_;
};

/// The drawn geometry: the surface and the lesion inside, with separate vertices.
class PageData {
 public:
  PageData(const Organ& organ, const std::vector<Picture>& pictures)
      : organ_(organ),
        lesion_(region_surface(organ, "lesion")),
        vertex_of_(static_cast<std::size_t>(organ.mesh().node_count()), -1) {
    for (const NodeId node : organ.rendered_nodes()) include(node);
    surface_vertices_ = nodes_.size();
    for (const auto& face : lesion_)
      for (const NodeId node : face) include(node);
    // Base64 needs 4 bytes for 3; the pictures take at most 4 MB.
    const std::size_t most = std::max<std::size_t>(1, 4'000'000 / (7 * nodes_.size()));
    const std::size_t step = (pictures.size() + most - 1) / most;
    for (std::size_t i = 0; i < pictures.size(); i += step) pictures_.push_back(&pictures[i]);
  }

  /// The range of the colours [Pa], the same for all pictures. It ends at half the largest stress of the surface, which
  /// only a few nodes near the sphere exceed; with the full range the rest would have almost one colour.
  ColourScale scale() const {
    double highest = 2.0;
    for (const Picture* p : pictures_) highest = std::max(highest, surface_stress(*p));
    return {0.0, round_up(0.5 * highest)};
  }

  std::string json(const Vector3& outward, const Vector3& size, double metres_per_newton) const {
    Vector3 low = organ_.rest_position(0), high = low;
    for (const NodeId node : nodes_) {
      low = low.cwiseMin(organ_.rest_position(node));
      high = high.cwiseMax(organ_.rest_position(node));
    }
    const Vector3 middle = 0.5 * (low + high);
    const auto list = [](const Vector3& v) { return text("[%.6g,%.6g,%.6g]", v[0], v[1], v[2]); };
    std::string out =
        "{\"outward\":" + list(outward) + ",\"centre\":" + list(middle) + text(",\"size\":%.6g", size.maxCoeff());
    out += text(",\"radius\":%g,\"most\":%g,\"metresPerNewton\":%.6g", tool.radius, scale().high(), metres_per_newton);
    out += text(",\"start\":%d", static_cast<int>(strongest())) + ",\"rest\":" + rest() + pictures_json();
    out += ",\"faces\":" + faces(surface_faces()) + ",\"lesion\":" + faces(lesion_) + ",\"palette\":" + colours();
    return out + '}';
  }
  std::size_t frames() const { return pictures_.size(); }

 private:
  void include(NodeId node) {
    int& vertex = vertex_of_[static_cast<std::size_t>(node)];
    if (vertex >= 0) return;
    vertex = static_cast<int>(nodes_.size());
    nodes_.push_back(node);
  }
  double surface_stress(const Picture& p) const {
    double most = 0.0;
    for (std::size_t v = 0; v < surface_vertices_; ++v) most = std::max(most, p.von_mises[nodes_[v]]);
    return most;
  }
  std::size_t strongest() const {
    const auto it = std::ranges::max_element(pictures_, {}, [](const Picture* p) { return p->force.norm(); });
    return static_cast<std::size_t>(it - pictures_.begin());
  }

  std::string rest() const {
    Packed packed;
    for (const NodeId node : nodes_) packed.add(Vector3(organ_.rest_position(node)));
    return packed.json();
  }
  std::string pictures_json() const {
    double longest = 1e-9;
    for (const Picture* p : pictures_) longest = std::max(longest, p->displacement.cwiseAbs().maxCoeff());
    const double step = longest / 32767.0;
    const ColourScale colours = scale();
    Packed moved, stress, track;
    for (const Picture* p : pictures_) {
      for (const NodeId node : nodes_) {
        for (int c = 0; c < 3; ++c)
          moved.add(static_cast<std::int16_t>(std::lround(p->displacement[3 * Index{node} + c] / step)));
        stress.add(static_cast<std::uint8_t>(std::lround(255.0 * colours.fraction(p->von_mises[node]))));
      }
      track.add(static_cast<float>(p->time));
      track.add(p->sphere);
      track.add(p->force);
      track.add(static_cast<float>(p->penetration));
      track.add(static_cast<float>(surface_stress(*p)));
    }
    return text(",\"step\":%.9g", step) + ",\"moved\":" + moved.json() + ",\"stress\":" + stress.json() +
           ",\"track\":" + track.json();
  }
  std::vector<std::array<NodeId, 3>> surface_faces() const {
    std::vector<std::array<NodeId, 3>> all;
    for (const auto& face : organ_.boundary())
      if (std::ranges::all_of(face.nodes, [&](NodeId n) { return vertex_of_[static_cast<std::size_t>(n)] >= 0; }))
        all.push_back({face.nodes[0], face.nodes[1], face.nodes[2]});
    return all;
  }
  std::string faces(const std::vector<std::array<NodeId, 3>>& list) const {
    Packed packed;
    for (const auto& face : list)
      for (const NodeId node : face) packed.add(static_cast<std::uint32_t>(vertex_of_[static_cast<std::size_t>(node)]));
    return packed.json();
  }
  std::string colours() const {
    Packed packed;
    for (const auto& colour : palette<128>(scale().map()))
      for (const std::uint8_t component : colour) packed.add(component);
    return packed.json();
  }

  const Organ& organ_;
  std::vector<std::array<NodeId, 3>> lesion_;
  std::vector<int> vertex_of_;
  std::vector<NodeId> nodes_;
  std::size_t surface_vertices_ = 0;
  std::vector<const Picture*> pictures_;
};

}  // namespace touch
