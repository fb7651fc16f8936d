// Conversion of doubles to text and back, with a decimal point in every locale.
#pragma once

#include <palpate/core/config.hpp>

#include <string>
#include <string_view>
#include <system_error>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// Sets `value` to the double that the whole of `token` represents. Returns invalid_argument if it is not a number
/// (hexadecimal numbers and decimal commas are not accepted), result_out_of_range if it is too large for a double. A
/// number too small for a double is zero, with its sign. "nan" and "inf" may be accepted.
std::errc parse_decimal(std::string_view token, double& value);

/// A text that reads back as exactly `value`; the shortest one if the standard library supports it.
std::string to_decimal(double value);

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/decimal.ipp>
#endif
