#include "shrink.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <type_traits>

namespace cross {

namespace {

using Scenes = std::vector<Scene>;

double rounded(double x, int digits) {
  std::ostringstream text;
  text.precision(digits);
  text << x;
  return std::stod(text.str());
}

/// Adds copies of a scene in which one value is the plain one, or nearer to it. `change(scene, f)` visits the values of
/// a copy.
template <class Visit>
void add_plainer_values(Scenes& list, const Scene& scene, const Scene& plain, Visit&& values) {
  int count = 0;
  values(scene, [&](const char*, const auto&) { ++count; });
  for (int i = 0; i < count; ++i) {
    int k = 0;
    values(scene, [&](const char* name, const auto& now) {
      if (k++ != i) return;
      using Value = std::decay_t<decltype(now)>;
      const auto add = [&](const Value& value) {
        if (value == now) return;
        Scene copy = scene;
        int m = 0;
        values(copy, [&](const char*, auto& v) {
          if constexpr (std::is_same_v<std::decay_t<decltype(v)>, Value>)
            if (m == i) v = value;
          ++m;
        });
        list.push_back(std::move(copy));
      };
      int m = 0;
      values(plain, [&](const char*, const auto& v) {
        if constexpr (std::is_same_v<std::decay_t<decltype(v)>, Value>)
          if (m == i) add(v);
        ++m;
      });
      if constexpr (std::is_same_v<Value, double>) add(rounded(now, 1));
      if constexpr (std::is_same_v<Value, int>)
        if (std::string(name) != "rate" && now > (std::string(name) == "ticks" ? 100 : 3)) add(now / 2);
    });
  }
}

/// Single changes that make a scene plainer, the largest first.
Scenes plainer(const Scene& scene) {
  Scenes list;
  for (std::size_t t = 0; scene.tools.size() > 1 && t < scene.tools.size(); ++t) {
    Scene copy = scene;
    copy.tools.erase(copy.tools.begin() + static_cast<std::ptrdiff_t>(t));
    list.push_back(std::move(copy));
  }
  const Scene plain;
  add_plainer_values(list, scene, plain, [](auto& s, auto&& f) { visit(s, f); });
  for (std::size_t t = 0; t < scene.tools.size(); ++t) {
    Scene plain_tools = scene;
    for (ToolValue& tool : plain_tools.tools) {
      const double radius = tool.radius;  // a plain radius beside the scene's facets would be another scene
      tool = ToolValue{};
      tool.radius = radius;
    }
    add_plainer_values(list, scene, plain_tools, [t](auto& s, auto&& f) { visit_tool(s.tools[t], f); });
  }
  return list;
}

}  // namespace

int size_of(const Scene& scene) {
  const std::string text = to_text(scene);
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

Scene shrink(Scene scene, const std::function<bool(const Scene&)>& fails, int most) {
  for (bool changed = true; changed;) {
    changed = false;
    Scenes list = plainer(scene);
    for (std::size_t i = 0; i < list.size() && most > 0; ++i) {
      if (list[i] == scene) continue;
      --most;
      if (!fails(list[i])) continue;
      scene = list[i];
      list = plainer(scene);  // in the same order: the search goes on where it is
      changed = true;
    }
  }
  return scene;
}

}  // namespace cross
