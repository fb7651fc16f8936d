// The lines of an Abaqus file: keywords with parameters, and data.
#pragma once

#include <palpate/io/detail/text_reader.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace io::abaqus {

/// ASCII letters in upper case, and blanks between words as one blank.
std::string upper(std::string_view text);

/// A name without its quotes.
std::string_view without_quotes(std::string_view name) noexcept;

/// Reads a file keyword by keyword. Comments (`**`) and blank lines are skipped everywhere. Keywords and names of
/// parameters do not depend on the case.
class Lines {
 public:
  Lines(std::string_view text, const std::string& name) : in(text, name, {'\0', false, true}) {}

  TextReader in;

  /// Moves to the next keyword line, skipping data; false at the end of the file. A data line before the first keyword
  /// is refused.
  bool next_keyword();

  /// Moves to the next data line; false before the next keyword and at the end of the file.
  bool next_data();

  /// Refuses the end of the data where `expected` is missing.
  void need_data(std::string_view expected);

  /// Moves to the next data line if the current one has no more fields.
  void need_field(std::string_view expected);

  /// Reads the parameters of the current keyword line, which continues on the next line after a comma at its end.
  void read_parameters();

  bool has(std::string_view parameter) const noexcept { return find(parameter) != nullptr; }

  /// The value of a parameter, without quotes; empty if there is none.
  std::string_view value(std::string_view parameter) const noexcept;

  /// The same; refuses a parameter that is missing or empty.
  std::string need_value(std::string_view parameter) const;

  /// Refuses the current line as unsupported.
  [[noreturn]] void refuse_keyword(std::string_view expected, const Pieces& hint) const;

  /// Refuses a last line that is used and has no line end: it may be truncated.
  void need_whole_data() const;

  std::string keyword;  ///< in upper case, without the star and blanks

 private:
  struct Parameter {
    std::string name, value;
  };

  bool next_line();
  void add_parameter(std::string_view text);
  const Parameter* find(std::string_view parameter) const noexcept;

  std::vector<Parameter> parameters_;
  bool stays_ = false, is_used_ = false;
};

}}}  // namespace palpate::PALPATE_ABI::io::abaqus

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/abaqus_lines.ipp>
#endif
