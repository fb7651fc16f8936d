// The lines of a VegaFEM file with those of the files it includes.
#pragma once

#include <palpate/io/detail/text_reader.hpp>

#include <functional>
#include <list>
#include <string>
#include <string_view>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace io::veg {

/// Walks over a file and, at every `*INCLUDE other`, over that file first. At most 8 files deep and 64 in all, so that
/// files which include themselves come to an end.
class Lines {
 public:
  using Include = std::function<std::string(const std::string& name)>;

  Lines(std::string_view text, const std::string& name, Include include);

  /// Moves to the next line that is not blank; false at the end of the first file.
  bool next_line();

  void need_line(std::string_view expected);

  /// Has next_line() stay on the current line once.
  void hold() noexcept { held_ = true; }

  TextReader& in() noexcept { return open_.back().reader; }    ///< the reader of the current line
  std::uint8_t file() const noexcept { return file_.back(); }  ///< its entry in `names`

  std::vector<std::string> names;  ///< all files so far

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
  bool held_ = false;
};

}}}  // namespace palpate::PALPATE_ABI::io::veg

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/veg_lines.ipp>
#endif
