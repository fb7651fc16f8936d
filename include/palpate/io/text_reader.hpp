// Reads numbers and words from a text line by line, and raw bytes between lines, and says exactly where something is
// wrong.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/io/decimal.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// `file:12` for place 12, `file:byte 345` for place -345: lines mean nothing once binary data has begun.
inline std::string place_text(const std::string& file, Index place) {
  return file + (place < 0 ? ":byte " : ":") + std::to_string(place < 0 ? -place : place);
}

/// What else separates words, and what ends a line early.
struct TextSyntax {
  char comment = '\0';  ///< the rest of a line from here on is ignored
  bool commas = false;  ///< a comma is a blank
};

/// Walks over a text that must outlive it. Blank lines, tabs, CRLF, a UTF-8 byte order mark and a missing last newline
/// are accepted. Every refusal is a SetupError that reads `name:line: expected ..., found ...`. Nothing is allocated
/// unless something is wrong.
class TextReader {
 public:
  TextReader(std::string_view text, std::string name, TextSyntax syntax = {})
      : text_(text), name_(std::move(name)), syntax_(syntax) {
    if (text_.starts_with("\xEF\xBB\xBF")) next_ = 3;
  }

  /// Moves to the next line, blank or not; false at the end of the text.
  bool next_raw_line() {
    line_ = rest_ = {};
    if (next_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', next_), text_.size());
    const std::string_view whole = text_.substr(next_, end - next_);
    line_ = rest_ = trim(syntax_.comment == '\0' ? whole : whole.substr(0, whole.find(syntax_.comment)));
    next_ = end + 1;
    ++line_number_;
    return true;
  }

  /// Moves to the next line that is not blank; false at the end of the text.
  bool next_line() {
    while (next_raw_line())
      if (!line_.empty()) return true;
    return false;
  }

  /// Moves to the next line that is not blank and refuses when there is none.
  void need_line(std::string_view expected) {
    if (!next_line()) refuse(SetupErrorKind::bad_file, expected, "the end of the file");
  }

  /// Moves on to the next line that is not blank when nothing is left of this one.
  void need_more(std::string_view expected) {
    if (rest().empty()) need_line(expected);
  }

  /// The `bytes` bytes behind the current line as they are. From here on messages count bytes, not lines.
  std::string_view take(std::size_t bytes, std::string_view what) {
    is_binary_ = true;
    if (bytes > bytes_left())
      refuse(SetupErrorKind::bad_file, what,
             "the end of the file after " + std::to_string(bytes_left()) + " of " + std::to_string(bytes) + " bytes");
    const std::string_view raw = text_.substr(next_, bytes);
    next_ += bytes;
    line_ = rest_ = {};
    return raw;
  }

  /// Moves behind the next line that begins with `mark`, whatever comes before it. Refuses when there is none.
  void skip_to(const std::string& mark) {
    const std::size_t at = text_.find('\n' + mark, next_ - std::min<std::size_t>(next_, 1));
    if (at == text_.npos) refuse(SetupErrorKind::bad_file, mark, "the end of the file");
    next_ = at + 1;
    next_raw_line();
  }

  /// Refuses a text whose last line does not end: where a format has no mark for its end, the last number may be cut.
  void need_last_line_end() const {
    if (!text_.empty() && text_.back() != '\n')
      refuse(SetupErrorKind::bad_file, "a line end after the last line", "the end of the file",
             "If the file is whole, add an empty line");
  }

  std::size_t size() const noexcept { return text_.size(); }  ///< bytes in all
  std::size_t bytes_left() const noexcept { return text_.size() - std::min(next_, text_.size()); }

  /// The current line, or minus the current byte when binary data has begun; see place_text.
  Index place() const noexcept {
    return is_binary_ ? -static_cast<Index>(std::max<std::size_t>(next_, 1)) : std::max<Index>(line_number_, 1);
  }

  std::string_view line() const noexcept { return line_; }        ///< the current line, trimmed
  std::string_view rest() const noexcept { return trim(rest_); }  ///< what is left of it
  Index line_number() const noexcept { return line_number_; }     ///< counted from 1
  const std::string& name() const noexcept { return name_; }

  /// The next word of the current line, empty at its end.
  std::string_view token() {
    rest_ = trim(rest_);
    std::size_t end = 0;
    while (end < rest_.size() && !is_blank(rest_[end])) ++end;
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return word;
  }

  /// The next word as an integer between `low` and `high`; anything beyond them is refused as `kind`.
  Index integer(std::string_view what, Index low, Index high,
                SetupErrorKind kind = SetupErrorKind::index_out_of_range) {
    const std::string_view word = token();
    Index value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc::invalid_argument || end != word.data() + word.size())
      refuse(SetupErrorKind::bad_file, what, quoted(word));
    if (error == std::errc::result_out_of_range || value < low || value > high)
      refuse(kind, std::string(what) + range(low, high), quoted(word));
    return value;
  }

  /// A count of things that take at least `bytes_each` bytes of the lines below: no larger than the rest of the text
  /// can hold.
  Index count(std::string_view what, Index bytes_each) {
    return integer(what, 0, static_cast<Index>(bytes_left()) / bytes_each, SetupErrorKind::count_too_large);
  }

  /// The next word as a finite decimal number. Refuses NaN, infinity and overflow as non_finite, hexadecimal and
  /// decimal commas as bad_file.
  double real(std::string_view what) {
    std::string_view word = token();
    const std::string_view whole = word;
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    double value = 0.0;
    const std::errc error = parse_decimal(word, value);
    if (error == std::errc::invalid_argument) refuse(SetupErrorKind::bad_file, what, quoted(whole));
    if (error != std::errc{} || !std::isfinite(value))
      refuse(SetupErrorKind::non_finite, std::string(what) + " in the range of a double", quoted(whole));
    return value;
  }

  /// Refuses when the current line holds another word.
  void end_line(std::string_view what) {
    const std::string_view word = token();
    if (!word.empty()) refuse(SetupErrorKind::bad_file, "the end of the line after " + std::string(what), quoted(word));
  }

  /// Throws `name:line: expected ..., found ...`.
  [[noreturn]] PALPATE_COLD void refuse(SetupErrorKind kind, std::string_view expected, std::string_view found,
                                        std::string hint = {}) const {
    raise(kind, place_text(name_, place()) + ": expected " + std::string(expected) + ", found " + std::string(found),
          std::move(hint));
  }

  /// A word for a message: in quotes, shortened, printable.
  static std::string quoted(std::string_view word) {
    if (word.empty()) return "the end of the line";
    std::string text(word.substr(0, 40));
    for (char& c : text)
      if (c < ' ' || c > '~') c = '?';
    return '\'' + text + (word.size() > 40 ? "...'" : "'");
  }

  /// " between low and high", for a message.
  static std::string range(Index low, Index high) {
    const std::string from = std::to_string(low);
    return high == std::numeric_limits<Index>::max() ? " of at least " + from
                                                     : " between " + from + " and " + std::to_string(high);
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

}}}  // namespace palpate::io
