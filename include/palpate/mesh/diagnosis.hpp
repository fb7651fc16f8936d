// All defects of a mesh in one result; the mesh is not changed and nothing is thrown.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

#include <array>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Bounds of the mesh checks. All are ratios, independent of the size of the mesh, except the one that detects wrong
/// units.
struct MeshThresholds {
  double degenerate = 1e-12;  ///< relative volume (mesh/quality.hpp) up to which an element is flat; rounding is added
  double poor_quality = 0.1;  ///< mean ratio below which an element is reported: aspect ratio of about ten
  double quality_floor = 1e-5;  ///< mean ratio below which an element is a sliver: height about 1e-8 of its edges
  double coincidence = 1e-6;    ///< distance / local edge up to which two nodes coincide
  double millimetres = 2.0;     ///< [m] diagonal of the bounding box above which the mesh is likely in millimetres
};

/// One kind of defect: how many, the first ids, the measured value of each and the bound of the worst.
struct Finding {
  Index count = 0;
  std::vector<std::int64_t> ids;  ///< at most SetupProblem::max_ids
  std::vector<double> values;     ///< of `ids`
  double worst = 0.0;             ///< least value of all, listed or not
  double threshold = 0.0;         ///< the bound that the worst one violated

  explicit operator bool() const noexcept { return count > 0; }

  void add(std::int64_t id, double value, double bound);
};

/// Everything `diagnose` measures. Ids of elements or nodes count from zero.
struct MeshDiagnosis {
  Index node_count = 0;
  Index element_count = 0;
  /// False if an index or a position is unusable or the mesh is empty: then only the two findings below are filled.
  bool complete = false;
  Finding index_out_of_range;  ///< elements; value: the node id or region
  Finding non_finite;          ///< nodes; NaN, infinite, or beyond 1e100, where squares overflow

  Finding inverted;            ///< elements; value: relative volume
  Finding degenerate;          ///< elements; value: relative volume
  Finding poor_quality;        ///< elements, slivers included; value: quality
  Finding slivers;             ///< elements below the quality floor; value: quality
  Finding duplicate_nodes;     ///< nodes, without the lowest one at each position; value: distance / local edge
  Finding duplicate_elements;  ///< elements, without the first one of each set; value: the first one
  Finding orphans;             ///< nodes that no element uses
  Finding disconnected;        ///< first node of every component, if there are several; value: its number of nodes
  Finding units;               ///< count 1 if the mesh looks like millimetres; worst: diagonal of the bounding box [m]

  Index component_count = 0;
  Vector3 box_min = Vector3::Zero();  ///< [m]
  Vector3 box_max = Vector3::Zero();  ///< [m]
  double diagonal = 0.0;              ///< of the bounding box [m]
  double offset_ratio = 0.0;  ///< largest coordinate / diagonal; its decimal exponent is the number of digits lost
  bool looks_like_millimetres = false;
  double volume = 0.0;  ///< [m^3]
  double min_quality = 0.0;
  double mean_quality = 0.0;
  std::array<Index, 10> quality_histogram{};  ///< elements by quality: [0, 0.1), [0.1, 0.2) ... [0.9, 1]

  bool empty() const noexcept { return node_count == 0 || element_count == 0; }
};

inline void Finding::add(std::int64_t id, double value, double bound) {
  if (count == 0 || value < worst) {
    worst = value;
    threshold = bound;
  }
  if (ids.size() < SetupProblem::max_ids) {
    ids.push_back(id);
    values.push_back(value);
  }
  ++count;
}

/// The diagnosis as text, one line per finding.
inline std::string describe(const MeshDiagnosis& d) {
  std::string text = std::to_string(d.node_count) + " nodes, " + std::to_string(d.element_count) + " elements, " +
                     std::to_string(d.component_count) + " components, volume " + number(d.volume) + " m^3, diagonal " +
                     number(d.diagonal) + " m, quality " + number(d.min_quality) + " least, " + number(d.mean_quality) +
                     " mean";
  const auto line = [&text](const char* name, const Finding& f) {
    if (!f) return;
    text += std::string("\n") + name + ": " + std::to_string(f.count) + ", worst " + number(f.worst);
    if (!f.ids.empty()) text += ", ids";
    for (auto id : f.ids) text += ' ' + std::to_string(id);
    if (!f.ids.empty() && f.count > static_cast<Index>(f.ids.size())) text += " ...";
  };
  line("index out of range", d.index_out_of_range);
  line("not finite", d.non_finite);
  line("inverted", d.inverted);
  line("degenerate", d.degenerate);
  line("poor quality", d.poor_quality);
  line("slivers", d.slivers);
  line("duplicate nodes", d.duplicate_nodes);
  line("duplicate elements", d.duplicate_elements);
  line("orphan nodes", d.orphans);
  line("disconnected, first nodes", d.disconnected);
  line("looks like millimetres", d.units);
  return text;
}

}}  // namespace palpate
