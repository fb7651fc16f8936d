#include "pointer_script.hpp"

#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>

namespace live {

namespace {

[[noreturn]] void refuse(int number, const std::string& line) {
  palpate::raise(palpate::SetupErrorKind::bad_file,
                 "line " + std::to_string(number) + " of the script is not understood: " + line,
                 "Write for instance `0.5 press 0.5 0.4`, `0.5..1.5 push 6` or `1.5..2.5 drag 0.6 0.4`");
}

double gently(double share) {
  return share * share * (3.0 - 2.0 * share);
}

}  // namespace

PointerScript::PointerScript(std::string_view text) {
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(lines, line);) add_line(line.substr(0, line.find('#')), ++number);
}

void PointerScript::add_line(const std::string& line, int number) {
  std::istringstream words(line);
  words.imbue(std::locale::classic());
  std::string span, what;
  if (!(words >> span)) return;
  double from = 0.0, to = 0.0;
  const std::size_t dots = span.find("..");
  const auto read = [&](const std::string& word, double& value) {
    std::istringstream in(word);
    in.imbue(std::locale::classic());
    if (!(in >> value) || !std::isfinite(value) || value < 0.0) refuse(number, line);
  };
  read(span.substr(0, dots), from);
  to = from;
  if (dots != span.npos) read(span.substr(dots + 2), to);
  if (!(words >> what) || to < from || to > 3600.0 || (!events_.empty() && from < events_.back().time - 1e-6))
    refuse(number, line);
  const int steps = std::max(1, static_cast<int>(std::ceil(60.0 * (to - from))));
  const auto add = [&](PointerEvent event, int step) {
    event.time = from + (to - from) * step / steps;
    if (event.action != PointerAction::orbit) event.x = x_, event.y = y_;
    events_.push_back(event);
  };
  if (what == "push") {
    double millimetres = 0.0;
    if (!(words >> millimetres)) refuse(number, line);
    for (int k = 1; k <= steps; ++k) {
      const double part = gently(static_cast<double>(k) / steps) - gently((k - 1.0) / steps);
      add({.action = PointerAction::wheel, .amount = 1e-3 * millimetres * part}, k);
    }
    return;
  }
  if (what == "key") {
    std::string key;
    if (!(words >> key)) refuse(number, line);
    add({.action = PointerAction::key, .key = key == "Tab" ? '\t' : key == "Space" ? ' ' : key[0]}, 1);
    return;
  }
  if (what == "release") {
    add({.action = PointerAction::release}, 1);
    return;
  }
  double x = 0.0, y = 0.0;
  if (!(words >> x >> y)) refuse(number, line);
  if (what == "orbit") {
    for (int k = 1; k <= steps; ++k) add({.action = PointerAction::orbit, .x = x / steps, .y = y / steps}, k);
    return;
  }
  if (what != "move" && what != "press" && what != "drag") refuse(number, line);
  const double x0 = x_, y0 = y_;
  for (int k = what == "drag" ? 1 : steps; k <= steps; ++k) {
    const double share = what == "drag" ? gently(static_cast<double>(k) / steps) : 1.0;
    x_ = x0 + share * (x - x0);
    y_ = y0 + share * (y - y0);
    add({.action = what == "press" ? PointerAction::press : PointerAction::move}, k);
  }
}

}  // namespace live
