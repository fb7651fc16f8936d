// The words of an Abaqus file: lines with keywords, parameters and data; element types, and the faces of its solids.
#pragma once

#include <palpate/io/detail/cell_shape.hpp>
#include <palpate/io/detail/text_reader.hpp>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace io::abaqus {

/// A family of element types with one shape: letters after the stem name formulations (R, H, I, M, T ...). The order of
/// nodes is that of VTK for all of them (Abaqus manual, "Three-dimensional solid element library"; solids of other
/// shapes are refused later, and of lines only the set of nodes is used).
struct ElementType {
  std::string_view stem;
  CellShape shape;
};

inline constexpr std::array element_types{
    ElementType{"C3D4", CellShape::tetrahedron4},  ElementType{"C3D10", CellShape::tetrahedron10},
    ElementType{"C3D8", CellShape::hexahedron8},   ElementType{"C3D20", CellShape::hexahedron20},
    ElementType{"C3D6", CellShape::prism6},        ElementType{"C3D15", CellShape::prism15},
    ElementType{"C3D5", CellShape::pyramid5},      ElementType{"C3D13", CellShape::pyramid13},
    ElementType{"DC3D4", CellShape::tetrahedron4}, ElementType{"DC3D10", CellShape::tetrahedron10},
    ElementType{"DC3D8", CellShape::hexahedron8},  ElementType{"DC3D20", CellShape::hexahedron20},
    ElementType{"DC3D6", CellShape::prism6},       ElementType{"DC3D15", CellShape::prism15},
    ElementType{"SC6", CellShape::prism6},         ElementType{"SC8", CellShape::hexahedron8},
    ElementType{"S3", CellShape::triangle3},       ElementType{"STRI3", CellShape::triangle3},
    ElementType{"CPS3", CellShape::triangle3},     ElementType{"CPE3", CellShape::triangle3},
    ElementType{"CAX3", CellShape::triangle3},     ElementType{"M3D3", CellShape::triangle3},
    ElementType{"SFM3D3", CellShape::triangle3},   ElementType{"R3D3", CellShape::triangle3},
    ElementType{"DS3", CellShape::triangle3},      ElementType{"DC2D3", CellShape::triangle3},
    ElementType{"S6", CellShape::triangle6},       ElementType{"STRI65", CellShape::triangle6},
    ElementType{"CPS6", CellShape::triangle6},     ElementType{"CPE6", CellShape::triangle6},
    ElementType{"CAX6", CellShape::triangle6},     ElementType{"M3D6", CellShape::triangle6},
    ElementType{"SFM3D6", CellShape::triangle6},   ElementType{"DS6", CellShape::triangle6},
    ElementType{"DC2D6", CellShape::triangle6},    ElementType{"S4", CellShape::quadrangle4},
    ElementType{"CPS4", CellShape::quadrangle4},   ElementType{"CPE4", CellShape::quadrangle4},
    ElementType{"CAX4", CellShape::quadrangle4},   ElementType{"M3D4", CellShape::quadrangle4},
    ElementType{"SFM3D4", CellShape::quadrangle4}, ElementType{"R3D4", CellShape::quadrangle4},
    ElementType{"DS4", CellShape::quadrangle4},    ElementType{"DC2D4", CellShape::quadrangle4},
    ElementType{"S8", CellShape::quadrangle8},     ElementType{"CPS8", CellShape::quadrangle8},
    ElementType{"CPE8", CellShape::quadrangle8},   ElementType{"CAX8", CellShape::quadrangle8},
    ElementType{"M3D8", CellShape::quadrangle8},   ElementType{"SFM3D8", CellShape::quadrangle8},
    ElementType{"DS8", CellShape::quadrangle8},    ElementType{"DC2D8", CellShape::quadrangle8},
    ElementType{"S9", CellShape::quadrangle9},     ElementType{"M3D9", CellShape::quadrangle9},
    ElementType{"T2D2", CellShape::line2},         ElementType{"T3D2", CellShape::line2},
    ElementType{"B21", CellShape::line2},          ElementType{"B31", CellShape::line2},
    ElementType{"B23", CellShape::line2},          ElementType{"B33", CellShape::line2},
    ElementType{"T2D3", CellShape::line3},         ElementType{"T3D3", CellShape::line3},
    ElementType{"B22", CellShape::line3},          ElementType{"B32", CellShape::line3},
};

/// First letters of types without a shape: springs, masses, connectors, couplings. They are skipped, as are the network
/// elements D of CalculiX.
inline constexpr std::array<std::string_view, 16> skipped_types{
    "MASS",  "ROTARYI", "HEATCAP", "SPRING", "DASHPOT", "CONN",  "GAP",  "DCOUP",
    "JOINT", "ITS",     "ITT",     "PIPE",   "ELBOW",   "FRAME", "R2D2", "RAX2"};

/// The type of that name in upper case, or nullptr.
constexpr const ElementType* find_type(std::string_view name) noexcept {
  for (const ElementType& type : element_types) {
    if (!name.starts_with(type.stem)) continue;
    std::string_view suffix = name.substr(type.stem.size());
    if (suffix.ends_with("R5")) suffix.remove_suffix(1);  // shells with five degrees of freedom
    if (suffix.find_first_of("0123456789") == suffix.npos) return &type;
  }
  return nullptr;
}

