// Definitions of setup_error.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void SetupProblem::set_ids(std::span<const std::int64_t> all, SetupIds of) {
  ids_of = of;
  count = static_cast<std::int64_t>(all.size());
  ids.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), max_ids)));
}

PALPATE_INLINE std::string number(double value) {
  std::array<char, 40> text{};
#if defined(__cpp_lib_to_chars)
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 9).ptr;
  return {text.data(), end};
#else
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return text.data();
#endif
}

namespace detail {

inline const char* id_label(const SetupProblem& p) noexcept {
  const bool one = p.ids.size() == 1 && p.count <= 1;
  if (p.ids_of == SetupIds::nodes) return one ? "node" : "nodes";
  if (p.ids_of == SetupIds::elements) return one ? "element" : "elements";
  return "ids";
}

/// The innermost translation of this thread; null if there is none.
inline const OriginalIds*& active_ids() noexcept {
  static thread_local const OriginalIds* ids = nullptr;
  return ids;
}

inline void translate_ids(std::vector<std::int64_t>& ids, SetupIds of) noexcept {
  const OriginalIds* original = active_ids();
  if (original == nullptr || of == SetupIds::others) return;
  const std::vector<std::int64_t>& origin = of == SetupIds::nodes ? original->nodes : original->elements;
  const auto size = static_cast<std::int64_t>(origin.size());
  for (std::int64_t& id : ids)
    if (id >= 0 && id < size) id = origin[static_cast<std::size_t>(id)];
}

}  // namespace detail

PALPATE_INLINE ScopedIdTranslation::ScopedIdTranslation(const OriginalIds& ids) noexcept
    : outer_(std::exchange(detail::active_ids(), &ids)) {}
PALPATE_INLINE ScopedIdTranslation::~ScopedIdTranslation() {
  detail::active_ids() = outer_;
}

PALPATE_INLINE OriginalIds translated(OriginalIds part) {
  detail::translate_ids(part.nodes, SetupIds::nodes);
  detail::translate_ids(part.elements, SetupIds::elements);
  return part;
}

PALPATE_INLINE std::string describe(const SetupProblem& p) {
  std::string text(to_string(p.kind));
  text += ": " + p.what;
  if (!p.ids.empty()) {
    text += std::string(" [") + detail::id_label(p);
    for (auto id : p.ids) text += ' ' + std::to_string(id);
    if (p.count > static_cast<std::int64_t>(p.ids.size())) text += " ... " + std::to_string(p.count) + " in all";
    text += ']';
  }
  if (!p.hint.empty()) text += ". " + p.hint;
  return text;
}

PALPATE_INLINE SetupFailureHandler& setup_failure_handler() {
  static SetupFailureHandler handler = nullptr;
  return handler;
}

PALPATE_INLINE void raise(SetupProblem problem) {
  detail::translate_ids(problem.ids, problem.ids_of);
#if defined(PALPATE_HAS_EXCEPTIONS)
  throw SetupError(std::move(problem));
#else
  if (setup_failure_handler() != nullptr) setup_failure_handler()(problem);
  std::fprintf(stderr, "palpate: %s\n", describe(problem).c_str());
  std::abort();
#endif
}

PALPATE_INLINE void raise(SetupErrorKind kind, std::string what, std::string hint) {
  SetupProblem p;
  p.kind = kind;
  p.what = std::move(what);
  p.hint = std::move(hint);
  raise(std::move(p));
}

namespace detail {

PALPATE_INLINE void raise_at(SetupIds of, std::int64_t id, SetupErrorKind kind, std::string what, std::string hint) {
  SetupProblem p;
  p.kind = kind;
  p.what = std::move(what);
  p.hint = std::move(hint);
  p.set_ids({&id, 1}, of);
  raise(std::move(p));
}

}  // namespace detail

}}  // namespace palpate
