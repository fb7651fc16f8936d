// The lines of a VegaFEM file and of the files it includes.
#pragma once

#include <palpate/io/detail/text_reader.hpp>

#include <functional>
#include <list>
#include <string>
#include <string_view>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace io::veg {

/// Reads a file line by line; at every `*INCLUDE other` the lines of that file come first. At most 8 nested files and
/// 64 in total, so that recursive includes terminate.
class Lines {
 public:
  using Include = std::function<std::string(const std::string& name)>;

  Lines(std::string_view text, const std::string& name, Include include);

  /// Moves to the next line that is not blank; false at the end of the first file.
  bool next_line();

  void need_line(std::string_view expected);

  /// The next call of next_line() stays on the current line.
  void stay() noexcept { stays_ = true; }

  TextReader& in() noexcept { return open_.back().reader; }    ///< the reader of the current line
  std::uint8_t file() const noexcept { return file_.back(); }  ///< its entry in `names`

  std::vector<std::string> names;  ///< all files so far
  std::vector<std::string> notes;  ///< of included lists whose last line has no line end
  bool reads_list = false;         ///< the present section is a list: such a line end may be missing

 private:
  static constexpr TextSyntax syntax{'#', true};
  static constexpr std::string_view mark = "*INCLUDE";

  struct File {
    std::string text;
    TextReader reader;
  };

  void open();

  Include include_;
  std::list<File> open_;
  std::vector<std::uint8_t> file_;
  bool stays_ = false;
};

}}}  // namespace palpate::PALPATE_ABI::io::veg

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/veg_lines.ipp>
#endif
