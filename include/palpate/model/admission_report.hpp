// Entries of admission and materials in a set-up report.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/local/detail/split_elasticity.hpp>
#include <palpate/mesh/admission.hpp>
#include <palpate/mesh/diagnosis.hpp>
#include <palpate/model/setup_report.hpp>

#include <span>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Sizes, quality and findings of an admitted mesh.
template <Element E>
void report_admission(const Admitted<E>& admitted, SetupReport& report) {
  const MeshDiagnosis& given = admitted.diagnosis;
  const MeshDiagnosis& left = admitted.admitted;
  report.nodes = left.node_count;
  report.elements = left.element_count;
  report.worst_quality = left.min_quality;
  report.mean_quality = left.mean_quality;
  if (left.poor_quality)
    report.set(SetupFlag::poor_quality, std::to_string(left.poor_quality.count) +
                                            " elements are of poor quality, worst " + number(left.min_quality));
  if (left.looks_like_millimetres)
    report.set(SetupFlag::suspicious_units, "the body is " + number(left.diagonal) + " m across: millimetres?");
  if (left.component_count > 1)
    report.set(SetupFlag::disconnected, "the body is in " + std::to_string(left.component_count) + " pieces");
  const bool repaired = left.node_count != given.node_count || left.element_count != given.element_count ||
                        left.inverted.count != given.inverted.count;
  if (repaired)
    report.set(SetupFlag::repaired,
               "admission repaired the mesh: " +
                   (given.component_count > 1 ? std::to_string(given.component_count) + " pieces, " : "") +
                   std::to_string(given.orphans.count) + " orphan nodes, " + std::to_string(given.inverted.count) +
                   " inverted and " + std::to_string(given.degenerate.count) +
                   " flat elements were found; ids are those of mesh(), see node_map()");
  std::string notes;
  for (const std::string& note : admitted.mesh.notes) notes += (notes.empty() ? "" : "; ") + note;
  if (!notes.empty()) report.set(SetupFlag::file_notes, notes);
}

template <class E>
concept SaysWhenItLocks = requires {
  E::locking_poisson_ratio;
};

/// Flags an element that locks with one of the materials of a body. Applies to elements that define
/// `locking_poisson_ratio`.
template <Element E>
void report_locking(const std::vector<Matrix6>& elasticity, SetupReport& report) {
  if constexpr (SaysWhenItLocks<E>)
    for (const Matrix6& d : elasticity) {
      const double nu = equivalent_poisson_ratio(d);
      if (!(nu > E::locking_poisson_ratio + 1e-9)) continue;  // equal up to rounding
      report.set(SetupFlag::locking, "this element is too stiff at a Poisson ratio of " + number(nu) + " (above " +
                                         number(E::locking_poisson_ratio) + ")");
      return;
    }
}

}  // namespace detail

/// What a set-up was given that has units. The elasticity matrices are those of the regions, or of elements.
struct UnitCheck {
  std::span<const std::string> region_names;
  std::span<const Matrix6> elasticities;  ///< [Pa]
  std::span<const double> densities;      ///< [kg/m^3], of the regions
  double gravity = 0.0;                   ///< [m/s^2]
  double touch_radius = 0.0;              ///< [m]
};

namespace detail {

/// Flags values that look like other units than SI, in addition to those that the flag has already: a material softer
/// than 100 Pa, a body of which no material is softer than 0.1 GPa, a density outside 50 to 25 000 kg/m^3 (0: not
/// given), gravity above 100 m/s^2, a tool of more than 1 m. With `refuse` throws suspicious_units for the first one
/// (value, threshold; ids: the region).
void report_units(const UnitCheck& given, bool refuse, SetupReport& report);

/// Flags a touchable part all of whose nodes are fixed; `constrained` has the bits of every node's components.
void report_fixed_contact(std::span<const std::uint8_t> constrained, std::span<const NodeId> touchable,
                          SetupReport& report);

/// Largest displacement against the mean that counts as small, relative to the diagonal of the bounding box.
inline constexpr double largest_linear_displacement = 0.1;

/// The largest difference between one of the displacements and their mean [m]; 0 for none, NaN if one is NaN.
double displacement_spread(std::span<const Vector3> displacements) noexcept;

/// Flags a displacement u, 3 per node [m], that is not small: linear strain misinterprets a rotation as a stretch. The
/// criterion is the largest difference between the displacement of a node and the mean, relative to the diagonal of the
/// bounding box.
void report_displacement(const std::vector<Vector3>& positions, const VectorX& u, SetupReport& report);

}  // namespace detail

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/admission_report.ipp>
#endif
