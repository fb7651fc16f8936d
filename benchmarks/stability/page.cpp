#include "page.hpp"

#include <ctime>
#include <fstream>
#include <ostream>

#include "../common/markup.hpp"

namespace maps {

using bench::escaped;

namespace {

#if defined(__clang__)
constexpr const char* compiler = __VERSION__;
#elif defined(__GNUC__)
constexpr const char* compiler = "g++ " __VERSION__;
#else
constexpr const char* compiler = "an unnamed compiler";
#endif

constexpr const char* style = R"(
:root{color-scheme:light dark;--paper:#fff;--ink:#1b1f24;--faint:#6b7480;--bad:#c8102e;--flag:#1b1f24;--limit:#b45309;
--s0:#eef5fb;--s1:#d6e8f5;--s2:#b5d5ec;--s3:#8bbce0;--s4:#5f9fd0;--s5:#3a7fb8;--s6:#e3b341;--s7:#d58a1e}
@media(prefers-color-scheme:dark){:root{--paper:#14171b;--ink:#e6e9ed;--faint:#8d97a3;--bad:#ff5a6e;--flag:#ffffff;
--limit:#fbbf24;--s0:#1b2733;--s1:#1f3345;--s2:#24435d;--s3:#2a5778;--s4:#326d97;--s5:#3d86b8;--s6:#8a6914;--s7:#a86512}}
body{background:var(--paper);color:var(--ink);font:15px/1.5 system-ui,sans-serif;margin:2rem auto;max-width:76rem;padding:0 1rem}
svg{max-width:100%;height:auto;font:9px system-ui,sans-serif;fill:var(--ink)}
svg .title{font-weight:600;font-size:10px}svg .axis{fill:var(--faint);font-size:9px}
.s0{fill:var(--s0)}.s1{fill:var(--s1)}.s2{fill:var(--s2)}.s3{fill:var(--s3)}
.s4{fill:var(--s4)}.s5{fill:var(--s5)}.s6{fill:var(--s6)}.s7{fill:var(--s7)}
.refused{fill:none;stroke:var(--faint)}.slash{stroke:var(--faint);fill:none}
.wrong{fill:var(--bad)}.cross{stroke:var(--paper);stroke-width:2;fill:none}
.unjudged{fill:none;stroke:var(--faint);stroke-dasharray:2 2}.flag{fill:var(--flag)}
.limit{stroke:var(--limit);stroke-width:2;fill:none}
table{border-collapse:collapse}td,th{padding:.1rem .8rem .1rem 0;text-align:right}td:first-child,th:first-child{text-align:left}
.key{display:inline-flex;gap:.3rem;align-items:center;margin-right:1.2rem}.key svg{width:15px;height:15px}
)";

std::string key(const char* shape, const char* what) {
  return std::string("<span class=key><svg viewBox='0 0 15 15'>") + shape + "</svg>" + what + "</span>";
}
std::string keys() {
  return "<p>" +
         key("<rect x='1' y='1' width='13' height='13' class='s2'/>",
             "within its bound; colour: error, pale 1e-14, amber from 1e-4") +
         key("<rect x='1' y='1' width='13' height='13' class='s5'/><path d='M7.5 4L11.5 11L3.5 11Z' class='flag'/>",
             "flagged: a result with a warning and an error estimate") +
         key("<rect x='1' y='1' width='13' height='13' class='refused'/><path d='M4 11L11 4' class='slash'/>",
             "refused") +
         key("<rect x='1' y='1' width='13' height='13' class='wrong'/><path d='M4 4L11 11M4 11L11 4' class='cross'/>",
             "WRONG: outside its bound without a warning") +
         key("<rect x='1' y='1' width='13' height='13' class='unjudged'/>",
             "unjudged: the reference is too inaccurate") +
         "</p>\n";
}

void write_rows(std::ostream& out, const char* whose, const std::map<std::string, Counts>& score) {
  for (const auto& [who, counts] : score) {
    out << "<tr><td>" << whose << escaped(who);
    for (int n : counts.of) out << "<td>" << n;
    out << "<td>" << counts.all() << '\n';
  }
}
void write_score(std::ostream& out, const Score& score) {
  out << "<table><tr><th>";
  for (const char* verdict : verdict_names) out << "<th>" << verdict;
  out << "<th>cells\n";
  write_rows(out, "", score.ours);
  write_rows(out, "others: ", score.others);
  out << "</table>\n";
}

/// Writes the score of a map, the panels of palpate and those of others.
template <class Map>
void write_panels(std::ostream& out, const Map& map, const char* others, const char* x_name, const char* y_name) {
  write_score(out, map.score);
  out << "<h3>palpate</h3>\n"
      << svg_of(map.ours, 4, x_name, y_name) << "<h3>Others: " << others << "</h3>\n"
      << svg_of(map.others, 4, x_name, y_name);
}

}  // namespace

void write_page(const Page& page, const std::string& path) {
  std::ofstream out(path);
  std::array<char, 40> date{};
  const std::time_t now = std::time(nullptr);
  std::strftime(date.data(), date.size(), "%Y-%m-%d", std::gmtime(&now));
  out << "<!doctype html><html lang=en><meta charset=utf-8><meta name=viewport content='width=device-width'>"
      << "<title>palpate: range of valid results</title><style>" << style
      << "</style>\n<h1>Range of valid results</h1>\n<p>" << date.data() << ", " << compiler
      << ". Point at a cell for its figures.</p>\n"
      << keys();
  if (!page.statics.ours.empty()) {
    out << "<h2>Statics</h2>\n<p>A cube of linear tetrahedra, soft where it is fixed and up to 1e9 times as stiff "
           "where it is loaded, with one layer of flattened elements. Error of displacement and contact compliance "
           "relative to a dense Cholesky factorisation in long double of a stiffness computed in long double; bound "
           "1e-5, in float 1e-3. A flag counts if the error is at most 100 times the estimate of the report.</p>\n";
    write_panels(out, page.statics, "the same equations, only info() is checked", "Poisson's ratio", "contrast");
    out << "<h3>Input without a solution</h3>\n" << svg_of(page.statics.defects, 1, "", "");
  }
  if (!page.dynamics.ours.empty()) {
    out << "<h2>Dynamics</h2>\n<p>A block fixed at the bottom under lateral gravity. WRONG: ten times the work of the "
           "load, or NaN, without a warning. Colour: error of energy relative to the work. Line: 2/omega_max at "
           "rest, from a dense eigenvalue problem.</p>\n";
    write_panels(out, page.dynamics, "the same forces, no step limit, no line search, no energy check", "step [s]",
                 "E [Pa]");
  }
  if (!page.haptics.empty())
    out << "<h2>Haptics</h2>\n<p>A wall rendered by simulated devices in simulated hands. Pale: passive; strong: "
           "stable but not passive; triangle: oscillates. Columns: rate and ticks of delay. Line: b/(T/2 + "
           "delay).</p>\n"
        << svg_of(page.haptics, 3, "rate, delay", "wall [N/m]");
}

}  // namespace maps
