#include "draw.hpp"

#include "built.hpp"
#include "tissue.hpp"

#include <palpate/testing/random.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace cross {

namespace {

/// Solvers of the compositions that are linked.
std::vector<std::string> linked_solvers() {
  std::vector<std::string> linked;
  for (const std::string& solver : words_of("solver"))
    if (std::any_of(compositions().begin(), compositions().end(),
                    [&](const Composition& c) { return c.solver == solver; }))
      linked.push_back(solver);
  return linked;
}

class Draw {
 public:
  /// The generator's state grows by a constant: neighbouring numbers would give the same values one draw apart.
  explicit Draw(std::uint64_t number) : random_(palpate::testing::Random(number).bits()) {
    scene_.seed = 1 + number % 1000;
  }

  Scene scene() {
    composition();
    body();
    tissue();
    tools();
    surroundings();
    hard();
    return scene_;
  }

 private:
  bool chance(double p) { return random_.uniform() < p; }
  int integer(int low, int high) { return low + static_cast<int>(random_.uniform(0.0, high - low + 1.0)); }
  /// A number with two digits, on a logarithmic scale.
  double logarithmic(double low, double high) { return rounded(low * std::pow(high / low, random_.uniform())); }
  double uniform(double low, double high) { return rounded(random_.uniform(low, high)); }
  static double rounded(double x) {
    std::ostringstream text;
    text.precision(2);
    text << x;
    return std::stod(text.str());
  }
  template <class T>
  T one_of(const std::vector<T>& list) {
    return list[static_cast<std::size_t>(integer(0, static_cast<int>(list.size()) - 1))];
  }

  /// Half of the scenes have what the documentation recommends first.
  void composition() {
    const auto set = [this](const char* e, const char* l, const char* s) {
      if (find_composition(e, l, s) == nullptr)
        throw std::logic_error(std::string("not linked: ") + e + " " + l + " " + s);
      scene_.element = e, scene_.law = l, scene_.solver = s;
    };
    const double p = random_.uniform();
    if (p < 0.15) return set("smoothed_tet4", "linear", "condensed");
    if (p < 0.25) return set("tet4", "linear", "condensed");
    if (p < 0.40) return set("smoothed_tet4", "neo_hookean", "quasi_newton_float");
    if (p < 0.45) return set("tet4", "linear", "cut_condensed");
    if (p < 0.50) return set("tet4", "neo_hookean", "cut_quasi_newton");
    const std::string solver = chance(0.5) ? one_of(compositions()).solver : one_of(linked_solvers());
    std::vector<const Composition*> some;
    for (const Composition& c : compositions())
      if (c.solver == solver) some.push_back(&c);
    const Composition& any = *one_of(some);
    set(any.element.c_str(), any.law.c_str(), any.solver.c_str());
  }

  void body() {
    do scene_.body = chance(0.4) ? "block" : one_of(words_of("body"));
    while (is_hexahedral(scene_) && !has_hexahedra(scene_.body));
    const bool quadratic = scene_.element == "tet10" || scene_.element == "hex20";
    const int most = (moves(scene_.solver) || quadratic) ? 5 : 8;
    scene_.cells_x = integer(2, most), scene_.cells_y = integer(2, most),
    scene_.cells_z = integer(1, std::max(2, most / 2));
    if (scene_.body == "plate") scene_.cells_z = 1;
    if (scene_.body == "lobe")
      scene_.cells_x = integer(4, most + 2), scene_.cells_y = integer(1, 2), scene_.cells_z = 1;
    if (scene_.body == "tube") scene_.cells_x = integer(4, most + 1), scene_.cells_z = 1;
    if (scene_.body == "sphere" || scene_.body == "organ") scene_.cells_x = integer(2, quadratic ? 2 : 4);
    scene_.edge = logarithmic(1e-3, 10e-3);
    if (chance(0.25)) scene_.jitter = uniform(0.05, 0.3);
    if (chance(0.05)) scene_.slivers = integer(1, 3);
    if (chance(0.4)) scene_.touched = "surface";
    scene_.support = chance(0.5) ? "bottom" : one_of(words_of("support"));
    if (scene_.body == "lobe" || scene_.body == "plate")
      scene_.support = chance(0.7) ? (scene_.body == "lobe" ? "end" : "sides") : scene_.support;
  }

  void tissue() {
    scene_.youngs_modulus = chance(0.8) ? logarithmic(1e3, 5e4) : logarithmic(100.0, 1e7);
    const std::vector<double> usual{0.3, 0.4, 0.45, 0.49};
    scene_.poisson_ratio = chance(0.8) ? one_of(usual) : one_of(std::vector<double>{0.0, 0.1, 0.2, 0.499, 0.4999});
    if (chance(0.25)) {
      scene_.regions = one_of(std::vector<std::string>{"layer", "half", "inclusion"});
      scene_.contrast = chance(0.5) ? logarithmic(0.1, 100.0) : logarithmic(100.0, 1e6);
    }
  }

