// Definitions of vtk_numbers.hpp.
#pragma once

#include <palpate/io/detail/vtk_numbers.hpp>

#include <limits>

namespace palpate { inline namespace PALPATE_ABI { namespace io::vtk {

namespace detail {

constexpr char small_letter(char c) noexcept {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

}  // namespace detail

PALPATE_COLD PALPATE_INLINE std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = detail::small_letter(c);
  return out;
}

PALPATE_COLD PALPATE_INLINE bool same_word(std::string_view a, std::string_view b) noexcept {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (detail::small_letter(a[i]) != detail::small_letter(b[i])) return false;
  return true;
}

PALPATE_INLINE BinaryLayout NumberStream::layout_of(const NumberType& type) {
  return {type.bits < 8 ? 64 : type.bits, type.kind == NumberType::integer, std::endian::native == std::endian::little};
}

PALPATE_COLD PALPATE_INLINE const NumberType& NumberStream::read_type() {
  const std::string_view word = in_.token();
  for (const NumberType& t : number_types)
    if (same_word(t.name, word)) return t;
  in_.refuse(SetupErrorKind::bad_file, "a type of numbers such as double", in_quotes(lower(word)));
}

PALPATE_INLINE Index NumberStream::integer(const NumberType& type, std::string_view what, Index low, Index high) {
  if (is_binary) return binary_integer(in_, layout_of(type), what, low, high, SetupErrorKind::index_out_of_range);
  in_.need_more(what);
  return in_.integer(what, low, high);
}

PALPATE_INLINE double NumberStream::real(const NumberType& type, std::string_view what) {
  if (type.kind != NumberType::real) {
    constexpr Index limit = std::numeric_limits<Index>::max();
    return static_cast<double>(integer(type, what, -limit, limit));
  }
  if (is_binary) return binary_real(in_, layout_of(type), what);
  in_.need_more(what);
  return in_.real(what);
}

PALPATE_INLINE double NumberStream::any_number(const NumberType& type) {
  if (is_binary) return any_binary_number(in_, layout_of(type), type.kind == NumberType::real);
  in_.need_more("a number");
  return any_decimal(in_.token());
}

PALPATE_INLINE Index NumberStream::count(std::string_view what, Index numbers) {
  return in_.count(what, numbers * (is_binary ? 4 : 1));
}

/// The two highest bits of the first byte are 3, 2, 1 or 0 for a length in 1, 2, 4 or 8 bytes, of which they are part
/// (vtkDataWriter).
PALPATE_COLD PALPATE_INLINE void NumberStream::skip_string() {
  if (!is_binary) {
    if (!in_.next_raw_line()) in_.refuse(SetupErrorKind::bad_file, "a string", "the end of the file");
    return;
  }
  std::uint64_t length = from_bytes<std::uint8_t>(in_.take(1, "a string"), false);
  const std::size_t more = (std::size_t{1} << (3U - length / 64U)) - 1U;
  length %= 64U;
  for (const char c : in_.take(more, "the length of a string")) length = length << 8U | static_cast<unsigned char>(c);
  in_.take(static_cast<std::size_t>(length), "a string");
}

PALPATE_COLD PALPATE_INLINE void NumberStream::check_fits(const NumberType& type, Index count) const {
  const auto left = static_cast<Index>(in_.bytes_left());
  if (count > (is_binary ? left * 8 / type.bits : left))
    in_.refuse(SetupErrorKind::count_too_large, {count, " numbers"}, {left, " bytes to the end of the file"});
}

PALPATE_INLINE void NumberStream::skip(const NumberType& type, Index count) {
  check_fits(type, count);
  if (type.kind == NumberType::text) {
    for (Index i = 0; i < count; ++i) skip_string();
    return;
  }
  if (is_binary) in_.take(static_cast<std::size_t>((count * type.bits + 7) / 8), "numbers");
  for (Index i = 0; !is_binary && i < count; ++i) {
    in_.need_more("a number");
    in_.token();
  }
  end("the numbers");
}

}}}  // namespace palpate::PALPATE_ABI::io::vtk
