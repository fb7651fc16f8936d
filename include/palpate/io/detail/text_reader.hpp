// Reads numbers and words from a text line by line, and raw bytes between lines; errors report the exact place.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/io/decimal.hpp>
#include <palpate/io/detail/message.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// `file:12` for place 12, `file:byte 345` for place -345: line numbers have no meaning after binary data has begun.
PALPATE_COLD inline std::string location_text(const std::string& file, Index place) {
  return joined({file, place < 0 ? ":byte " : ":", place < 0 ? -place : place});
}

/// Optional separators and comments of a format.
struct TextSyntax {
  char comment = '\0';  ///< the rest of a line from here on is ignored
  bool commas = false;  ///< a comma separates words like a blank
  bool fields = false;  ///< words are the texts between commas; an empty one is ","; exponents may begin with D
};

/// Reads a text that must outlive the reader. Blank lines, tabs, CRLF, a UTF-8 byte order mark and a missing last
/// newline are accepted. Every refusal is a SetupError that reads `name:line: expected ..., found ...`. Allocates only
/// for error messages.
class TextReader {
 public:
  PALPATE_COLD TextReader(std::string_view text, std::string name, TextSyntax syntax = {})
      : text_(text), name_(std::move(name)), syntax_(syntax) {
    if (text_.starts_with("\xEF\xBB\xBF")) next_ = 3;
  }

  /// Reads another part of the same file, which begins in this line; messages contain its lines.
  void restart(std::string_view text, Index first_line);

  /// Moves to the next line, blank or not; false at the end of the text.
  bool next_raw_line();

  /// Moves to the next line that is not blank; false at the end of the text.
  bool next_line() {
    while (next_raw_line())
      if (!line_.empty()) return true;
    return false;
  }

  /// Moves to the next line that is not blank; refuses if there is none.
  void need_line(std::string_view expected) {
    if (!next_line()) refuse(SetupErrorKind::bad_file, expected, "the end of the file");
  }

  /// Moves to the next line that is not blank if the current one has no more words.
  void need_more(std::string_view expected) {
    if (rest().empty()) need_line(expected);
  }

  /// The `bytes` raw bytes after the current line. From here on messages report bytes, not lines.
  std::string_view read_bytes(std::size_t bytes, std::string_view what);

  /// Moves to the end of the next line that ends with `mark`, which becomes the current line, skipping everything
  /// before it: binary data may end without a line end. Refuses if there is none.
  void skip_to(const std::string& mark);

  bool has_last_line_end() const noexcept { return text_.empty() || text_.back() == '\n'; }

  /// Refuses a text whose last line has no line end: if a format has no end mark, the last number may be truncated.
  PALPATE_COLD void need_last_line_end() const {
    if (!has_last_line_end())
      refuse(SetupErrorKind::bad_file, "a line end after the last line", "the end of the file",
             "If the file is whole, add an empty line");
  }

  std::size_t size() const noexcept { return text_.size(); }  ///< total bytes
  std::size_t bytes_left() const noexcept { return next_ < text_.size() ? text_.size() - next_ : 0; }

  /// The current line, or minus the current byte when binary data has begun; see location_text.
  Index location() const noexcept {
    if (is_binary_) return next_ == 0 ? -1 : -static_cast<Index>(next_);
    return line_number_ < 1 ? 1 : line_number_;
  }

  std::string_view line() const noexcept { return line_; }        ///< the current line, trimmed
  std::string_view rest() const noexcept { return trim(rest_); }  ///< the unread rest of it
  const std::string& name() const noexcept { return name_; }

  /// The next word of the current line, empty at its end.
  std::string_view token();

  /// The next word as an integer between `low` and `high`; anything beyond them is refused as `kind`.
  Index integer(std::string_view what, Index low, Index high, SetupErrorKind kind = SetupErrorKind::index_out_of_range);

  /// A count of items that take at least `bytes_each` bytes of the following lines: at most as many as fit in the rest
  /// of the text.
  Index count(std::string_view what, Index bytes_each) {
    return integer(what, 0, static_cast<Index>(bytes_left()) / bytes_each, SetupErrorKind::count_too_large);
  }

  /// The next word as a finite decimal number. Refuses NaN, infinity and overflow as non_finite, hexadecimal and
  /// decimal commas as bad_file. A number too small for a double is zero.
  double real(std::string_view what);

  /// Refuses if the current line contains another word.
  void end_line(std::string_view what) {
    const std::string_view word = token();
    if (!word.empty()) refuse(SetupErrorKind::bad_file, {"the end of the line after ", what}, in_quotes(word));
  }

  /// Throws `name:line: expected ..., found ...`.
  [[noreturn]] PALPATE_COLD void refuse(SetupErrorKind kind, const Pieces& expected, const Pieces& found,
                                        const Pieces& hint = {}) const {
    io::refuse(kind, {location_text(name_, location()), ": expected ", joined(expected), ", found ", joined(found)},
               joined(hint));
  }

  /// Refuses a number that is not between `low` and `high`; `found` as written in the file.
  [[noreturn]] PALPATE_COLD void refuse_range(SetupErrorKind kind, std::string_view what, Index low, Index high,
                                              const Pieces& found) const {
    if (high == std::numeric_limits<Index>::max()) refuse(kind, {what, " of at least ", low}, found);
    refuse(kind, {what, " between ", low, " and ", high}, found);
  }

 private:
  bool is_blank(char c) const noexcept {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f' || (c == ',' && syntax_.commas);
  }
  std::string_view trim(std::string_view s) const noexcept {
    while (!s.empty() && is_blank(s.front())) s.remove_prefix(1);
    while (!s.empty() && is_blank(s.back())) s.remove_suffix(1);
    return s;
  }

  std::string_view text_;
  std::string name_;
  TextSyntax syntax_;
  std::string_view line_, rest_;
  std::size_t next_ = 0;
  Index line_number_ = 0;
  bool is_binary_ = false;
};

inline void TextReader::restart(std::string_view text, Index first_line) {
  text_ = text;
  line_ = rest_ = {};
  next_ = 0;
  line_number_ = first_line - 1;
}

inline bool TextReader::next_raw_line() {
  line_ = rest_ = {};
  if (next_ >= text_.size()) return false;
  const std::size_t end = std::min(text_.find('\n', next_), text_.size());
  const std::string_view whole = text_.substr(next_, end - next_);
  line_ = rest_ = trim(syntax_.comment == '\0' ? whole : whole.substr(0, whole.find(syntax_.comment)));
  next_ = end + 1;
  ++line_number_;
  return true;
}

inline std::string_view TextReader::read_bytes(std::size_t bytes, std::string_view what) {
  is_binary_ = true;
  if (bytes > bytes_left())
    refuse(SetupErrorKind::bad_file, what, {"the end of the file after ", bytes_left(), " of ", bytes, " bytes"});
  const std::string_view raw = text_.substr(next_, bytes);
  next_ += bytes;
  line_ = rest_ = {};
  return raw;
}

PALPATE_COLD inline void TextReader::skip_to(const std::string& mark) {
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

inline std::string_view TextReader::token() {
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

inline Index TextReader::integer(std::string_view what, Index low, Index high, SetupErrorKind kind) {
  const std::string_view word = token();
  Index value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc::invalid_argument || end != word.data() + word.size())
    refuse(SetupErrorKind::bad_file, what, in_quotes(word));
  if (error == std::errc::result_out_of_range || value < low || value > high)
    refuse_range(kind, what, low, high, in_quotes(word));
  return value;
}

inline double TextReader::real(std::string_view what) {
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

}}}  // namespace palpate::PALPATE_ABI::io
