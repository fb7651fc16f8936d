// Definitions of text_reader.hpp.
#pragma once

#include <palpate/io/decimal.hpp>
#include <palpate/io/detail/text_reader.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

PALPATE_COLD PALPATE_INLINE std::string place_text(const std::string& file, Index place) {
  return joined({file, place < 0 ? ":byte " : ":", place < 0 ? -place : place});
}

PALPATE_COLD PALPATE_INLINE TextReader::TextReader(std::string_view text, std::string name, TextSyntax syntax)
    : text_(text), name_(std::move(name)), syntax_(syntax) {
  if (text_.starts_with("\xEF\xBB\xBF")) next_ = 3;
}

PALPATE_INLINE void TextReader::restart(std::string_view text, Index first_line) {
  text_ = text;
  line_ = rest_ = {};
  next_ = 0;
  line_number_ = first_line - 1;
}

PALPATE_INLINE bool TextReader::next_raw_line() {
  line_ = rest_ = {};
  if (next_ >= text_.size()) return false;
  const std::size_t end = std::min(text_.find('\n', next_), text_.size());
  const std::string_view whole = text_.substr(next_, end - next_);
  line_ = rest_ = trim(syntax_.comment == '\0' ? whole : whole.substr(0, whole.find(syntax_.comment)));
  next_ = end + 1;
  ++line_number_;
  return true;
}

PALPATE_INLINE bool TextReader::next_line() {
  while (next_raw_line())
    if (!line_.empty()) return true;
  return false;
}

PALPATE_INLINE void TextReader::need_line(std::string_view expected) {
  if (!next_line()) refuse(SetupErrorKind::bad_file, expected, "the end of the file");
}

PALPATE_INLINE void TextReader::need_more(std::string_view expected) {
  if (rest().empty()) need_line(expected);
}

PALPATE_INLINE std::string_view TextReader::take(std::size_t bytes, std::string_view what) {
  is_binary_ = true;
  if (bytes > bytes_left())
    refuse(SetupErrorKind::bad_file, what, {"the end of the file after ", bytes_left(), " of ", bytes, " bytes"});
  const std::string_view raw = text_.substr(next_, bytes);
  next_ += bytes;
  line_ = rest_ = {};
  return raw;
}

PALPATE_COLD PALPATE_INLINE void TextReader::skip_to(const std::string& mark) {
  const auto ends_line = [&](std::size_t at) {
    std::size_t end = at + mark.size();
    while (end < text_.size() && is_blank(text_[end])) ++end;
    return end == text_.size() || text_[end] == '\n';
  };
  std::size_t at = text_.find(mark, next_);
  while (at != text_.npos && !ends_line(at)) at = text_.find(mark, at + 1);
  if (at == text_.npos) refuse(SetupErrorKind::bad_file, mark, "the end of the file");
  next_ = at;
  next_raw_line();
}

PALPATE_COLD PALPATE_INLINE void TextReader::need_last_line_end() const {
  if (!has_last_line_end())
    refuse(SetupErrorKind::bad_file, "a line end after the last line", "the end of the file",
           "If the file is whole, add an empty line");
}

PALPATE_INLINE std::string_view TextReader::token() {
  rest_ = trim(rest_);
  std::size_t end = 0;
  if (syntax_.fields) {
    end = std::min(rest_.find(','), rest_.size());
    const std::string_view field = trim(rest_.substr(0, end));
    const bool has_comma = end < rest_.size();
    rest_.remove_prefix(has_comma ? end + 1 : end);
    return field.empty() && has_comma ? std::string_view(",") : field;
  }
  while (end < rest_.size() && !is_blank(rest_[end])) ++end;
  const std::string_view word = rest_.substr(0, end);
  rest_.remove_prefix(end);
  return word;
}

PALPATE_INLINE Index TextReader::integer(std::string_view what, Index low, Index high, SetupErrorKind kind) {
  const std::string_view word = token();
  Index value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc::invalid_argument || end != word.data() + word.size())
    refuse(SetupErrorKind::bad_file, what, in_quotes(word));
  if (error == std::errc::result_out_of_range || value < low || value > high)
    refuse_range(kind, what, low, high, in_quotes(word));
  return value;
}

PALPATE_INLINE Index TextReader::count(std::string_view what, Index bytes_each) {
  return integer(what, 0, static_cast<Index>(bytes_left()) / bytes_each, SetupErrorKind::count_too_large);
}

PALPATE_INLINE double TextReader::real(std::string_view what) {
  std::string_view word = token();
  const std::string_view whole = word;
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  std::array<char, 64> fortran{};
  if (const std::size_t d = syntax_.fields ? word.find_first_of("dD") : word.npos;
      d < word.size() && word.size() < 64) {
    word.copy(fortran.data(), word.size());
    fortran[d] = 'e';
    word = {fortran.data(), word.size()};
  }
  double value = 0.0;
  const std::errc error = parse_decimal(word, value);
  if (error == std::errc::invalid_argument) refuse(SetupErrorKind::bad_file, what, in_quotes(whole));
  if (error != std::errc{} || !std::isfinite(value))
    refuse(SetupErrorKind::non_finite, {what, " in the range of a double"}, in_quotes(whole));
  return value;
}

PALPATE_INLINE void TextReader::end_line(std::string_view what) {
  const std::string_view word = token();
  if (!word.empty()) refuse(SetupErrorKind::bad_file, {"the end of the line after ", what}, in_quotes(word));
}

PALPATE_COLD PALPATE_INLINE void TextReader::refuse(SetupErrorKind kind, const Pieces& expected, const Pieces& found,
                                                    const Pieces& hint) const {
  io::refuse(kind, {place_text(name_, place()), ": expected ", joined(expected), ", found ", joined(found)},
             joined(hint));
}

PALPATE_COLD PALPATE_INLINE void TextReader::refuse_range(SetupErrorKind kind, std::string_view what, Index low,
                                                          Index high, const Pieces& found) const {
  if (high == std::numeric_limits<Index>::max()) refuse(kind, {what, " of at least ", low}, found);
  refuse(kind, {what, " between ", low, " and ", high}, found);
}

}}}  // namespace palpate::PALPATE_ABI::io
