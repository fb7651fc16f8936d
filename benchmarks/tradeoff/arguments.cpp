#include "arguments.hpp"

#include <palpate/core/setup_error.hpp>

#include <fstream>
#include <functional>
#include <map>
#include <set>

#include "patches.hpp"

namespace tradeoff {
namespace {

using namespace palpate;

[[noreturn]] void refuse(const std::string& what, const std::string& hint = {}) {
  raise(SetupErrorKind::bad_argument, what, hint);
}

double number_in(const std::string& option, const std::string& text, double above, double below) {
  const auto value = number_of(text);
  if (!value) refuse("'" + option + " " + text + "': this is not a number");
  if (!(*value > above && *value < below))
    refuse("'" + option + " " + text + "' is out of range",
           "Give a number above " + number(above) + (below < infinity ? " and below " + number(below) : ""));
  return *value;
}

void require_mesh(const Arguments& a) {
  const SceneOptions& scene = a.scene;
  const std::set<std::string> kinds{"palpate", "retract", "grasp"};
  if (!kinds.contains(scene.kind))
    refuse("there is no scene '" + scene.kind + "'", "There are palpate, retract and grasp");
  if (scene.mesh.empty()) {
    if (!scene.constrained.empty() || !scene.touched.empty())
      refuse("--fix and --touch are parts of a mesh, and no mesh is given",
             "Name its file: tradeoff liver.msh --fix ...");
    return;
  }
  if (scene.kind != "palpate")
    refuse("the scene '" + scene.kind + "' supports only the organ of palpate", "Give no mesh, or --scene palpate");
  if (!std::ifstream(scene.mesh)) refuse("the file '" + scene.mesh + "' cannot be read");
}

}  // namespace

Arguments parse_arguments(std::span<const std::string> words) {
  Arguments a;
  const auto keep = [](std::string& where) {
    return [&where](const std::string&, const std::string& v) { where = v; };
  };
  const std::map<std::string, std::function<void(const std::string&, const std::string&)>> options{
      {"--fix", keep(a.scene.constrained)},
      {"--touch", keep(a.scene.touched)},
      {"--scene", keep(a.scene.kind)},
      {"--out", keep(a.out)},
      {"--only", keep(a.only)},
      {"--docs", keep(a.document)},
      {"--budget-us", [&](auto& o, auto& v) { a.budget = 1e-6 * number_in(o, v, 0.0, infinity); }},
      {"--edge", [&](auto& o, auto& v) { a.edge = number_in(o, v, 0.02, 2.0); }},
      {"--youngs", [&](auto& o, auto& v) { a.scene.youngs_modulus = number_in(o, v, 0.0, infinity); }},
      {"--poisson", [&](auto& o, auto& v) { a.scene.poisson_ratio = number_in(o, v, -1.0, 0.5); }}};
  std::set<std::string> seen;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word.starts_with("--") && !seen.insert(word).second) refuse("'" + word + "' is given twice");
    if (const auto option = options.find(word); option != options.end()) {
      if (++i == words.size() || words[i].empty() || words[i].starts_with("--")) refuse("'" + word + "' needs a value");
      option->second(word, words[i]);
    } else if (word == "--full") {
      a.full = true;
    } else if (word.starts_with("--")) {
      std::string known = "--full";
      for (const auto& entry : options) known += ' ' + entry.first;
      refuse("there is no option '" + word + "'", "There are " + known);
    } else if (a.scene.mesh.empty()) {
      a.scene.mesh = word;
    } else {
      refuse("'" + word + "' is a second mesh after '" + a.scene.mesh + "'", "Put a selection with spaces in quotes");
    }
  }
  require_mesh(a);
  return a;
}

}  // namespace tradeoff
