// Definitions of vtk_numbers.hpp.
#pragma once

#include <palpate/io/detail/vtk_numbers.hpp>

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
  if (is_binary) return binary_real(in_, layout_of(type), what);
  in_.need_more(what);
  return in_.real(what);
}

PALPATE_INLINE Index NumberStream::count(std::string_view what, Index numbers) {
  return in_.count(what, numbers * (is_binary ? 4 : 1));
}

PALPATE_INLINE void NumberStream::skip(const NumberType& type, Index count) {
  const auto left = static_cast<Index>(in_.bytes_left());
  if (count > (is_binary ? left * 8 / type.bits : left))
    in_.refuse(SetupErrorKind::count_too_large, {count, " numbers"}, {left, " bytes to the end of the file"});
  if (is_binary) in_.take(static_cast<std::size_t>((count * type.bits + 7) / 8), "numbers");
  for (Index i = 0; !is_binary && i < count; ++i) {
    in_.need_more("a number");
    in_.token();
  }
  end("the numbers");
}

}}}  // namespace palpate::PALPATE_ABI::io::vtk