constexpr bool is_skipped(std::string_view name) noexcept {
  for (const std::string_view start : skipped_types)
    if (name.starts_with(start)) return true;
  return name == "D";
}

/// Corners of face S1, S2 ... of a tetrahedron and a hexahedron, counterclockwise seen from outside.
inline constexpr std::array<std::array<int, 3>, 4> tetrahedron_faces{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
inline constexpr std::array<std::array<int, 4>, 6> hexahedron_faces{
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

/// ASCII letters in upper case, and blanks between words as one blank.
std::string upper(std::string_view text);

/// A name without its quotes.
PALPATE_COLD inline std::string_view without_quotes(std::string_view name) noexcept {
  const bool is_quoted = name.size() > 1 && name.front() == '"' && name.back() == '"';
  return is_quoted ? name.substr(1, name.size() - 2) : name;
}

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
  PALPATE_COLD void need_data(std::string_view expected) {
    if (next_data()) return;
    if (stays_) in.refuse(SetupErrorKind::bad_file, expected, in_quotes(in.line()));
    in.refuse(SetupErrorKind::bad_file, expected, "the end of the file");
  }

  /// Moves to the next data line if the current one has no more fields.
  void need_field(std::string_view expected) {
    if (in.rest().empty()) need_data(expected);
  }

  /// Reads the parameters of the current keyword line, which continues on the next line after a comma at its end.
  void read_parameters();

  bool has(std::string_view parameter) const noexcept { return find(parameter) != nullptr; }

  /// The value of a parameter, without quotes; empty if there is none.
  PALPATE_COLD std::string_view value(std::string_view parameter) const noexcept {
    const Parameter* p = find(parameter);
    return p == nullptr ? std::string_view{} : std::string_view(p->value);
  }

  /// The same; refuses a parameter that is missing or empty.
  PALPATE_COLD std::string need_value(std::string_view parameter) const {
    const std::string_view found = value(parameter);
    if (found.empty()) in.refuse(SetupErrorKind::bad_file, {parameter, "=name"}, in_quotes(in.line()));
    return std::string(found);
  }

  /// Refuses the current line as unsupported.
  [[noreturn]] PALPATE_COLD void refuse_keyword(std::string_view expected, const Pieces& hint) const {
    in.refuse(SetupErrorKind::unsupported, expected, in_quotes(in.line()), hint);
  }

  /// Refuses a last line that is used and has no line end: it may be truncated.
  PALPATE_COLD void need_whole_data() const {
    if (is_used_) in.need_last_line_end();
  }

  std::string keyword;  ///< in upper case, without the star and blanks

 private:
  struct Parameter {
    std::string name, value;
  };

  bool next_line();
  void add_parameter(std::string_view text);
  PALPATE_COLD const Parameter* find(std::string_view parameter) const noexcept {
    for (const Parameter& p : parameters_)
      if (p.name == parameter) return &p;
    return nullptr;
  }

  std::vector<Parameter> parameters_;
  bool stays_ = false, is_used_ = false;
};

PALPATE_COLD inline std::string upper(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool is_blank = c == ' ' || c == '\t';
    if (is_blank && (out.empty() || out.back() == ' ')) continue;
    out += is_blank ? ' ' : c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  if (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

inline bool Lines::next_line() {
  if (stays_) return !(stays_ = false);
  while (in.next_line()) {
    if (!in.line().starts_with("**")) return true;
    is_used_ = false;
  }
  return false;
}

inline bool Lines::next_keyword() {
  while (next_line()) {
    if (in.line().front() == '*') {
      is_used_ = false;
      keyword = upper(in.token().substr(1));
      keyword.erase(std::remove(keyword.begin(), keyword.end(), ' '), keyword.end());
      return true;
    }
    if (keyword.empty()) in.refuse(SetupErrorKind::bad_file, "a keyword such as *NODE", in_quotes(in.line()));
  }
  return false;
}

inline bool Lines::next_data() {
  if (!next_line()) return false;
  stays_ = in.line().front() == '*';
  is_used_ = !stays_;
  return is_used_;
}

PALPATE_COLD inline void Lines::read_parameters() {
  parameters_.clear();
  is_used_ = true;
  for (;;) {
    while (!in.rest().empty()) add_parameter(in.token());
    if (!in.line().ends_with(',') || !next_line()) return;
    stays_ = in.line().front() == '*';
    if (stays_) return;
  }
}

PALPATE_COLD inline void Lines::add_parameter(std::string_view text) {
  const std::size_t sign = std::min(text.find('='), text.size());
  const std::string name = upper(text.substr(0, sign));
  if (name.empty() || name.front() < 'A' || name.front() > 'Z')
    in.refuse(SetupErrorKind::bad_file, "a parameter such as NSET=name", in_quotes(text));
  std::string_view value = text.substr(std::min(sign + 1, text.size()));
  while (value.starts_with(' ') || value.starts_with('\t')) value.remove_prefix(1);
  parameters_.push_back({name, std::string(without_quotes(value))});
}

}}}  // namespace palpate::PALPATE_ABI::io::abaqus
