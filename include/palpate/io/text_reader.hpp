// Reads numbers and words from a text line by line and says exactly where something is wrong.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/io/decimal.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace palpate::inline PALPATE_ABI::io {

/// Walks over a text that must outlive it. Blank lines, tabs, CRLF, a UTF-8 byte order mark and a missing last newline
/// are accepted. Every refusal is a SetupError that reads `name:line: expected ..., found ...`. Nothing is allocated
/// unless something is wrong.
class TextReader {
 public:
  TextReader(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
  }

  /// Moves to the next line that is not blank; false at the end of the text.
  bool next_line() {
    while (next_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', next_), text_.size());
      line_ = trim(text_.substr(next_, end - next_));
      next_ = end + 1;
      ++line_number_;
      rest_ = line_;
      if (!line_.empty()) return true;
    }
    line_ = rest_ = {};
    return false;
  }

  /// Moves to the next line that is not blank and refuses when there is none.
  void need_line(std::string_view expected) {
    if (!next_line()) refuse(SetupErrorKind::bad_file, expected, "the end of the file");
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
    const auto left = static_cast<Index>(text_.size() - std::min(next_, text_.size()));
    return integer(what, 0, left / bytes_each, SetupErrorKind::count_too_large);
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

  /// Throws `name:line: expected ..., found ...`; `line` other than the current one may be given.
  [[noreturn]] PALPATE_COLD void refuse(SetupErrorKind kind, std::string_view expected, std::string_view found,
                                        std::string hint = {}, Index line = 0) const {
    raise(kind,
          name_ + ':' + std::to_string(line > 0 ? line : std::max<Index>(line_number_, 1)) + ": expected " +
              std::string(expected) + ", found " + std::string(found),
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

 private:
  static std::string range(Index low, Index high) {
    const std::string from = std::to_string(low);
    return high == std::numeric_limits<Index>::max() ? " of at least " + from
                                                     : " between " + from + " and " + std::to_string(high);
  }
  static bool is_blank(char c) noexcept { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }
  static std::string_view trim(std::string_view s) noexcept {
    while (!s.empty() && is_blank(s.front())) s.remove_prefix(1);
    while (!s.empty() && is_blank(s.back())) s.remove_suffix(1);
    return s;
  }

  std::string_view text_;
  std::string name_;
  std::string_view line_, rest_;
  std::size_t next_ = 0;
  Index line_number_ = 0;
};

/// The whole of a file. Throws bad_file when it cannot be read or is a folder.
inline std::string read_file(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    raise(SetupErrorKind::bad_file, path + ": expected a file, found a folder");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) raise(SetupErrorKind::bad_file, path + ": cannot be opened for reading");
  std::string text;
  constexpr std::size_t block = std::size_t{1} << 20;
  while (stream) {
    const std::size_t size = text.size();
    text.resize(size + block);
    stream.read(text.data() + size, static_cast<std::streamsize>(block));
    text.resize(size + static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.eof())
    raise(SetupErrorKind::bad_file, path + ": reading stopped after " + std::to_string(text.size()) + " bytes");
  return text;
}

}  // namespace palpate::inline PALPATE_ABI::io
