// Where the entries of a dense lower triangle lie in memory.
#pragma once

#include <palpate/core/types.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The leading columns of a lower triangle, cut into panels of `width` columns that each start at their first diagonal
/// entry; column major inside a panel. Wastes half a panel a column where a plain square wastes half of everything.
struct LowerPanels {
  static constexpr Index width = 144;  ///< a multiple of every tile height and width
  static constexpr Index alignment = 8;

  Index height = 0;   ///< rows, a multiple of `alignment`
  Index columns = 0;  ///< columns kept

  static constexpr Index padded(Index rows) noexcept { return (rows + alignment - 1) / alignment * alignment; }
  static LowerPanels of(Index rows, Index columns) noexcept { return {padded(rows), columns}; }

  Index panels() const noexcept { return (columns + width - 1) / width; }
  Index panel_begin(Index p) const noexcept { return p * width; }
  Index panel_width(Index p) const noexcept { return std::min(width, columns - p * width); }
  /// Rows of a panel, which is the distance of its columns in memory.
  Index stride(Index p) const noexcept { return height - p * width; }
  /// Place of the first entry of a panel.
  Index offset(Index p) const noexcept { return width * (p * height - width * (p * (p - 1) / 2)); }
  /// Doubles in all.
  Index size() const noexcept {
    const Index last = columns / width;
    return offset(last) + (columns - last * width) * stride(last);
  }
  /// Place of entry (row, column); the row is not above the panel.
  Index at(Index row, Index column) const noexcept {
    const Index p = column / width, begin = p * width;
    return offset(p) + (column - begin) * (height - begin) + row - begin;
  }
};

}}}  // namespace palpate::detail
