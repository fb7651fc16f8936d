#include "charts.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace live {

namespace {

constexpr ImU32 paper = IM_COL32(24, 28, 35, 255), grid = IM_COL32(62, 70, 82, 255), ink = IM_COL32(176, 186, 198, 255),
                line = IM_COL32(255, 150, 84, 255), band = IM_COL32(255, 150, 84, 70),
                blue = IM_COL32(98, 160, 234, 255), red = IM_COL32(235, 87, 87, 255),
                amber = IM_COL32(242, 190, 60, 255), unlit = IM_COL32(58, 65, 76, 255);

/// The next rectangle of the panel, filled.
struct Sheet {
  ImDrawList* list = ImGui::GetWindowDrawList();
  ImVec2 low, high;

  Sheet(float width, float height) {
    low = ImGui::GetCursorScreenPos();
    high = {low.x + width, low.y + height};
    ImGui::Dummy({width, height});
    list->AddRectFilled(low, high, paper, 4.0F);
  }
  void text(float x, float y, ImU32 colour, const char* words) const { list->AddText({x, y}, colour, words); }
};

double nice_top(double most) {
  const double decade = std::pow(10.0, std::floor(std::log10(std::max(most, 0.05))));
  for (const double step : {1.0, 2.0, 5.0, 10.0})
    if (most <= step * decade) return step * decade;
  return 10.0 * decade;
}

/// Flags that mean that a force was changed or may be wrong; the others are news.
bool is_serious(Status status) {
  using enum StatusFlag;
  for (const StatusFlag f : {non_finite_input, non_finite_force, disconnected, stale, solver_not_converged, inverted,
                             step_refused, energy_grew})
    if (status.has(f)) return true;
  return false;
}

}  // namespace

void draw_force_chart(const TickLog& log, float width, float height) {
  const Sheet sheet(width, height);
  const auto& points = log.chart();
  const double now = points.empty() ? 0.0 : points.back().time;
  double most = 0.0;
  for (const ChartPoint& p : points)
    most = std::max(most,
                    static_cast<double>(p.force) + (std::isfinite(p.bound) ? 1.0 : 0.0) * std::min(p.bound, p.force));
  const double top = nice_top(1.05 * most);
  const float strip = 6.0F, bottom = sheet.high.y - strip - 4.0F, head = sheet.low.y + 6.0F;
  const auto x = [&](double time) {
    return sheet.low.x + width * static_cast<float>(1.0 - (now - time) / TickLog::window);
  };
  const auto y = [&](double force) {
    return bottom - (bottom - head) * static_cast<float>(std::clamp(force / top, 0.0, 1.0));
  };
  for (int k = 0; k <= 2; ++k) {
    const double force = 0.5 * k * top;
    sheet.list->AddLine({sheet.low.x, y(force)}, {sheet.high.x, y(force)}, grid);
    std::array<char, 32> label{};
    std::snprintf(label.data(), label.size(), "%.3g N", force);
    sheet.text(sheet.low.x + 4.0F, y(force) + (k == 2 ? 1.0F : -17.0F), ink, label.data());
  }
  sheet.list->PushClipRect(sheet.low, sheet.high, true);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const ChartPoint &a = points[i - 1], &b = points[i];
    if (b.time < now - TickLog::window || b.time - a.time > 0.05) continue;
    if (std::isfinite(a.bound) && std::isfinite(b.bound))
      sheet.list->AddQuadFilled({x(a.time), y(a.force + a.bound)}, {x(b.time), y(b.force + b.bound)},
                                {x(b.time), y(b.force - b.bound)}, {x(a.time), y(a.force - a.bound)}, band);
    sheet.list->AddLine({x(a.time), y(a.force)}, {x(b.time), y(b.force)}, line, 1.8F);
    if (!b.status.ok())
      sheet.list->AddRectFilled({x(a.time), sheet.high.y - strip}, {x(b.time) + 1.0F, sheet.high.y},
                                is_serious(b.status) ? red : amber);
  }
  sheet.list->PopClipRect();
}

void draw_tick_histogram(const TickLog& log, double period, float width, float height) {
  const Sheet sheet(width, height);
  constexpr double least = 1e-6;
  constexpr int columns = 64;
  const DurationHistogram& all = log.compute();
  std::array<double, columns> share{};
  const auto place = [&](double seconds) {
    return std::log(std::max(seconds, least) / least) / std::log(2.0 * period / least);
  };
  for (int bin = 0; bin < DurationHistogram::bins; ++bin) {
    if (all.count(bin) == 0) continue;
    const int column = std::clamp(static_cast<int>(columns * place(DurationHistogram::low(bin))), 0, columns - 1);
    share[static_cast<std::size_t>(column)] += static_cast<double>(all.count(bin));
  }
  const double most = std::max(1.0, *std::ranges::max_element(share));
  const float bottom = sheet.high.y - 18.0F, top = sheet.low.y + 20.0F;
  const auto x = [&](double seconds) {
    return sheet.low.x + width * static_cast<float>(std::min(1.0, place(seconds)));
  };
  for (int c = 0; c < columns; ++c) {
    const double part = share[static_cast<std::size_t>(c)] / most;
    if (part <= 0.0) continue;
    const float left = sheet.low.x + width * static_cast<float>(c) / columns;
    const float tall = (bottom - top) * static_cast<float>(std::sqrt(part));
    sheet.list->AddRectFilled({left, bottom - tall}, {left + width / columns - 1.0F, bottom}, blue);
  }
  for (const double seconds : {1e-6, 1e-5, 1e-4, 1e-3}) {
    sheet.list->AddLine({x(seconds), top}, {x(seconds), bottom}, seconds == period ? red : grid);
    sheet.text(x(seconds) + 3.0F, bottom + 1.0F, ink,
               seconds < 5e-6   ? "1 us"
               : seconds < 5e-5 ? "10 us"
               : seconds < 5e-4 ? "100 us"
                                : "1 ms");
  }
  std::array<char, 96> words{};
  std::snprintf(words.data(), words.size(), "tick: p50 %.1f us, p99 %.1f us, late %llu", 1e6 * all.percentile(0.5),
                1e6 * all.percentile(0.99), static_cast<unsigned long long>(log.late()));
  sheet.text(sheet.low.x + 4.0F, sheet.low.y + 2.0F, ink, words.data());
}

void draw_status(Status status, float width) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImVec2 low = ImGui::GetCursorScreenPos();
  constexpr float row = 15.0F;
  const int rows = (status_flag_count + 1) / 2;
  for (int bit = 0; bit < status_flag_count; ++bit) {
    const auto flag = static_cast<StatusFlag>(1u << bit);
    const bool on = status.has(flag);
    const float x = low.x + (bit < rows ? 0.0F : 0.5F * width), y = low.y + row * static_cast<float>(bit % rows);
    list->AddCircleFilled({x + 6.0F, y + 7.5F}, 4.0F, !on ? unlit : is_serious(flag) ? red : amber);
    list->AddText({x + 16.0F, y}, on ? IM_COL32_WHITE : IM_COL32(120, 129, 141, 255),
                  std::string(status_flag_name(bit)).c_str());
  }
  ImGui::Dummy({width, row * static_cast<float>(rows)});
}

}  // namespace live
