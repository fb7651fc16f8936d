// Finds nodes and elements by any ids, and reports lines that were read before.
#pragma once

#include <palpate/io/detail/sorting.hpp>
#include <palpate/io/detail/text_reader.hpp>

#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// Refuses what was found in an earlier line of the file.
[[noreturn]] void refuse_at(const TextReader& in, Index line, SetupErrorKind kind, const Pieces& expected,
                            const Pieces& found, const Pieces& hint = {});

/// Positions of nodes or elements by their ids, which may be any.
class IdTable {
 public:
  /// Refuses an id that occurs twice; `what` is "node" or "element". O(n log n) unless the ids ascend.
  IdTable(std::span<const Index> ids, std::span<const Index> lines, std::string_view what, const TextReader& in);

  /// The position of an id, -1 if there is none.
  Index find(Index id) const noexcept;

  /// Ids and positions, ascending, from the first id that is not less than `id`.
  std::span<const Ranked> from(Index id) const noexcept;

  std::string_view what;

 private:
  std::vector<Ranked> sorted_;
};

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/id_table.ipp>
#endif
