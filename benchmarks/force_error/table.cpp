#include "table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace force_error {
namespace {

template <class... T>
std::string text(const char* format, T... values) {
  std::array<char, 160> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, values...);
  return buffer.data();
}

void print_group(const std::string& name, const Errors& e) {
  std::printf("  %-10s %5d presses (%4d more lock), flagged %4.1f %%, error: mean %4.1f %%, largest %+6.1f %%  %s\n",
              name.c_str(), e.presses, e.locking, 100.0 * e.flagged / std::max(1, e.presses), 100.0 * e.mean(),
              100.0 * e.worst, e.where.c_str());
}

}  // namespace

void print_truth_error(const Case& test) {
  const Presses used = truth(test), fine = truth(test, 2.0);
  for (std::size_t t = 0; t < used.size(); ++t) {
    std::printf("error of the truth, nu %-6.4g, %s:", test.poisson_ratio, tool_names[t]);
    for (std::size_t d = 0; d < depths.size(); ++d) {
      double squares = 0.0;
      for (std::size_t i = 0; i < used[t].size(); ++i)
        squares += std::pow(used[t][i][d].force / fine[t][i][d].force - 1.0, 2);
      std::printf(" d/R %.4g %.2f %%", depths[d], 100.0 * std::sqrt(squares / static_cast<double>(used[t].size())));
    }
    std::printf("\n");
    std::fflush(stdout);
  }
}

void Errors::add(double error, const Press& press, bool locks, const std::string& name) {
  (locks ? locking : presses) += 1;
  if (locks) return;
  flagged += press.flagged;
  if (press.flagged) return;
  sum += std::abs(error);
  if (std::abs(error) <= std::abs(worst)) return;
  worst = error;
  where = name;
}

Errors& Table::group(const std::string& name) {
  const auto found = std::find_if(groups_.begin(), groups_.end(), [&](const auto& g) { return g.first == name; });
  if (found != groups_.end()) return found->second;
  return groups_.emplace_back(name, Errors{}).second;
}

void Table::add(const Case& test, double per_facet, const char* element, const Presses& truth, const Answer& answer) {
  const std::string cell =
      text("%-10s %-9s nu %-6.4g R/h %-4.2g", test.body.name.c_str(), element, test.poisson_ratio, per_facet);
  for (std::size_t t = 0; t < truth.size(); ++t) {
    std::printf("%s %-8s", cell.c_str(), tool_names[t]);
    for (std::size_t d = 0; d < depths.size(); ++d) {
      Errors here;
      for (std::size_t i = 0; i < truth[t].size(); ++i) {
        const double exact = truth[t][i][d].force;
        const Press& p = answer.presses[t][i][d];
        const double error = p.force / exact - 1.0;
        const std::string name = cell + text(" d/R %-6.4g %s", depths[d], tool_names[t]);
        const auto add_to = [&](Errors& e) { e.add(error, p, answer.locks, name); };
        add_to(here);
        add_to(group(test.body.name));
        if (test.body.edge_a != test.body.edge_b) continue;
        add_to(group(element));
        add_to(group(text("nu %.4g", test.poisson_ratio)));
        add_to(group(text("R/h %.2g", per_facet)));
        add_to(group(text("d/R %.4g", depths[d])));
        add_to(group(tool_names[t]));
        add_to(all_);
        if (answer.locks) continue;
        if (!p.flagged) unflagged_.push_back({name, error});
        if (answer.measured.empty() || t > 0) continue;
        const Press& m = answer.measured[t][i][d];
        ++measured_;
        inside_ += std::abs(m.force - exact) <= m.bound || m.flagged;
        bars_.push_back(m.bound / m.force);
      }
      std::printf("  %5.1f %% (%+.1f, %d flagged)", 100.0 * here.mean(), 100.0 * here.worst, here.flagged);
    }
    if (answer.locks) std::printf("  locking");
    std::printf("\n");
  }
  std::fflush(stdout);
}

void Table::print() const {
  std::printf("\nwithout the edge, but for the line of that body\n");
  for (const auto& [name, errors] : groups_) print_group(name, errors);
  print_group("all", all_);
  std::vector<Named> sorted = unflagged_;
  std::sort(sorted.begin(), sorted.end(),
            [](const Named& a, const Named& b) { return std::abs(a.error) > std::abs(b.error); });
  const auto above =
      std::count_if(sorted.begin(), sorted.end(), [](const Named& n) { return std::abs(n.error) > 0.06; });
  std::printf("\n%ld of %zu presses without a flag have an error above 6 %%; the largest:\n", static_cast<long>(above),
              sorted.size());
  for (std::size_t i = 0; i < std::min<std::size_t>(20, sorted.size()); ++i)
    std::printf("  %s %+.1f %%\n", sorted[i].name.c_str(), 100.0 * sorted[i].error);
  if (measured_ == 0) return;
  std::vector<double> bars = bars_;
  std::sort(bars.begin(), bars.end());
  std::printf(
      "\nmeasured: bar without linearity %.1f %% of the force in half of the presses; the truth inside, or a flag, "
      "in %d of %d\n",
      100.0 * bars[bars.size() / 2], inside_, measured_);
}

bool Table::is_good() const {
  return std::abs(all_.worst) <= 0.06 && all_.mean() <= 0.03 && all_.flagged < 0.05 * all_.presses &&
         inside_ >= 0.95 * measured_;
}

}  // namespace force_error
