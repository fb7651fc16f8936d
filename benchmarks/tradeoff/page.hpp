// Shared by the page and the documents.
#pragma once

#include <palpate/model/static/trade_off.hpp>

#include <array>
#include <iosfwd>
#include <ostream>

#include "contender.hpp"

namespace tradeoff {

struct Measure {
  const char* title;
  double Row::*error;
};
inline constexpr std::array<Measure, 3> measures{{{"in motion, rendered at 1 kHz", &Row::in_motion},
                                                  {"at rest, small depth", &Row::force_small},
                                                  {"at rest, large depth", &Row::force_large}}};

inline bool is_good(const Row& row) {
  return row.verdict.empty();
}
/// Text with three significant digits; empty for NaN and infinity.
std::string three_digits(double value);
std::string percent(double value);
const char* colour_of(const std::string& family);

/// The trade-off of the rows that passed their own check; with baselines unless `compositions_only`.
TradeOff trade_off_of(const std::vector<Row>& rows, double Row::*error, bool compositions_only);

/// Error over latency as SVG, as a file or in a page. `floor`: relative error of the reference.
void write_plot(std::ostream& out, const std::vector<Row>& rows, double Row::*error, double budget, double floor);

/// The Pareto fronts of all measures, the baselines, and the advice, as Markdown.
std::string summary(const Bench& bench, const std::vector<Row>& rows, double budget);
/// The plot of the force error in motion, as SVG.
void write_picture(const Bench& bench, const std::vector<Row>& rows, double budget, const std::string& path);

}  // namespace tradeoff
