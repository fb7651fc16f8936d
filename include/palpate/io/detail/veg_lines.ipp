// Definitions of veg_lines.hpp.
#pragma once

#include <palpate/io/detail/veg_lines.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::veg {

PALPATE_COLD PALPATE_INLINE Lines::Lines(std::string_view text, const std::string& name, Lines::Include include)
    : include_(std::move(include)) {
  open_.push_back({{}, TextReader(text, name, syntax)});
  names.push_back(name);
  file_.push_back(0);
}

PALPATE_INLINE bool Lines::next_line() {
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

PALPATE_INLINE void Lines::need_line(std::string_view expected) {
  if (!next_line()) in().refuse(SetupErrorKind::bad_file, expected, "the end of the file");
}

PALPATE_COLD PALPATE_INLINE void Lines::open() {
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
