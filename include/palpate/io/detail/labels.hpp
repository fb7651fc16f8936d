// Whole numbers of the cells of a file that may be labels of tissues.
#pragma once

#include <palpate/io/file_mesh.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// The different numbers of one array of cells.
class LabelCount {
 public:
  void add(double number);

  /// Whether all are whole and few are different: at least two, at most `most`, and each at two cells on average unless
  /// there are only two. Ids, counters and physical quantities are none.
  bool looks_like_labels() const noexcept;

  Index different() const noexcept { return static_cast<Index>(numbers_.size()); }

  static constexpr std::size_t most = 100;

 private:
  std::vector<double> numbers_;  ///< ascending; one more than `most` at most
  Index count_ = 0;
  bool is_whole_ = true;
};

/// Whether a number of an array can be a label.
bool is_label(double number) noexcept;

/// An array that looks like labels and was not used.
struct UnusedLabels {
  std::string name;
  Index different;
};

/// Adds a note that lists the arrays and states how to use the first.
void note_unused_labels(std::span<const UnusedLabels> arrays, FileMesh& mesh);

/// Refuses an option `labels` where a format has no arrays of cells; an empty one is none.
void refuse_labels(std::string_view labels, const std::string& name);

inline bool is_label(double number) noexcept {
  return std::abs(number) <= static_cast<double>(max_int) && number == std::floor(number);
}

inline void LabelCount::add(double number) {
  ++count_;
  if (!is_whole_ || numbers_.size() > most) return;
  is_whole_ = is_label(number);
  const auto at = std::lower_bound(numbers_.begin(), numbers_.end(), number);
  if (is_whole_ && (at == numbers_.end() || *at != number)) numbers_.insert(at, number);
}

inline bool LabelCount::looks_like_labels() const noexcept {
  const Index n = different();
  return is_whole_ && n >= 2 && n <= static_cast<Index>(most) && (n == 2 || 2 * n <= count_);
}

PALPATE_COLD inline void note_unused_labels(std::span<const UnusedLabels> arrays, FileMesh& mesh) {
  if (arrays.empty()) return;
  std::string list;
  for (const UnusedLabels& array : arrays)
    append(list, {list.empty() ? "'" : ", '", array.name, "' (", array.different, " different numbers)"});
  mesh.notes.push_back(joined({list, arrays.size() == 1 ? " looks" : " look", " like labels of tissues and ",
                               arrays.size() == 1 ? "was" : "were", " not used: {.labels = \"", arrays.front().name,
                               "\"} in ReadOptions makes ", arrays.size() == 1 ? "it" : "the first", " the regions"}));
}

PALPATE_COLD inline void refuse_labels(std::string_view labels, const std::string& name) {
  if (labels.empty()) return;
  refuse(SetupErrorKind::bad_argument, {name, ": labels ", in_quotes(labels), " in a format without arrays of cells"},
         "Leave the option `labels` out: only VTK, VTU and Gmsh files need it");
}

}}}  // namespace palpate::PALPATE_ABI::io
