// The tools of a session.
#pragma once

#include <palpate/contact/capsule_tool.hpp>

#include <concepts>
#include <initializer_list>
#include <variant>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A tool of any kind.
using Tool = std::variant<SphereTool, CapsuleTool>;

/// Tools in the order of their states and forces: one tool, a list in braces of tools of any kinds, or a vector.
class ToolList {
 public:
  template <class T>
  requires std::convertible_to<const T&, Tool> ToolList(const T& tool)  // NOLINT(google-explicit-constructor)
      : tools_{Tool(tool)} {}
  ToolList(std::initializer_list<Tool> tools) : tools_(tools) {}
  template <class T>
  requires std::convertible_to<const T&, Tool> ToolList(
      const std::vector<T>& tools)  // NOLINT(google-explicit-constructor)
      : tools_(tools.begin(), tools.end()) {}

  std::size_t size() const noexcept { return tools_.size(); }
  const Tool& operator[](std::size_t i) const noexcept { return tools_[i]; }
  auto begin() const noexcept { return tools_.begin(); }
  auto end() const noexcept { return tools_.end(); }

 private:
  std::vector<Tool> tools_;
};

}}  // namespace palpate
