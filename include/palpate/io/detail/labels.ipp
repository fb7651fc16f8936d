// Definitions of labels.hpp.
#pragma once

#include <palpate/io/detail/labels.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

PALPATE_INLINE bool is_label(double number) noexcept {
  return std::abs(number) <= static_cast<double>(max_int) && number == std::floor(number);
}

PALPATE_INLINE void LabelCount::add(double number) {
  ++count_;
  if (!is_whole_ || numbers_.size() > most) return;
  is_whole_ = is_label(number);
  const auto at = std::lower_bound(numbers_.begin(), numbers_.end(), number);
  if (is_whole_ && (at == numbers_.end() || *at != number)) numbers_.insert(at, number);
}

PALPATE_INLINE bool LabelCount::looks_like_labels() const noexcept {
  const Index n = different();
  return is_whole_ && n >= 2 && n <= static_cast<Index>(most) && (n == 2 || 2 * n <= count_);
}

PALPATE_COLD PALPATE_INLINE void note_unused_labels(std::span<const UnusedLabels> arrays, FileMesh& mesh) {
  if (arrays.empty()) return;
  std::string list;
  for (const UnusedLabels& array : arrays)
    append(list, {list.empty() ? "'" : ", '", array.name, "' (", array.different, " different numbers)"});
  mesh.notes.push_back(joined({list, arrays.size() == 1 ? " looks" : " look", " like labels of tissues and ",
                               arrays.size() == 1 ? "was" : "were", " not used: {.labels = \"", arrays.front().name,
                               "\"} in ReadOptions makes ", arrays.size() == 1 ? "it" : "the first", " the regions"}));
}

PALPATE_COLD PALPATE_INLINE void refuse_labels(std::string_view labels, const std::string& name) {
  if (labels.empty()) return;
  refuse(SetupErrorKind::bad_argument, {name, ": labels ", in_quotes(labels), " in a format without arrays of cells"},
         "Leave the option `labels` out: only VTK, VTU and Gmsh files need it");
}

}}}  // namespace palpate::PALPATE_ABI::io
