// Doubles as text and back, with a decimal point whatever the locale of the process.
#pragma once

#include <palpate/core/config.hpp>

#include <array>
#include <charconv>
#include <string>
#include <string_view>
#include <system_error>
#include <version>

#ifndef __cpp_lib_to_chars  // an older libc++ converts integers only
#include <limits>
#include <locale>
#include <sstream>
#endif

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// Sets `value` to the double that the whole of `token` spells. invalid_argument when it is no number (hexadecimal and
/// decimal commas are none), result_out_of_range when no double is near it. "nan" and "inf" may be accepted.
inline std::errc parse_decimal(std::string_view token, double& value) {
#ifdef __cpp_lib_to_chars
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  return error != std::errc{} || end == token.data() + token.size() ? error : std::errc::invalid_argument;
#else
  if (token.find_first_of("xX") != token.npos) return std::errc::invalid_argument;
  std::istringstream stream{std::string(token)};
  stream.imbue(std::locale::classic());
  stream >> value;
  return stream && stream.peek() == std::istringstream::traits_type::eof() ? std::errc{} : std::errc::invalid_argument;
#endif
}

/// A text that reads back as exactly `value`; the shortest one where the standard library can.
inline std::string to_decimal(double value) {
#ifdef __cpp_lib_to_chars
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
#else
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream.precision(std::numeric_limits<double>::max_digits10);
  stream << value;
  return stream.str();
#endif
}

}}}  // namespace palpate::io
