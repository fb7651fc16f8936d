// Reads numbers and words from a text line by line, and raw bytes between lines; errors report the exact place.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/io/detail/message.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// `file:12` for place 12, `file:byte 345` for place -345: line numbers have no meaning after binary data has begun.
std::string place_text(const std::string& file, Index place);

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
  TextReader(std::string_view text, std::string name, TextSyntax syntax = {});

  /// Reads another part of the same file, which begins in this line; messages contain its lines.
  void restart(std::string_view text, Index first_line);

  /// Moves to the next line, blank or not; false at the end of the text.
  bool next_raw_line();

  /// Moves to the next line that is not blank; false at the end of the text.
  bool next_line();

  /// Moves to the next line that is not blank; refuses if there is none.
  void need_line(std::string_view expected);

  /// Moves to the next line that is not blank if the current one has no more words.
  void need_more(std::string_view expected);

  /// The `bytes` raw bytes after the current line. From here on messages report bytes, not lines.
  std::string_view take(std::size_t bytes, std::string_view what);

  /// Moves to the end of the next line that ends with `mark`, which becomes the current line, skipping everything
  /// before it: binary data may end without a line end. Refuses if there is none.
  void skip_to(const std::string& mark);

  bool has_last_line_end() const noexcept { return text_.empty() || text_.back() == '\n'; }

  /// Refuses a text whose last line has no line end: if a format has no end mark, the last number may be truncated.
  void need_last_line_end() const;

  std::size_t size() const noexcept { return text_.size(); }  ///< total bytes
  std::size_t bytes_left() const noexcept { return next_ < text_.size() ? text_.size() - next_ : 0; }

  /// The current line, or minus the current byte when binary data has begun; see place_text.
  Index place() const noexcept {
    if (is_binary_) return next_ == 0 ? -1 : -static_cast<Index>(next_);
    return line_number_ < 1 ? 1 : line_number_;
  }

  std::string_view line() const noexcept { return line_; }        ///< the current line, trimmed
  std::string_view rest() const noexcept { return trim(rest_); }  ///< the unread rest of it
  Index line_number() const noexcept { return line_number_; }     ///< counted from 1
  const std::string& name() const noexcept { return name_; }

  /// The next word of the current line, empty at its end.
  std::string_view token();

  /// The next word as an integer between `low` and `high`; anything beyond them is refused as `kind`.
  Index integer(std::string_view what, Index low, Index high, SetupErrorKind kind = SetupErrorKind::index_out_of_range);

  /// A count of items that take at least `bytes_each` bytes of the following lines: at most as many as fit in the rest
  /// of the text.
  Index count(std::string_view what, Index bytes_each);

  /// The next word as a finite decimal number. Refuses NaN, infinity and overflow as non_finite, hexadecimal and
  /// decimal commas as bad_file. A number too small for a double is zero.
  double real(std::string_view what);

  /// Refuses if the current line contains another word.
  void end_line(std::string_view what);

  /// Throws `name:line: expected ..., found ...`.
  [[noreturn]] void refuse(SetupErrorKind kind, const Pieces& expected, const Pieces& found,
                           const Pieces& hint = {}) const;

  /// Refuses a number that is not between `low` and `high`; `found` as written in the file.
  [[noreturn]] void refuse_range(SetupErrorKind kind, std::string_view what, Index low, Index high,
                                 const Pieces& found) const;

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

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/text_reader.ipp>
#endif
