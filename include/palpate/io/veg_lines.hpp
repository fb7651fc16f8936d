// The lines of a VegaFEM file with those of the files it includes.
#pragma once

#include <palpate/io/text_reader.hpp>

#include <functional>
#include <list>

namespace palpate { inline namespace PALPATE_ABI { namespace io::veg {

/// Fetches the text of an included file; throws SetupError when it cannot.
using Include = std::function<std::string(const std::string& name)>;

/// Walks over a file and, at every `*INCLUDE other`, over that file first. At most 8 files deep and 64 in all, so that
/// files which include themselves come to an end.
class Lines {
 public:
  Lines(std::string_view text, const std::string& name, Include include) : include_(std::move(include)) {
    open_.push_back({{}, TextReader(text, name, syntax)});
    names.push_back(name);
    file_.push_back(0);
  }

  /// Moves to the next line that is not blank; false at the end of the first file.
  bool next_line() {
    if (held_) return !(held_ = false);
    for (;;) {
      while (!in().next_line()) {
        in().need_last_line_end();
        if (open_.size() == 1) return false;
        open_.pop_back();
        file_.pop_back();
      }
      if (!in().line().starts_with(mark)) return true;
      open();
    }
  }

  void need_line(std::string_view expected) {
    if (!next_line()) in().refuse(SetupErrorKind::bad_file, expected, "the end of the file");
  }

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

  void open() {
    TextReader& at = in();
    at.token();
    const std::string name(at.rest());
    if (open_.size() >= 8 || names.size() >= 64)
      at.refuse(SetupErrorKind::unsupported, "at most 8 files inside each other and 64 in all", "one more");
    if (name.empty() || name.front() == '/' || name.front() == '\\' || name.find("..") != name.npos ||
        name.find(':') != name.npos)
      at.refuse(SetupErrorKind::unsupported, "a file in the folder of this one", TextReader::quoted(name));
    open_.push_back({include_(name), TextReader({}, name)});
    open_.back().reader = TextReader(open_.back().text, name, syntax);
    file_.push_back(static_cast<std::uint8_t>(names.size()));
    names.push_back(name);
  }

  Include include_;
  std::list<File> open_;
  std::vector<std::uint8_t> file_;
  bool held_ = false;
};

}}}  // namespace palpate::io::veg
