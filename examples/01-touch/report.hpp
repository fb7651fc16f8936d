// report.html: one self-contained page.
#pragma once

#include "charts.hpp"
#include "page_data.hpp"
#include "tables.hpp"

#ifndef PALPATE_EXAMPLE_DATA
#define PALPATE_EXAMPLE_DATA "examples/data"
#endif

namespace touch {

/// A part of the page from the folder of this file: HTML, style or script.
inline std::string part(const std::string& name) {
  return io::read_file(PALPATE_EXAMPLE_DATA "/../01-touch/" + name);
}

/// Text of the page with {{name}} replaced.
inline std::string fill(std::string_view page, const Fields& fields) {
  std::string out;
  while (true) {
    const std::size_t open = page.find("{{"), close = page.find("}}", open);
    out += page.substr(0, open);
    if (close == page.npos) return out;
    const auto field = std::ranges::find(fields, page.substr(open + 2, close - open - 2), &Fields::value_type::first);
    if (field != fields.end()) out += field->second;
    page.remove_prefix(close + 2);
  }
}

inline std::string legend(const ColourScale& scale) {
  std::string out;
  for (int i = 0; i <= 4; ++i)
    out += text("<i style='bottom:%d%%'></i><span style='bottom:%d%%'>%.3g%s</span>", 25 * i, 25 * i,
                0.25e-3 * i * scale.high(), i == 4 ? " kPa" : "");
  return out;
}

inline std::string gradient(const ColourScale& scale) {
  std::string out = "linear-gradient(to top";
  for (int i = 0; i <= 8; ++i) out += ',' + to_hex(colour_at(scale.map(), i / 8.0));
  return out + ')';
}

inline std::string figures(const Organ& organ, const LoopReport& loop) {
  std::string out;
  for (const auto& [value, name] : Fields{{text("%.2f N", loop.peak_force), "peak force"},
                                          {seconds_text(loop.compute.percentile(0.5)), "median tick"},
                                          {seconds_text(loop.compute.percentile(0.999)), "at most, 99.9 % of ticks"},
                                          {std::to_string(loop.missed_deadlines),
                                           text("missed periods of %llu", static_cast<unsigned long long>(loop.ticks))},
                                          {seconds_text(organ.report().total_seconds()), "set-up"}})
    out += "<div><b>" + value + "</b><span>" + name + "</span></div>";
  return out;
}

inline std::string base64(std::string_view bytes) {
  Packed packed;
  packed.add(bytes);
  return packed.base64();
}

/// `still`: an SVG, for browsers that cannot draw the organ.
inline std::string make_page(const Organ& organ, const TouchPath& path, const Recording& session, const Plan& plan,
                             const std::vector<Picture>& pictures, const std::string& still) {
  Vector3 low = organ.mesh().position(0), high = low;
  for (const Vector3& x : organ.mesh().positions) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const Vector3 size = high - low;
  const PageData data(organ, pictures);
  const Charts charts = make_charts(organ, session, plan);
  const double per_newton =
      1.0 / round_up(std::max(1e-3, session.loop.peak_force) / (0.25 * size.maxCoeff()), {1.0, 2.0, 4.0, 5.0});
  return fill(part("page.html"),
              {{"style", part("page.css")},
               {"script", part("viewer.js")},
               {"still", "data:image/svg+xml;base64," + base64(still)},
               {"summary", text("A sphere of %g mm radius is pressed %g mm into a soft organ, moved %g mm across a "
                                "stiffer lesion hidden %.0f mm below, and lifted. "
                                "palpate computed the force in every millisecond.",
                                1e3 * tool.radius, 1e3 * plan.depth, 1e3 * plan.drag, 1e3 * path.target_depth())},
               {"gradient", gradient(data.scale())},
               {"legend", legend(data.scale())},
               {"arrow", text("%.0f mm per newton", 1e3 * per_newton)},
               {"figures", figures(organ, session.loop)},
               {"force_chart", charts.force},
               {"force_note", "The band is the error bar: " + error_text(session.loop.errors) + "."},
               {"depth_chart", charts.depth},
               {"curve_chart", charts.curve},
               {"latency_chart", charts.latency},
               {"latency_note", charts.latency_note},
               {"scene", scene_table(organ, plan, size, path.target_depth())},
               {"setup", setup_table(organ.report())},
               {"loop", loop_table(session.loop)},
               {"loop_facts", loop_facts(session.loop)},
               {"status", status_table(session.loop)},
               {"remarks",
                "The tissue is linear: strains beyond a few per cent, as directly under the sphere, are only "
                "qualitative. "
                "It has no inertia and no viscosity, and contact has no friction; so lifting follows the curve of "
                "pressing at the "
                "same place, and "
                "the grey curve differs because the place is different. Von Mises stress is averaged to the nodes."},
               {"version", text("%d.%d.%d", PALPATE_VERSION_MAJOR, PALPATE_VERSION_MINOR, PALPATE_VERSION_PATCH)},
               {"data", data.json(path.outward(), size, per_newton)}});
}

}  // namespace touch
