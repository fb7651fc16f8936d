// Whole numbers of the cells of a file that may be labels of tissues.
#pragma once

#include <palpate/io/file_mesh.hpp>

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

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/labels.ipp>
#endif
