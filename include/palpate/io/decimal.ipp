// Definitions of decimal.hpp.
#pragma once

#include <palpate/io/decimal.hpp>

#include <array>
#include <charconv>
#include <version>

#ifndef __cpp_lib_to_chars  // an older libc++ converts integers only
#include <limits>
#include <locale>
#include <sstream>
#endif

namespace palpate { inline namespace PALPATE_ABI { namespace io {

PALPATE_INLINE std::errc parse_decimal(std::string_view token, double& value) {
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

PALPATE_INLINE std::string to_decimal(double value) {
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

}}}  // namespace palpate::PALPATE_ABI::io
