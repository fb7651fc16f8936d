// What page and documents share.
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
inline constexpr std::array<Measure, 3> measures{{{"felt at 1 kHz, in motion", &Row::felt},
                                                  {"held at the small depth", &Row::force_small},
                                                  {"held at the large depth", &Row::force_large}}};

inline bool is_good(const Row& row) {
  return row.verdict.empty();
}
/// Three significant digits; empty for what is not a number.
std::string three_digits(double value);
std::string percent(double value);
const char* colour_of(const std::string& family);

/// Of the rows that are as they must be; baselines too, unless only what can be composed is wanted.
TradeOff trade_off_of(const std::vector<Row>& rows, double Row::*error, bool compositions_only);

/// Error over latency as SVG, by itself or in a page. `floor`: how far the reference itself is in doubt.
void write_plot(std::ostream& out, const std::vector<Row>& rows, double Row::*error, double budget, double floor);

/// What nothing beats in one of the measures, the baselines, and the advice, as Markdown.
std::string summary(const Bench& bench, const std::vector<Row>& rows, double budget);
/// The plot of what is felt, as SVG.
void write_picture(const Bench& bench, const std::vector<Row>& rows, double budget, const std::string& path);

}  // namespace tradeoff