  void tools() {
    scene_.tools.clear();
    const int count = chance(0.6) ? 1 : integer(2, 4);
    // Facets of 0.2 to 10 radii; mostly about one. No tool is larger than half of the body.
    const double ratio = chance(0.7) ? logarithmic(0.4, 2.5) : logarithmic(0.2, 10.0);
    const double largest = scene_.edge * std::max(scene_.cells_x / 4.0, 2.0);
    for (int t = 0; t < count; ++t) {
      ToolValue tool;
      tool.kind = chance(0.6) ? "sphere" : one_of(std::vector<std::string>{"capsule", "plate"});
      if (can_be_cut(scene_.solver) && chance(0.4)) tool.kind = "blade";
      tool.radius = rounded(std::clamp(scene_.edge / ratio, 2e-4, largest)) *
                    (t == 0 ? 1.0 : one_of(std::vector<double>{0.5, 1.0, 2.0}));
      path(tool);
      for (int trial = 0; trial < 20 && is_crowded(tool); ++trial)
        tool.u = uniform(0.0, 1.0), tool.v = uniform(0.0, 1.0);
      if (t == 0 || !is_crowded(tool)) scene_.tools.push_back(tool);
    }
    if (scene_.tools.size() > 1 && chance(0.3)) pinch();
  }

  /// Whether a tool would overlap another one of the same side.
  bool is_crowded(const ToolValue& tool) const {
    const Vector3 point = place_of(scene_, tool.u, tool.v, tool.opposite).point;
    return std::any_of(scene_.tools.begin(), scene_.tools.end(), [&](const ToolValue& t) {
      return (place_of(scene_, t.u, t.v, t.opposite).point - point).norm() < 2.2 * (t.radius + tool.radius);
    });
  }

  void path(ToolValue& tool) {
    tool.u = uniform(0.0, 1.0), tool.v = uniform(0.0, 1.0);
    tool.path = chance(0.5) ? "press" : one_of(words_of("path"));
    const double thickness =
        scene_.body == "sphere" || scene_.body == "organ" ? scene_.edge * scene_.cells_x : scene_.edge * scene_.cells_z;
    tool.depth = tool.kind == "blade" ? uniform(0.3, 1.5)
                 : chance(0.7)        ? logarithmic(0.06, 0.5)
                                      : logarithmic(0.5, 1.5);
    if (tool.kind != "blade") tool.depth = rounded(std::min(tool.depth, 0.7 * thickness / tool.radius));
    if (tool.path == "slide" || tool.kind == "blade") tool.travel = logarithmic(0.2, 3.0);
    if (tool.kind == "blade") tool.path = "slide";
    tool.grasps = tool.kind != "blade" && chance(0.1);
    tool.opposite = scene_.touched == "surface" && chance(0.15);
  }

  /// The second tool is opposite to the first one.
  void pinch() {
    scene_.touched = "surface";
    if (scene_.body == "block" && scene_.support == "bottom") scene_.support = "end";
    ToolValue& a = scene_.tools[0];
    if (a.kind == "blade") return;
    if (!has_opposite(scene_)) return;
    scene_.tools.resize(2);
    scene_.tools[1] = a;
    scene_.tools[1].opposite = !a.opposite;
  }

  void surroundings() {
    if (chance(0.35)) {
      scene_.load = one_of(words_of("load"));
      if (scene_.load != "none") scene_.load_size = logarithmic(0.005, 0.1);
    }
    if (chance(0.05)) scene_.support_moves = logarithmic(0.01, 0.5);
    if (chance(0.3)) scene_.friction = uniform(0.1, 1.0);
    scene_.coupling = chance(0.7) ? 1000.0 : logarithmic(100.0, 5000.0);
    if (chance(0.05)) scene_.capacity = integer(8, 64);
    if (chance(0.05)) scene_.corrected = true;
    scene_.rate = chance(0.8) ? 1000 : one_of(std::vector<int>{500, 2000, 4000});
    scene_.ticks = scene_.rate * 3 / 10;
    if (chance(0.15)) scene_.threads = 3;
    if (chance(0.25)) scene_.pose = "rotated";
    if (chance(0.25)) scene_.member = one_of(words_of("member"));
    if (moves(scene_.solver)) {
      scene_.step =
          scene_.solver.find("newton") != std::string::npos ? one_of(std::vector<double>{0.005, 0.01, 0.02}) : 1e-3;
      scene_.inertia = chance(0.5);
    }
    if (can_be_cut(scene_.solver) && chance(0.4)) scene_.cuts = integer(1, 3);
  }

