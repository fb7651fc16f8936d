// The tools of a session.
#pragma once

#include <palpate/contact/blade_tool.hpp>
#include <palpate/contact/capsule_tool.hpp>
#include <palpate/contact/convex_tool.hpp>

#include <concepts>
#include <initializer_list>
#include <variant>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A tool of any kind. A blade needs a tissue that can be cut.
using Tool = std::variant<SphereTool, CapsuleTool, BladeTool, ConvexTool>;

template <class T>
concept AnyTool = std::same_as<T, SphereTool> || std::same_as<T, CapsuleTool> || std::same_as<T, BladeTool> ||
    std::same_as<T, ConvexTool> || std::same_as<T, Tool>;

/// Tools in the order of their states and forces: one tool, a list in braces of tools of any kinds, or a vector.
class ToolList {
 public:
  ToolList(const AnyTool auto& tool) { tools_.emplace_back(tool); }  // NOLINT(google-explicit-constructor)
  ToolList(std::initializer_list<Tool> tools) : tools_(tools) {}
  template <AnyTool T>
  ToolList(const std::vector<T>& tools)  // NOLINT(google-explicit-constructor)
      : tools_(tools.begin(), tools.end()) {}

  std::size_t size() const noexcept { return tools_.size(); }
  const Tool& operator[](std::size_t i) const noexcept { return tools_[i]; }
  auto begin() const noexcept { return tools_.begin(); }
  auto end() const noexcept { return tools_.end(); }

 private:
  std::vector<Tool> tools_;
};

}}  // namespace palpate
