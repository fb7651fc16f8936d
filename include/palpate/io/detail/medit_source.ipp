// Definitions of medit_source.hpp.
#pragma once

#include <palpate/io/detail/medit_source.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace io::medit {

PALPATE_COLD PALPATE_INLINE bool is_binary(std::string_view text) noexcept {
  if (text.size() < 8) return false;
  for (const bool swap : {false, true}) {
    const auto version = from_bytes<std::int32_t>(text.substr(4), swap);
    if (from_bytes<std::int32_t>(text, swap) == 1 && version >= 1 && version <= 4) return true;
  }
  return false;
}

PALPATE_COLD PALPATE_INLINE Source::Source(std::string_view text, const std::string& name)
    : in(text, name, {is_binary(text) ? '\0' : '#'}), is_binary_(is_binary(text)) {
  if (is_binary_) {
    swap_ = from_bytes<std::int32_t>(in.take(4, "the number 1"), false) != 1;
  } else {
    in.need_line("MeshVersionFormatted");
    if (const std::string_view word = in.token(); word != "MeshVersionFormatted")
      in.refuse(SetupErrorKind::bad_file, "MeshVersionFormatted", in_quotes(word));
  }
  version_ = integer("a version", 1, 4, SetupErrorKind::unsupported);  // of 32 bits in every version
  if (version_ == 1) real_bits = 32;
}

PALPATE_INLINE const Section* Source::next_section() {
  const Section* section = is_binary_ ? next_binary_section() : next_text_section();
  if (section == nullptr) return nullptr;
  bool& is_known = is_known_[static_cast<std::size_t>(section - sections.data())];
  if (std::exchange(is_known, true) && section->kind != Section::cells)  // meshio writes one for every block of cells
    in.refuse(SetupErrorKind::bad_file, "every section once", {in_quotes(section->keyword), " again"});
  has_end_ = section->kind == Section::end;
  return has_end_ ? nullptr : section;
}

PALPATE_INLINE const Section* Source::next_text_section() {
  for (bool skips = false;;) {
    if (in.rest().empty() && !in.next_line()) {
      in.need_last_line_end();
      return nullptr;
    }
    const std::string_view word = in.token();
    if (const Section* section = find_section(&Section::keyword, word)) return section;
    const char first = word.front();
    const bool is_keyword = (first >= 'A' && first <= 'Z') || (first >= 'a' && first <= 'z');
    if (!is_keyword && !skips)
      in.refuse(SetupErrorKind::bad_file, "a keyword such as Tetrahedra", in_quotes(word),
                "A count is too small, or elements of second order have the keyword of the first, as "
                "Gmsh writes them: save its meshes as MSH");
    skips = true;
  }
}

/// Skips the rest of a section. Whether there is no further one.
PALPATE_COLD PALPATE_INLINE bool Source::ends_here() {
  if (next_ == 0) return true;
  if (next_ < 0) return false;
  if (next_ < position()) in.refuse(SetupErrorKind::bad_file, "the next section behind this one", {"byte ", next_});
  in.take(static_cast<std::size_t>(next_ - position()), "a section");
  return false;
}

PALPATE_INLINE const Section* Source::next_binary_section() {
  while (!ends_here()) {
    const Index code =
        binary_integer(in, {32, true, swap_}, "the code of a section", 1, max_int, SetupErrorKind::bad_file);
    const Section* section = find_section(&Section::code, static_cast<int>(code));
    if (section != nullptr && section->kind == Section::end) return section;
    next_ = binary_integer(in, {version_ < 3 ? 32 : 64, true, swap_}, "the byte of the next section", 0,
                           static_cast<Index>(in.size()), SetupErrorKind::bad_file);
    if (section != nullptr) return section;
  }
  return nullptr;
}

PALPATE_COLD PALPATE_INLINE void Source::need_dimension_3() {
  constexpr std::string_view what = "the dimension 3";
  const Index dimension = is_binary_ ? binary_integer(in, {32, true, swap_}, what, 2, 3, SetupErrorKind::unsupported)
                                     : integer(what, 2, 3, SetupErrorKind::unsupported);
  if (dimension != 3) in.refuse(SetupErrorKind::unsupported, what, {dimension});
}

PALPATE_INLINE void Source::end_section(const Section& section) const {
  if (is_binary_ && next_ > 0 && position() != next_)
    in.refuse(SetupErrorKind::bad_file, {"the end of ", section.keyword, " at byte ", next_}, {position()});
}

PALPATE_INLINE Index Source::count(std::string_view what, Index reals, Index integers) {
  if (is_binary_) {
    const Index row = reals * real_bits / 8 + integers * (version_ < 4 ? 4 : 8);
    return integer(what, 0, static_cast<Index>(in.bytes_left()) / row, SetupErrorKind::count_too_large);
  }
  in.need_more(what);
  const auto left = static_cast<Index>(in.bytes_left() + in.rest().size()) + 1;  // rows may follow on this line
  return in.integer(what, 0, left / (2 * (reals + integers)), SetupErrorKind::count_too_large);
}

}}}  // namespace palpate::PALPATE_ABI::io::medit
