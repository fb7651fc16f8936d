// The check of the number of a tool or tissue.
#pragma once

#include <palpate/core/setup_error.hpp>

#include <cstddef>
#include <string>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Throws index_out_of_range unless a servo has that many.
inline void require_index(std::size_t index, std::size_t count, const char* what) {
  if (index < count) return;
  raise(SetupErrorKind::index_out_of_range, std::string("the servo has ") + std::to_string(count) + ' ' + what +
                                                (count == 1 ? "" : "s") + ", not number " + std::to_string(index));
}

}}}  // namespace palpate::detail
