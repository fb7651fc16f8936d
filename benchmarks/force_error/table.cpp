#include "table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace force_error {
namespace {

/// Root mean squares over the places, at one depth, relative to the true force.
struct Measured {
  double real = 0.0, expected = 0.0, bound = 0.0, corrected = 0.0, recovered = 0.0;
  int inside = 0;
  bool flagged = false;
};

Measured measure(const Forces& truth, const Answer& answer, std::size_t d) {
  Measured m;
  const auto n = static_cast<double>(truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double t = truth[i][d];
    const Press& p = answer.presses[i][d];
    m.real += std::pow(p.force / t - 1.0, 2) / n;
    m.expected += std::pow(p.expected / t, 2) / n;
    m.bound += std::pow(p.bound / t, 2) / n;
    m.corrected += std::pow((p.force - p.expected) / t - 1.0, 2) / n;
    m.recovered += std::pow(p.recovered / t, 2) / n;
    m.inside += std::abs(p.force - t) <= p.bound;
    m.flagged = m.flagged || p.flagged;
  }
  for (double* v : {&m.real, &m.expected, &m.bound, &m.corrected, &m.recovered}) *v = std::sqrt(*v);
  return m;
}

}  // namespace

TruthError measure_truth_error(const TestBody& block, const std::vector<double>& poisson_ratios, double per_facet) {
  TruthError largest{};
  const double facet = mean_facet(block), radius = per_facet * facet;
  for (const double poisson_ratio : poisson_ratios) {
    const Case test{block, poisson_ratio, radius, places_on(block, 1.5 * facet + 0.5 * radius, 7, 4)};
    const Forces used = truth(test), fine = truth(test, 2.0 * true_edges_per_radius);
    std::printf("error of the truth, nu %-6.4g, R/h %.2g:", poisson_ratio, per_facet);
    for (std::size_t d = 0; d < depths.size(); ++d) {
      double squares = 0.0;
      for (std::size_t i = 0; i < used.size(); ++i) squares += std::pow(used[i][d] / fine[i][d] - 1.0, 2);
      const double error = std::sqrt(squares / static_cast<double>(used.size()));
      std::printf(" d/R %.4g %.2f %%", depths[d], 100.0 * error);
      largest[d] = std::max(largest[d], error);
    }
    std::printf("\n");
    std::fflush(stdout);
  }
  return largest;
}

void Table::add(const Case& test, double per_facet, const char* element, const Forces& truth, const Answer& answer) {
  const bool same_mesh = answer.nodes_per_element == Tet10::nodes && per_facet > 0.7 * true_edges_per_radius;
  for (std::size_t d = 0; d < depths.size(); ++d) {
    const Measured m = measure(truth, answer, d);
    const double ratio = m.expected / m.real;
    const bool small = m.real < 2.0 * truth_error_[d];
    std::array<char, 120> name{};
    std::snprintf(name.data(), name.size(), "%-10s %-9s nu %-6.4g R/h %-4.2g d/R %-6.4g", test.body.name.c_str(),
                  element, test.poisson_ratio, per_facet, depths[d]);
    std::printf("%s true %6.1f %%, expected %6.1f %% (%.2f), bound %6.1f %%, inside %d of %zu, corrected %5.1f %%",
                name.data(), 100.0 * m.real, 100.0 * m.expected, ratio, 100.0 * m.bound, m.inside, truth.size(),
                100.0 * m.corrected);
    if (answer.has_recovered) std::printf(", recovered %6.1f %% (%.2f)", 100.0 * m.recovered, m.recovered / m.real);
    std::printf("%s%s\n", m.flagged ? ", locking flagged" : "",
                same_mesh ? ", apart: the true mesh is not finer"
                : small   ? ", apart: small"
                          : "");
    ++all_;
    if (same_mesh) {
      ++same_mesh_;
      continue;
    }
    low_ += m.bound < 0.3 * m.real && !m.flagged;
    presses_ += static_cast<int>(truth.size());
    inside_ += m.inside;
    before_ += m.real * m.real;
    after_ += m.corrected * m.corrected;
    if (small) {
      ++small_;
      continue;
    }
    measured_.add(ratio);
    if (answer.has_recovered) {
      measured_beside_recovered_.add(ratio);
      recovered_.add(m.recovered / m.real);
    }
    cells_.push_back({name.data(), ratio, m.real, m.expected});
  }
  std::printf("  set-up %.2f s, of it measurement %.2f s%s%s\n", answer.setup_seconds, answer.accuracy_seconds,
              answer.remark.empty() ? "" : "; ", answer.remark.c_str());
  std::fflush(stdout);
}

void Table::print_worst() const {
  std::vector<Cell> cells = cells_;
  std::sort(cells.begin(), cells.end(),
            [](const Cell& a, const Cell& b) { return std::abs(std::log(a.ratio)) > std::abs(std::log(b.ratio)); });
  std::printf("\nworst ten\n");
  for (std::size_t i = 0; i < std::min<std::size_t>(10, cells.size()); ++i)
    std::printf("  %s true %6.2f %%, expected %6.2f %% (%.2f)\n", cells[i].name.c_str(), 100.0 * cells[i].real,
                100.0 * cells[i].expected, cells[i].ratio);
}

void Table::print_sum() const {
  std::printf(
      "\n%d cells, apart %d with true errors below twice the error of the truth and %d with a true mesh that is not "
      "finer\n",
      all_, small_, same_mesh_);
  std::printf("%d cells: expected error within 0.5 to 2 of the true one in %d\n", measured_.cells, measured_.within);
  std::printf("%d cells: bound below 0.3 of the true error, not flagged: %d\n", all_ - same_mesh_, low_);
  std::printf("%d presses: the bound contains the truth in %d\n", presses_, inside_);
  std::printf("%d cells with an estimate of Zienkiewicz and Zhu: within 0.5 to 2 in %d, the measured one in %d\n",
              recovered_.cells, recovered_.within, measured_beside_recovered_.within);
  const auto n = static_cast<double>(all_ - same_mesh_);
  std::printf("root mean square of the error: %.1f %%, with the expected error subtracted %.1f %%\n",
              100.0 * std::sqrt(before_ / n), 100.0 * std::sqrt(after_ / n));
}

bool Table::is_good() const {
  return measured_.within >= 0.9 * measured_.cells && low_ == 0 && inside_ >= 0.95 * presses_;
}

}  // namespace force_error
