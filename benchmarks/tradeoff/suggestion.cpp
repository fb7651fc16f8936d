// The advice of `suggest` on the same scene, to compare with what is measured here.
#include <palpate/model/static/suggest.hpp>

#include <sstream>

#include "page.hpp"

namespace tradeoff {

std::string suggestion(const PressScene& press, double budget) {
  Scene scene;
  scene.fix(constrained_group).touch(near_group, {.radius = press.radius});
  const Suggestion s = suggest(press.mesh, scene, press.materials, {.tick_seconds = budget});
  std::ostringstream out;
  out << "suggest, in " << three_digits(s.seconds) << " s; errors at a depth of an eighth of the radius\n";
  for (const detail::SuggestedModel& m : s.candidates) {
    out << "  " << m.name();
    if (m.measured)
      out << ": " << percent(m.error) << " % error, p99 " << three_digits(1e6 * m.tick) << " us, set-up "
          << three_digits(1e3 * m.setup) << " ms";
    out << (m.remark.empty() ? "" : "; " + m.remark) << '\n';
  }
  out << s.code();
  return out.str();
}

}  // namespace tradeoff