  /// What is hard for a contact, drawn more often than the rest would give it.
  void hard() {
    const bool is_moving = moves(scene_.solver);
    ToolValue& tool = scene_.tools[0];
    if (chance(0.06)) special_radii();
    if (scene_.touched == "surface" && chance(0.15)) scene_.touched = "whole";
    if (!is_moving && !can_be_cut(scene_.solver) && chance(0.15)) scene_.measured = true;
    if (scene_.measured && chance(0.5)) scene_.corrected = true;
    if (scene_.tools.size() == 1 && tool.kind == "sphere" && chance(0.08)) deep(tool);
    if (scene_.tools.size() == 1 && !is_moving && is_box() && chance(0.03)) many_points(tool);
    if (scene_.tools.size() == 2 && tool.opposite != scene_.tools[1].opposite && chance(0.5) && has_opposite(scene_))
      hard_pinch();
    if (quasi_static() && scene_.law == "viscoelastic" && chance(0.5)) long_hold(tool);
    if (quasi_static() && is_box() && chance(0.06)) stretch();
    if (is_moving && chance(0.06)) hanging_stiff_end();
  }
  bool is_box() const { return scene_.body == "block" || scene_.body == "plate" || scene_.body == "lobe"; }
  bool quasi_static() const { return scene_.solver.starts_with("quasi_newton") && !scene_.inertia; }
  /// Radii at which a rule of the contact may change.
  void special_radii() {
    const double ratio = one_of(std::vector<double>{0.4, 0.5, 0.6, 1.0, 2.0});
    for (ToolValue& t : scene_.tools)
      if (t.kind != "blade") t.radius = ratio * scene_.edge;
  }
  double thickness() const { return scene_.edge * (has_hexahedra(scene_.body) ? scene_.cells_z : scene_.cells_x); }
  void deep(ToolValue& tool) {
    tool.path = "press", tool.grasps = false, scene_.load = "none", scene_.friction = 0.0;
    tool.depth = rounded(std::min(uniform(1.0, 2.5), 0.8 * thickness() / tool.radius));
  }
  /// Facets so short that more of them press than there are rows.
  void many_points(ToolValue& tool) {
    scene_.body = "block", scene_.cells_x = scene_.cells_y = 12, scene_.cells_z = 4, scene_.capacity = 0;
    tool.kind = "sphere", tool.path = "press", tool.radius = 5.0 * scene_.edge, tool.depth = uniform(0.1, 0.5);
    tool.u = tool.v = 0.5, tool.opposite = tool.grasps = false, scene_.load = "none";
  }
  void hard_pinch() {
    if (chance(0.6)) scene_.friction = uniform(0.1, 1.0);
    ToolValue& first = scene_.tools[0];
    first.path = "press", first.grasps = false;
    if (chance(0.5)) first.depth = rounded(std::min(2.0, 0.6 * thickness() / first.radius));
    const bool opposite = scene_.tools[1].opposite;
    scene_.tools[1] = first, scene_.tools[1].opposite = opposite;
    scene_.load = "none", scene_.support_moves = 0.0;
  }
  void long_hold(ToolValue& tool) {
    scene_.ticks = scene_.rate;
    if (scene_.tools.size() == 1 && tool.kind == "sphere") deep(tool);
    tool.depth = std::min(tool.depth, 1.0);
  }
  void stretch() {
    scene_.support = "sides", scene_.support_moves = 0.0, scene_.load = "none", scene_.ticks = scene_.rate;
    scene_.support_travels = uniform(0.1, 0.6), scene_.friction = 0.0;
    if (chance(0.5)) scene_.poisson_ratio = 0.499;
  }
  void hanging_stiff_end() {
    scene_.regions = "half", scene_.support = "end", scene_.contrast = logarithmic(1e2, 1e5);
    scene_.load = "gravity", scene_.load_size = logarithmic(0.005, 0.05), scene_.support_moves = 0.0;
  }

