// The sections and numbers of a Medit file, text or binary.
#pragma once

#include <palpate/io/detail/cell_shape.hpp>
#include <palpate/io/detail/numbers.hpp>
#include <palpate/io/file_mesh.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace io::medit {

/// A section: its keyword in texts and its code in binary files (libMeshb).
struct Section {
  enum Kind { dimension, vertices, cells, order, bezier, real_bits, end };
  std::string_view keyword;
  int code;
  Kind kind;
  CellShape shape = CellShape::point;  ///< of cells, or of those whose order of nodes it gives
};

/// All that are read.
inline constexpr std::array sections{
    Section{"Dimension", 3, Section::dimension},
    Section{"Vertices", 4, Section::vertices},
    Section{"Edges", 5, Section::cells, CellShape::line2},
    Section{"Triangles", 6, Section::cells, CellShape::triangle3},
    Section{"Quadrilaterals", 7, Section::cells, CellShape::quadrangle4},
    Section{"Tetrahedra", 8, Section::cells, CellShape::tetrahedron4},
    Section{"Prisms", 9, Section::cells, CellShape::prism6},
    Section{"Hexahedra", 10, Section::cells, CellShape::hexahedron8},
    Section{"TrianglesP2", 24, Section::cells, CellShape::triangle6},
    Section{"EdgesP2", 25, Section::cells, CellShape::line3},
    Section{"QuadrilateralsQ2", 27, Section::cells, CellShape::quadrangle9},
    Section{"TetrahedraP2", 30, Section::cells, CellShape::tetrahedron10},
    Section{"HexahedraQ2", 33, Section::cells, CellShape::hexahedron27},
    Section{"Pyramids", 49, Section::cells, CellShape::pyramid5},
    Section{"End", 54, Section::end},
    Section{"PrismsP2", 86, Section::cells, CellShape::prism18},
    Section{"PyramidsP2", 87, Section::cells, CellShape::pyramid14},
    Section{"TrianglesP3", 90, Section::cells, CellShape::triangle10},
    Section{"EdgesP3", 92, Section::cells, CellShape::line4},
    Section{"TetrahedraP3", 96, Section::cells, CellShape::tetrahedron20},
    Section{"BezierBasis", 125, Section::bezier},
    Section{"TrianglesP2Ordering", 129, Section::order, CellShape::triangle6},
    Section{"TetrahedraP2Ordering", 133, Section::order, CellShape::tetrahedron10},
    Section{"FloatingPointPrecision", 155, Section::real_bits},
};

/// The section with this keyword or code, nullptr if it is skipped.
template <class Value>
constexpr const Section* find_section(Value Section::*member, const Value& value) noexcept {
  for (const Section& s : sections)
    if (s.*member == value) return &s;
  return nullptr;
}

/// Whether a text begins like a binary Medit file.
bool is_binary(std::string_view text) noexcept;

/// Reads one file (libMeshb, "The format"). In a text, numbers may be on any lines, and sections that are not read are
/// skipped up to the next word; in a binary file every section gives the byte of the next one.
class Source {
 public:
  /// Reads the version.
  Source(std::string_view text, const std::string& name);

  TextReader in;

  /// Moves to the next section that is read, nullptr at the end. Refuses one that is repeated, except sections of
  /// cells.
  const Section* next_section();

  /// Refuses data of a section that do not end where the next one begins.
  void end_section(const Section& section) const {
    if (is_binary_ && next_ > 0 && position() != next_)
      in.refuse(SetupErrorKind::bad_file, {"the end of ", section.keyword, " at byte ", next_}, {position()});
  }

  /// Whether there was an End.
  bool has_end() const noexcept { return has_end_; }

  /// Moves to the next line of a text whose present one has no more numbers, for the place of an item.
  void begin(std::string_view what) {
    if (!is_binary_) in.need_more(what);
  }

  Index integer(std::string_view what, Index low, Index high,
                SetupErrorKind kind = SetupErrorKind::index_out_of_range) {
    if (is_binary_) return binary_integer(in, {version_ < 4 ? 32 : 64, true, swap_}, what, low, high, kind);
    in.need_more(what);
    return in.integer(what, low, high, kind);
  }

