// Doubles as text and back, with a decimal point whatever the locale of the process.
#pragma once

#include <palpate/core/config.hpp>

#include <string>
#include <string_view>
#include <system_error>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// Sets `value` to the double that the whole of `token` spells. invalid_argument when it is no number (hexadecimal and
/// decimal commas are none), result_out_of_range when no double is near it. "nan" and "inf" may be accepted.
std::errc parse_decimal(std::string_view token, double& value);

/// A text that reads back as exactly `value`; the shortest one where the standard library can.
std::string to_decimal(double value);

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/decimal.ipp>
#endif
