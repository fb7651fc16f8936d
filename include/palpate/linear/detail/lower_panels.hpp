// Memory layout of a dense lower triangle.
#pragma once

#include <palpate/core/types.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The leading columns of a lower triangle, divided into panels of `width` columns that each start at their first
/// diagonal entry; column major inside a panel. Wastes half a panel per column, whereas a full square wastes half of
/// its entries.
struct LowerPanels {
  static constexpr Index width = 144;  ///< a multiple of every tile height and width
  static constexpr Index alignment = 8;

  Index height = 0;   ///< rows, a multiple of `alignment`
  Index columns = 0;  ///< stored columns

  static constexpr Index padded(Index rows) noexcept { return (rows + alignment - 1) / alignment * alignment; }
  static LowerPanels of(Index rows, Index columns) noexcept { return {padded(rows), columns}; }

  Index panels() const noexcept { return (columns + width - 1) / width; }
  Index panel_begin(Index p) const noexcept { return p * width; }
  Index panel_width(Index p) const noexcept { return std::min(width, columns - p * width); }
  /// Rows of a panel, equal to the distance between its columns in memory.
  Index stride(Index p) const noexcept { return height - p * width; }
  /// Offset of the first entry of a panel.
  Index offset(Index p) const noexcept { return width * (p * height - width * (p * (p - 1) / 2)); }
  /// Total number of doubles.
  Index size() const noexcept {
    const Index last = columns / width;
    return offset(last) + (columns - last * width) * stride(last);
  }
  /// Offset of entry (row, column); the row must not be above the panel.
  Index at(Index row, Index column) const noexcept {
    const Index p = column / width, begin = p * width;
    return offset(p) + (column - begin) * (height - begin) + row - begin;
  }
};

}}}  // namespace palpate::detail
