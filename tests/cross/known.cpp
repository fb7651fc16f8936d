#include "known.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <type_traits>

namespace cross {

namespace {

bool holds(const std::string& text, double number, const Known::Condition& c) {
  if (c.relation == "=") return text.empty() ? number == std::strtod(c.value.c_str(), nullptr) : text == c.value;
  if (c.relation == "!=") return text.empty() ? number != std::strtod(c.value.c_str(), nullptr) : text != c.value;
  const double limit = std::strtod(c.value.c_str(), nullptr);
  return c.relation == "<" ? number < limit : number > limit;
}

/// Whether a value of a scene, of one of its tools, or of a finding meets a condition.
bool is_met(const Scene& s, const Finding& f, const Known::Condition& c) {
  bool met = false, found = false;
  const auto look = [&](const char* name, const auto& value) {
    if (c.name != name) return;
    found = true;
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::string>)
      met = met || holds(value, 0.0, c);
    else
      met = met || holds("", static_cast<double>(value), c);
  };
  visit(s, look);
  for (const ToolValue& t : s.tools) visit_tool(t, look);
  double smallest = s.tools[0].radius;
  for (const ToolValue& t : s.tools) smallest = std::min(smallest, t.radius);
  look("facets", s.edge / smallest);
  look("tools", static_cast<double>(s.tools.size()));
  look("moves", moves(s.solver) ? 1.0 : 0.0);
  look("is_cut", is_cut(s) ? 1.0 : 0.0);
  look("torques", f.of_torques ? 1.0 : 0.0);
  look("part", f.expected != 0.0 ? std::abs(f.found / f.expected) : 0.0);
  if (!found) throw std::runtime_error("there is no value \"" + c.name + "\"");
  return met;
}

std::string after(const std::string& line, const std::string& start) {
  return line.starts_with(start) ? line.substr(start.size()) : std::string();
}

Known read_one(const std::filesystem::path& path) {
  std::ifstream in(path);
  Known known;
  known.file = path.filename().string();
  for (std::string line; std::getline(in, line);) {
    if (const std::string text = after(line, "# oracle: "); !text.empty()) known.oracles.push_back(text);
    if (const std::string text = after(line, "# cause: "); !text.empty()) known.cause = text;
    const std::string text = after(line, "# where: ");
    Known::Condition c;
    if (std::istringstream words(text); words >> c.name >> c.relation >> c.value) known.where.push_back(c);
  }
  in.clear();
  in.seekg(0);
  known.scene = from_text(in);
  if (known.oracles.empty() || known.cause.empty()) throw std::runtime_error("no oracle or no cause");
  return known;
}

}  // namespace

bool Known::matches(const Scene& s, const Finding& f) const {
  return std::find(oracles.begin(), oracles.end(), f.oracle) != oracles.end() &&
         std::all_of(where.begin(), where.end(), [&](const Condition& c) { return is_met(s, f, c); });
}

std::vector<Known> read_known(const std::string& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".scene") paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<Known> all;
  for (const auto& path : paths) try {
      all.push_back(read_one(path));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(path.string() + ": " + error.what());
    }
  return all;
}

}  // namespace cross
