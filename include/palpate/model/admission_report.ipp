// Definitions of admission_report.hpp.
#pragma once

#include <palpate/model/admission_report.hpp>
#include <palpate/core/detail/box.hpp>

#include <algorithm>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Collects findings on units, or refuses the first one.
class UnitFindings {
 public:
  explicit UnitFindings(bool refuse) noexcept : refuse_(refuse) {}

  /// Checks that a value is within bounds; `region`: its number, or -1.
  void compare(double value, double least, double most, const std::string& what, const char* question,
               int region = -1) {
    if (value >= least && value <= most) return;
    SetupProblem p;
    p.kind = SetupErrorKind::suspicious_units;
    p.what = what + ' ' + number(value) + question;
    p.hint = "Values are in m, N, Pa, kg and s; or accept it: AdmissionPolicy::units = Admission::accept";
    p.value = value;
    p.threshold = value < least ? least : most;
    const std::int64_t id = region;
    if (region >= 0) p.set_ids({&id, 1});
    if (refuse_) raise(std::move(p));
    text_ += (text_.empty() ? "" : "; ") + p.what;
  }
  const std::string& text() const noexcept { return text_; }

 private:
  bool refuse_;
  std::string text_;
};

/// Of an isotropic material; of another one about that.
inline double youngs_modulus(const Matrix6& d) noexcept {
  const double shear = d.diagonal().tail<3>().mean();
  return 2.0 * shear * (1.0 + equivalent_poisson_ratio(d));
}

PALPATE_INLINE void report_units(const UnitCheck& given, bool refuse, SetupReport& report) {
  constexpr double softest = 100.0, stiff = 1e8, lightest = 50.0, densest = 25e3, strongest = 100.0, largest = 1.0;
  UnitFindings found(refuse);
  const auto region = [&](std::size_t r) { return "region '" + given.region_names[r] + "'"; };
  const bool by_region = given.elasticities.size() == given.region_names.size();
  double least = infinity;
  for (std::size_t m = 0; m < given.elasticities.size(); ++m) {
    const double modulus = youngs_modulus(given.elasticities[m]);
    found.compare(modulus, softest, infinity,
                  (by_region ? region(m) : std::string("an element")) + " has a Young's modulus of", " Pa: kPa or MPa?",
                  by_region ? static_cast<int>(m) : -1);
    least = std::min(least, modulus);
    if (!found.text().empty()) break;
  }
  found.compare(least, 0.0, stiff, "the softest material has a Young's modulus of",
                " Pa: is it in Pa? No touch bends it");
  for (std::size_t r = 0; r < given.densities.size(); ++r)
    if (given.densities[r] > 0.0)
      found.compare(given.densities[r], lightest, densest, region(r) + " has a density of", " kg/m^3: g/cm^3?",
                    static_cast<int>(r));
  found.compare(given.gravity, 0.0, strongest, "gravity is", " m/s^2: mm/s^2?");
  found.compare(given.touch_radius, 0.0, largest, "the tool has a radius of", " m: millimetres?");
  if (found.text().empty()) return;
  std::string all = found.text();
  for (const auto& [flag, remark] : report.remarks)
    if (flag == SetupFlag::suspicious_units) all = remark + "; " + all;
  report.clear(SetupFlag::suspicious_units);
  report.set(SetupFlag::suspicious_units, std::move(all));
}

PALPATE_INLINE void report_fixed_contact(std::span<const std::uint8_t> constrained, std::span<const NodeId> touchable,
                                         SetupReport& report) {
  constexpr std::uint8_t all_components = 7;
  const bool fixed = std::all_of(touchable.begin(), touchable.end(), [&](NodeId node) {
    return constrained[static_cast<std::size_t>(node)] == all_components;
  });
  if (fixed && !touchable.empty())
    report.set(SetupFlag::fixed_contact, "all " + std::to_string(touchable.size()) +
                                             " nodes that can be touched are fixed: tools meet a rigid surface");
}

PALPATE_INLINE double displacement_spread(std::span<const Vector3> displacements) noexcept {
  Vector3 mean = Vector3::Zero();
  for (const Vector3& u : displacements) mean += u / static_cast<double>(displacements.size());
  double spread = 0.0;
  for (const Vector3& u : displacements) {
    const double distance = (u - mean).norm();
    if (!(distance <= spread)) spread = distance;  // not std::max: a NaN stays
  }
  return spread;
}

PALPATE_INLINE void report_displacement(const std::vector<Vector3>& positions, const VectorX& u, SetupReport& report) {
  report.clear(SetupFlag::large_displacement);
  std::vector<Vector3> displacements;
  for (Index i = 0; i < u.size() / 3; ++i) displacements.push_back(node_vector(u, i));
  const double spread = displacement_spread(displacements), size = box_of(positions).size().norm();
  if (!(spread <= largest_linear_displacement * size))
    report.set(SetupFlag::large_displacement, "the loads move a node by " + number(spread) + " m against the mean, " +
                                                  number(spread / size) +
                                                  " of the body's diagonal: too far for linear elasticity");
}

}}}  // namespace palpate::detail
