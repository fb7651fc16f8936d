// Report of a set-up: sizes, memory, times and findings.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/cache/cache_report.hpp>

#include <iosfwd>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Conditions that a set-up accepts and reports.
enum class SetupFlag : std::uint32_t {
  locking = 1u << 0,           ///< the element is too stiff at this Poisson ratio
  ill_conditioned = 1u << 1,   ///< the probe solve lost more digits than expected
  poor_quality = 1u << 2,      ///< slivers
  repaired = 1u << 3,          ///< admission changed the mesh
  disconnected = 1u << 4,      ///< more than one piece
  suspicious_units = 1u << 5,  ///< a length, material or gravity looks like other units than SI
  cache_rejected = 1u << 6,    ///< there was a cache file and it was not used
  cache_unwritten = 1u << 7,   ///< the cache file could not be written
  non_manifold = 1u << 8,      ///< more than two touchable triangles meet at an edge
  /// the loads of the scene alone displace parts of the body relative to each other by a tenth of its size
  large_displacement = 1u << 9,
  coarse_contact = 1u << 10,        ///< the facets are too long for the sphere that will touch: see AccuracyReport
  accuracy_not_reached = 1u << 11,  ///< the force error is above the wanted one, or not known: see AccuracyReport
  file_notes = 1u << 12,            ///< the mesh file has data that its reader did not use: see Mesh::notes
  fixed_contact = 1u << 13,         ///< all nodes that can be touched are fixed: tools meet a rigid surface
};

/// Error of the contact force because of the mesh, for the sphere that touches according to the scene (TouchOptions).
/// Errors are relative to the force on a fine mesh; positive: the force is too large.
struct AccuracyReport {
  double radius = 0.0;   ///< of the sphere [m]
  int places = 0;        ///< where it was measured; 0: not measured, for the reason in `remark`
  int pinched = 0;       ///< of these, where a second sphere pressed the opposite side, too (TouchOptions::pinched)
  double typical = 0.0;  ///< root mean square of the errors at a depth of an eighth of the radius: that of single
                         ///< spheres or that of pinches, whichever is larger
  double largest = 0.0;  ///< the largest of all these errors, with its sign
  double facet = 0.0;    ///< mean length of the facets at the places [m]
  Index nodes = 0;       ///< of the fine mesh
  double wanted = 0.0;   ///< ForceErrorOptions::wanted
  std::string remark;
};

/// Sizes, memory [bytes], times [s] and findings of a set-up.
struct SetupReport {
  Index nodes = 0, elements = 0, free_dofs = 0, condensed_dofs = 0, kept_dofs = 0, touchable_vertices = 0,
        rendered_nodes = 0;
  std::size_t stiffness_bytes = 0, solver_bytes = 0, compliance_bytes = 0;
  double worst_quality = 1.0, mean_quality = 1.0;       ///< mean ratio, 1 is a regular element
  double condition_estimate = 0.0;                      ///< 1-norm; 0 when not estimated (iterative solvers)
  double probe_error = 0.0;                             ///< relative error of a solve with a known solution
  std::vector<std::pair<std::string, double>> seconds;  ///< per stage
  double column_seconds = 0.0;  ///< time for the compliance of a vertex at its first contact; 0 when all is stored
  bool asynchronous_columns = false;  ///< a background thread computes it, and ticks do not wait
  AccuracyReport accuracy;
  CacheReport cache;
  std::uint32_t flags = 0;
  std::vector<std::pair<SetupFlag, std::string>> remarks;  ///< one sentence per flag

  void set(SetupFlag flag, std::string remark);
  void clear(SetupFlag flag);
  bool has(SetupFlag flag) const noexcept { return (flags & static_cast<std::uint32_t>(flag)) != 0; }
  /// Enters the wanted error of forces, 0: any; flags it if the one in `accuracy` is larger or not known.
  void require_accuracy(double wanted);
  double total_seconds() const noexcept;
};

/// Prints a summary of a few lines for a log.
std::ostream& operator<<(std::ostream& out, const SetupReport& r);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/setup_report.ipp>
#endif
