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

  void need_line(std::string_view expected) {
    if (!next_line()) in().refuse(SetupErrorKind::bad_file, expected, "the end of the file");
  }

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

PALPATE_COLD inline Lines::Lines(std::string_view text, const std::string& name, Lines::Include include)
    : include_(std::move(include)) {
  open_.push_back({{}, TextReader(text, name, syntax)});
  names.push_back(name);
  file_.push_back(0);
}

inline bool Lines::next_line() {
  if (stays_) return !(stays_ = false);
  for (;;) {
    while (!in().next_line()) {
      const bool is_open_list = reads_list && open_.size() > 1 && !in().has_last_line_end();
      if (is_open_list)
        notes.push_back(joined({in().name(), " has no line end after its last line: is its last number whole?"}));
      else
        in().need_last_line_end();
      if (open_.size() == 1) return false;
      open_.pop_back();
      file_.pop_back();
    }
    if (!in().line().starts_with(mark)) return true;
    open();
  }
}

PALPATE_COLD inline void Lines::open() {
  TextReader& at = in();
  at.token();
  const std::string name(at.rest());
  if (open_.size() >= 8 || names.size() >= 64)
    at.refuse(SetupErrorKind::unsupported, "at most 8 files inside each other and 64 in all", "one more");
  if (name.empty() || name.front() == '/' || name.front() == '\\' || name.find("..") != name.npos ||
      name.find(':') != name.npos)
    at.refuse(SetupErrorKind::unsupported, "a file in the folder of this one", in_quotes(name));
  open_.push_back({include_(name), TextReader({}, name)});
  open_.back().reader = TextReader(open_.back().text, name, syntax);
  file_.push_back(static_cast<std::uint8_t>(names.size()));
  names.push_back(name);
}

}}}  // namespace palpate::PALPATE_ABI::io::veg