  palpate::testing::Random random_;
  Scene scene_;
};

std::string range_of(double value, std::initializer_list<double> limits) {
  int i = 0;
  for (const double limit : limits) i += value > limit;
  return std::to_string(i);
}

std::string pair_of(const std::pair<std::string, std::string>& a, const std::pair<std::string, std::string>& b) {
  return a.first + " " + a.second + " x " + b.first + " " + b.second;
}

using Choice = std::pair<std::string, std::string>;

/// Whether a composition has what a choice requires of it.
bool allows(const Composition& c, const Choice& choice) {
  const auto& [axis, word] = choice;
  if (axis == "element") return c.element == word;
  if (axis == "law") return c.law == word;
  if (axis == "solver") return c.solver == word;
  if ((axis == "tool" && word == "blade") || (axis == "cuts" && word == "1")) return can_be_cut(c.solver);
  Scene scene;
  scene.element = c.element;
  if (axis == "body") return !is_hexahedral(scene) || has_hexahedra(word);
  return true;
}

/// Whether a scene can have both choices.
bool can_meet(const Choice& a, const Choice& b) {
  const auto both = [&](const char* axis, const char* word, const char* other) {
    return (a == Choice(axis, word) && b.first == other) || (b == Choice(axis, word) && a.first == other);
  };
  const auto word_of = [&](const char* axis) { return a.first == axis ? a.second : b.second; };
  if (both("tool", "blade", "path") && word_of("path") != "slide") return false;
  if (both("tool", "blade", "grasps") && word_of("grasps") == "1") return false;
  if (both("tool", "blade", "depth") && word_of("depth") == "0") return false;
  if ((a.first == "regions" && b.first == "contrast") || (b.first == "regions" && a.first == "contrast"))
    if ((word_of("regions") == "one") != (word_of("contrast") == "0")) return false;
  return std::any_of(compositions().begin(), compositions().end(),
                     [&](const Composition& c) { return allows(c, a) && allows(c, b); });
}

}  // namespace

Scene draw(std::uint64_t number) {
  return Draw(number).scene();
}

std::vector<std::pair<std::string, std::string>> choices_of(const Scene& s) {
  std::vector<std::pair<std::string, std::string>> choices;
  visit(s, [&](const char* name, const auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::string>) choices.emplace_back(name, value);
  });
  const ToolValue& tool = s.tools[0];
  choices.emplace_back("tool", tool.kind);
  choices.emplace_back("path", tool.path);
  choices.emplace_back("tools", range_of(static_cast<double>(s.tools.size()), {1.5}));
  choices.emplace_back("grasps", tool.grasps ? "1" : "0");
  choices.emplace_back("facets", range_of(s.edge / tool.radius, {0.6, 2.0}));
  choices.emplace_back("depth", range_of(tool.depth, {0.15, 0.5}));
  choices.emplace_back("friction", range_of(s.friction, {0.0}));
  choices.emplace_back("contrast", range_of(std::abs(std::log10(s.contrast)), {1e-9, 2.0}));
  choices.emplace_back("poisson_ratio", range_of(s.poisson_ratio, {0.35, 0.47, 0.495}));
  choices.emplace_back("cuts", range_of(s.cuts, {0.5}));
  choices.emplace_back("threads", range_of(s.threads, {1.5}));
  choices.emplace_back("rate", range_of(s.rate, {999.0, 1001.0}));
  return choices;
}

void Coverage::add(const Scene& scene) {
  const std::vector<Choice> choices = choices_of(scene);
  for (std::size_t i = 0; i < choices.size(); ++i)
    for (std::size_t j = i + 1; j < choices.size(); ++j) seen_.insert(pair_of(choices[i], choices[j]));
}

std::vector<std::string> Coverage::all() {
  // Every word of every axis, and the ranges that choices_of distinguishes.
  std::vector<std::vector<Choice>> axes;
  for (const auto& [axis, ranges] : std::vector<std::pair<const char*, int>>{
           {"body", 0},          {"regions", 0}, {"touched", 0}, {"support", 0}, {"element", 0},  {"law", 0},
           {"solver", 0},        {"load", 0},    {"pose", 0},    {"member", 0},  {"tool", 0},     {"path", 0},
           {"tools", 2},         {"grasps", 2},  {"facets", 3},  {"depth", 3},   {"friction", 2}, {"contrast", 3},
           {"poisson_ratio", 4}, {"cuts", 2},    {"threads", 2}, {"rate", 3}}) {
    axes.emplace_back();
    for (const std::string& word : words_of(std::string_view(axis) == "tool" ? "kind" : axis))
      axes.back().emplace_back(axis, word);
    for (int i = 0; i < ranges; ++i) axes.back().emplace_back(axis, std::to_string(i));
  }
  std::vector<std::string> pairs;
  for (std::size_t i = 0; i < axes.size(); ++i)
    for (std::size_t j = i + 1; j < axes.size(); ++j)
      for (const Choice& a : axes[i])
        for (const Choice& b : axes[j])
          if (can_meet(a, b)) pairs.push_back(pair_of(a, b));
  return pairs;
}

std::vector<std::string> Coverage::missing() const {
  std::vector<std::string> pairs;
  for (const std::string& pair : all())
    if (!seen_.contains(pair)) pairs.push_back(pair);
  return pairs;
}

}  // namespace cross
