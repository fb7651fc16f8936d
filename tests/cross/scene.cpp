#include "scene.hpp"

#include <algorithm>
#include <charconv>
#include <functional>
#include <istream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <type_traits>

namespace cross {

namespace {

std::string text_of(const std::string& value) {
  return value;
}
std::string text_of(bool value) {
  return value ? "1" : "0";
}
template <class Number>
std::string text_of(Number value) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

void read_value(const std::string& name, const std::string& text, std::string& value) {
  for (const std::string& word : words_of(name))
    if (word == text) {
      value = text;
      return;
    }
  throw std::runtime_error(name + " cannot be \"" + text + "\"");
}
template <class Number>
void read_value(const std::string& name, const std::string& text, Number& value) {
  using Read = std::conditional_t<std::is_same_v<Number, bool>, int, Number>;
  Read read{};
  const auto result = std::from_chars(text.data(), text.data() + text.size(), read);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size())
    throw std::runtime_error(name + " is no number: \"" + text + "\"");
  value = static_cast<Number>(read);
}

template <class Visit>
void set(const std::string& name, const std::string& text, Visit&& visit_values) {
  bool found = false;
  visit_values([&](const char* one, auto& value) {
    if (name != one) return;
    found = true;
    read_value(name, text, value);
  });
  if (!found) throw std::runtime_error("there is no value \"" + name + "\"");
}

/// Lines for the values that differ from those of `plain`.
template <class Visit>
void write(std::string& text, const std::string& prefix, Visit&& visit_values) {
  std::vector<std::string> plain;
  visit_values(true, [&](const char*, const auto& value) { plain.push_back(text_of(value)); });
  std::size_t i = 0;
  visit_values(false, [&](const char* name, const auto& value) {
    if (const std::string now = text_of(value); now != plain[i++]) text += prefix + name + " " + now + "\n";
  });
}

}  // namespace

bool is_cut(const Scene& s) {
  return s.cuts > 0 ||
         std::any_of(s.tools.begin(), s.tools.end(), [](const ToolValue& t) { return t.kind == "blade"; });
}

const std::vector<std::string>& words_of(std::string_view name) {
  static const std::map<std::string, std::vector<std::string>, std::less<>> words{
      {"body", {"block", "plate", "lobe", "dome", "tube", "sphere", "organ"}},
      {"regions", {"one", "layer", "half", "inclusion"}},
      {"touched", {"top", "surface", "whole"}},
      {"support", {"bottom", "sides", "end"}},
      {"element", {"tet4", "smoothed_tet4", "tet10", "hex8", "hex20", "mean_dilatation_hex8"}},
      {"law",
       {"linear", "transversely_isotropic", "orthotropic", "corotational", "st_venant_kirchhoff", "neo_hookean",
        "neo_hookean_logarithmic", "neo_hookean_isochoric", "mooney_rivlin", "fibre_reinforced", "viscoelastic"}},
      {"solver",
       {"condensed", "condensed_float", "condensed_cholesky", "condensed_cg", "sparse_cholesky", "cg", "matrix_free_cg",
        "inverse", "stiffening", "newton", "corotated_cg", "quasi_newton", "quasi_newton_float", "central_difference",
        "semi_implicit_euler", "cut_condensed", "cut_quasi_newton", "cut_quasi_newton_float"}},
      {"load", {"none", "gravity", "pressure", "traction", "body", "point", "swelling"}},
      {"pose", {"identity", "rotated"}},
      {"member", {"alone", "group", "pair", "adaptor"}},
      {"kind", {"sphere", "capsule", "plate", "blade"}},
      {"path", {"press", "hold", "slide", "twist", "leap", "lost", "frozen"}}};
  static const std::vector<std::string> none;
  const auto found = words.find(name);
  return found == words.end() ? none : found->second;
}

std::string to_text(const Scene& scene) {
  std::string text;
  const Scene plain;
  write(text, "", [&](bool of_plain, auto&& f) { visit(of_plain ? plain : scene, f); });
  const ToolValue plain_tool;
  for (std::size_t t = 0; t < scene.tools.size(); ++t) {
    const std::string prefix = "tool " + std::to_string(t) + " ";
    text += prefix + "kind " + scene.tools[t].kind + "\n";
    ToolValue of_kind = plain_tool;
    of_kind.kind = scene.tools[t].kind;
    write(text, prefix, [&](bool of_plain, auto&& f) { visit_tool(of_plain ? of_kind : scene.tools[t], f); });
  }
  return text;
}

Scene from_text(std::istream& in) {
  Scene scene;
  scene.tools.clear();
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) try {
      std::istringstream words(line);
      std::string name, value;
      if (!(words >> name) || name[0] == '#') continue;
      std::size_t tool = 0;
      const bool of_tool = name == "tool";
      if (of_tool && !(words >> tool >> name)) throw std::runtime_error("no number of a tool");
      if (!(words >> value)) throw std::runtime_error("no value");
      if (!of_tool) {
        set(name, value, [&](auto&& f) { visit(scene, f); });
        continue;
      }
      if (tool > scene.tools.size()) throw std::runtime_error("a tool before this one is missing");
      if (tool == scene.tools.size()) scene.tools.emplace_back();
      set(name, value, [&](auto&& f) { visit_tool(scene.tools[tool], f); });
    } catch (const std::runtime_error& error) {
      throw std::runtime_error("line " + std::to_string(number) + ": " + error.what());
    }
  return scene;
}

}  // namespace cross