  /// The dimension of space, in binary files of 32 bits in every version.
  void need_dimension_3();

  double real(std::string_view what) {
    if (is_binary_) return binary_real(in, {real_bits, true, swap_}, what);
    in.need_more(what);
    return in.real(what);
  }

  /// A count of rows of so many numbers, at most as many as fit into the rest of the file.
  Index count(std::string_view what, Index reals, Index integers);

  int real_bits = 64;  ///< of the real numbers of a binary file

 private:
  const Section* next_text_section();
  const Section* next_binary_section();
  bool ends_here();
  Index position() const noexcept { return static_cast<Index>(in.size() - in.bytes_left()); }

  bool is_binary_, swap_ = false, has_end_ = false;
  Index version_ = 1, next_ = -1;  ///< next_: byte of the next section in a binary file, 0 for none
  std::array<bool, sections.size()> is_known_{};
};

PALPATE_COLD inline bool is_binary(std::string_view text) noexcept {
  if (text.size() < 8) return false;
  for (const bool swap : {false, true}) {
    const auto version = from_bytes<std::int32_t>(text.substr(4), swap);
    if (from_bytes<std::int32_t>(text, swap) == 1 && version >= 1 && version <= 4) return true;
  }
  return false;
}

PALPATE_COLD inline Source::Source(std::string_view text, const std::string& name)
    : in(text, name, {is_binary(text) ? '\0' : '#'}), is_binary_(is_binary(text)) {
  if (is_binary_) {
    swap_ = from_bytes<std::int32_t>(in.read_bytes(4, "the number 1"), false) != 1;
  } else {
    in.need_line("MeshVersionFormatted");
    if (const std::string_view word = in.token(); word != "MeshVersionFormatted")
      in.refuse(SetupErrorKind::bad_file, "MeshVersionFormatted", in_quotes(word));
  }
  version_ = integer("a version", 1, 4, SetupErrorKind::unsupported);  // of 32 bits in every version
  if (version_ == 1) real_bits = 32;
}

inline const Section* Source::next_section() {
  const Section* section = is_binary_ ? next_binary_section() : next_text_section();
  if (section == nullptr) return nullptr;
  bool& is_known = is_known_[static_cast<std::size_t>(section - sections.data())];
  if (std::exchange(is_known, true) && section->kind != Section::cells)  // meshio writes one for every block of cells
    in.refuse(SetupErrorKind::bad_file, "every section once", {in_quotes(section->keyword), " again"});
  has_end_ = section->kind == Section::end;
  return has_end_ ? nullptr : section;
}

inline const Section* Source::next_text_section() {
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
PALPATE_COLD inline bool Source::ends_here() {
  if (next_ == 0) return true;
  if (next_ < 0) return false;
  if (next_ < position()) in.refuse(SetupErrorKind::bad_file, "the next section behind this one", {"byte ", next_});
  in.read_bytes(static_cast<std::size_t>(next_ - position()), "a section");
  return false;
}

inline const Section* Source::next_binary_section() {
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

PALPATE_COLD inline void Source::need_dimension_3() {
  constexpr std::string_view what = "the dimension 3";
  const Index dimension = is_binary_ ? binary_integer(in, {32, true, swap_}, what, 2, 3, SetupErrorKind::unsupported)
                                     : integer(what, 2, 3, SetupErrorKind::unsupported);
  if (dimension != 3) in.refuse(SetupErrorKind::unsupported, what, {dimension});
}

inline Index Source::count(std::string_view what, Index reals, Index integers) {
  if (is_binary_) {
    const Index row = reals * real_bits / 8 + integers * (version_ < 4 ? 4 : 8);
    return integer(what, 0, static_cast<Index>(in.bytes_left()) / row, SetupErrorKind::count_too_large);
  }
  in.need_more(what);
  const auto left = static_cast<Index>(in.bytes_left() + in.rest().size()) + 1;  // rows may follow on this line
  return in.integer(what, 0, left / (2 * (reals + integers)), SetupErrorKind::count_too_large);
}

}}}  // namespace palpate::PALPATE_ABI::io::medit
