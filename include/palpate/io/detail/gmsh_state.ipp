// Definitions of gmsh_state.hpp.
#pragma once

#include <palpate/io/detail/gmsh_state.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::gmsh {

PALPATE_INLINE const Type& read_type(const Numbers& in) {
  const Index wanted = in.integer("an element type", 1, max_int);
  const Type* type = find_type(wanted);
  if (type == nullptr)
    in.in.refuse(SetupErrorKind::unsupported, "a known Gmsh element type", {"'", wanted, "'"},
                 "Mesh again with elements of first or second order");
  return *type;
}

PALPATE_INLINE int used_tag(State& state, CellShape shape, int physical, int elementary) {
  if (facts(shape).dimension == 3) {
    state.has_physical = state.has_physical || physical != 0;
    state.elementary.add(elementary);
  }
  return state.by_elementary ? elementary : physical;
}

PALPATE_INLINE int read_physical(const Numbers& in) {
  const auto tag = static_cast<int>(in.integer("a physical tag", -max_int, max_int));
  return tag < 0 ? -tag : tag;
}

PALPATE_COLD PALPATE_INLINE void need_mark(TextReader& in, std::string_view mark) {
  in.need_line(mark);
  if (in.line() != mark) in.refuse(SetupErrorKind::bad_file, mark, in_quotes(in.line()));
}

PALPATE_COLD PALPATE_INLINE Index read_count(TextReader& in, std::string_view what, Index bytes_each) {
  in.need_line(what);
  const Index count = in.count(what, bytes_each);
  in.end_line(what);
  return count;
}

}}}  // namespace palpate::PALPATE_ABI::io::gmsh
