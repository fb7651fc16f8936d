// Definitions of decimal.hpp.
#pragma once

#include <palpate/io/decimal.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <version>

#ifndef __cpp_lib_to_chars  // an older libc++ converts integers only
#include <limits>
#include <locale>
#include <sstream>
#endif

namespace palpate { inline namespace PALPATE_ABI { namespace io {

namespace detail {

/// Whether a number outside the range of a double is too small, not too large: by the power of ten of its first digit.
PALPATE_COLD inline bool is_too_small(std::string_view number) {
  const std::size_t e = std::min(number.find_first_of("eE"), number.size());
  const std::string_view digits = number.substr(0, e), exponent = number.substr(std::min(e + 1, number.size()));
  const std::size_t point = std::min(digits.find('.'), digits.size()), first = digits.find_first_of("123456789");
  if (first == digits.npos) return true;
  const std::int64_t power = static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first);
  std::int32_t more = 0;
  const std::size_t plus = exponent.starts_with('+') ? 1 : 0;
  if (std::from_chars(exponent.data() + plus, exponent.data() + exponent.size(), more).ec ==
      std::errc::result_out_of_range)
    return exponent.front() == '-';
  return power + more < 0;
}

}  // namespace detail

PALPATE_INLINE std::errc parse_decimal(std::string_view token, double& value) {
#ifdef __cpp_lib_to_chars
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (end != token.data() + token.size()) return std::errc::invalid_argument;
  if (error == std::errc::result_out_of_range && detail::is_too_small(token)) {
    value = token.front() == '-' ? -0.0 : 0.0;
    return {};
  }
  return error;
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
