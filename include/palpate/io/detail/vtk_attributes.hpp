// The data after the grid of a legacy VTK file: the regions are kept, the rest is skipped.
#pragma once

#include <palpate/io/detail/labels.hpp>
#include <palpate/io/detail/vtk_numbers.hpp>

#include <algorithm>
#include <functional>

namespace palpate { inline namespace PALPATE_ABI { namespace io::vtk {

/// Cell arrays that are used as region numbers, in this order of preference: Gmsh writes CellEntityIds, meshio all with
/// a colon.
inline constexpr std::array<std::string_view, 11> region_arrays{
    "region",    "CellEntityIds", "gmsh:physical", "material",        "MaterialIds", "Material",
    "medit:ref", "tetgen:ref",    "nastran:ref",   "avsucd:material", "netgen:index"};

/// The names that are looked for: `labels`, if it is not empty, instead of region_arrays.
PALPATE_COLD inline std::span<const std::string_view> region_names(const std::string_view& labels) noexcept {
  if (labels.empty()) return region_arrays;
  return {&labels, 1};
}

/// Whether there are cells of different regions.
PALPATE_COLD inline bool has_regions(const std::vector<int>& regions) noexcept {
  return std::adjacent_find(regions.begin(), regions.end(), std::not_equal_to<>()) != regions.end();
}

/// Whether an array that is not used is worth a note: not one of region_arrays.
PALPATE_COLD inline bool may_be_unknown(std::string_view name) noexcept {
  return std::find(region_arrays.begin(), region_arrays.end(), name) == region_arrays.end();
}

/// Reads the parts of CELL_DATA and POINT_DATA, and FIELD.
class AttributeReader {
 public:
  /// `labels` names the array with the regions, if it is not empty.
  AttributeReader(TextReader& in, NumberStream& numbers, std::string_view labels)
      : in_(in), numbers_(numbers), labels_(labels) {}

  /// Reads the rest of the line `CELL_DATA count` or `POINT_DATA count`.
  void begin(bool of_cells, Index expected);

  /// Reads the part that begins with the word `keyword`.
  void read(std::string_view keyword);

  /// Notes arrays that look like labels if there are no regions. Refuses a file without the array `labels`.
  void end(FileMesh& mesh);

  std::vector<int> regions;  ///< of each cell; empty if the file has none

 private:
  PALPATE_COLD void skip_metadata() {
    while (in_.next_raw_line() && !in_.line().empty()) {}
  }

  /// Reads an array if it contains the regions, else skips it.
  void read_array(std::string_view name, const NumberType& type, Index components, Index tuples);

  /// Reads the regions of all cells; of real numbers only if all are whole.
  void read_regions(std::string_view name, const NumberType& type, std::size_t rank);

  /// Counts the different numbers of an array that is not used.
  void count_labels(std::string_view name, const NumberType& type);

  /// `FIELD name arrays`, then `name components tuples type` and the numbers of each.
  void read_field();

  /// The attributes with a keyword of their own.
  void read_attribute(std::string_view keyword);

  TextReader& in_;
  NumberStream& numbers_;
  std::string_view labels_;
  std::vector<UnusedLabels> unused_;
  std::string found_;                               ///< names of arrays with a number per cell
  std::size_t region_rank_ = region_arrays.size();  ///< of the array in `regions`
  bool has_begun_ = false, of_cells_ = false;
  Index count_ = 0;
};

PALPATE_COLD inline void AttributeReader::begin(bool of_cells, Index expected) {
  count_ = in_.integer("the number of cells or points", expected, expected, SetupErrorKind::bad_file);
  in_.end_line("the number of data");
  of_cells_ = of_cells;
  has_begun_ = true;
}

PALPATE_COLD inline void AttributeReader::read(std::string_view keyword) {
  if (same_word(keyword, "field"))
    read_field();
  else if (same_word(keyword, "metadata"))
    skip_metadata();
  else
    read_attribute(keyword);
}

inline void AttributeReader::read_array(std::string_view name, const NumberType& type, Index components, Index tuples) {
  if (tuples > 0 && components > static_cast<Index>(in_.bytes_left()) * 8 / tuples)
    in_.refuse(SetupErrorKind::count_too_large, "an array that fits into the file", {components, " x ", tuples});
  const bool is_scalar =
      of_cells_ && components == 1 && tuples == count_ && tuples > 0 && type.kind != NumberType::text && type.bits > 1;
  if (!is_scalar) return numbers_.skip(type, components * tuples);
  if (found_.size() < 200) append(found_, {found_.empty() ? "'" : ", '", name, "'"});
  const auto names = region_names(labels_);
  const auto rank = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  if (rank < std::min(region_rank_, names.size()))
    read_regions(name, type, rank);
  else
    count_labels(name, type);
  numbers_.end("the numbers of an array");
}

inline void AttributeReader::read_regions(std::string_view name, const NumberType& type, std::size_t rank) {
  std::vector<int> read;
  if (type.kind == NumberType::real) numbers_.check_fits(type, count_);
  for (Index i = 0; i < count_; ++i) {
    if (type.kind != NumberType::real) {
      read.push_back(static_cast<int>(numbers_.integer(type, "a region number", -max_int, max_int)));
      continue;
    }
    const double number = numbers_.any_number(type);
    if (is_label(number) && static_cast<Index>(read.size()) == i) read.push_back(static_cast<int>(number));
    if (static_cast<Index>(read.size()) != i + 1 && !labels_.empty())
      in_.refuse(SetupErrorKind::bad_argument, {"whole numbers in the array '", name, "'"}, number);
  }
  if (static_cast<Index>(read.size()) != count_) return;
  region_rank_ = rank;
  regions.swap(read);
}

inline void AttributeReader::count_labels(std::string_view name, const NumberType& type) {
  LabelCount labels;
  numbers_.check_fits(type, count_);
  for (Index i = 0; i < count_; ++i) labels.add(numbers_.any_number(type));
  if (labels.looks_like_labels() && unused_.size() < 10 && may_be_unknown(name))
    unused_.push_back({std::string(name), labels.different()});
}

PALPATE_COLD inline void AttributeReader::end(FileMesh& mesh) {
  if (!labels_.empty() && region_rank_ != 0)
    refuse(SetupErrorKind::bad_argument,
           {in_.name(), ": expected an array ", in_quotes(labels_), " with a number per cell, found ",
            found_.empty() ? std::string_view("none") : std::string_view(found_)});
  if (labels_.empty() && !has_regions(regions)) note_unused_labels(unused_, mesh);
}

PALPATE_COLD inline void AttributeReader::read_field() {
  in_.token();
  const Index arrays = in_.count("a number of arrays", 1);
  in_.end_line("the number of arrays");
  for (Index i = 0; i < arrays; ++i) {
    in_.need_line("an array");
    if (same_word(in_.line(), "metadata")) {
      skip_metadata();
      in_.need_line("an array");
    }
    const std::string_view name = in_.token();
    const Index components = in_.integer("a number of components", 0, max_int);
    const Index tuples = in_.integer("a number of tuples", 0, max_int);
    const NumberType& type = numbers_.read_type();
    in_.end_line("the type of an array");
    read_array(name, type, components, tuples);
  }
}

PALPATE_COLD inline void AttributeReader::read_attribute(std::string_view keyword) {
  if (!has_begun_) in_.refuse(SetupErrorKind::bad_file, "a section such as POINTS or CELLS", in_quotes(in_.line()));
  const std::string_view name = in_.token();
  if (same_word(keyword, "lookup_table") || same_word(keyword, "color_scalars")) {
    const Index size = in_.integer("a size", 0, max_int);
    in_.end_line("a size");
    const Index values = same_word(keyword, "lookup_table") ? 4 * size : size * count_;
    return numbers_.skip(number_types[1], values);  // real numbers in ASCII, bytes in binary files
  }
  struct Kind {
    std::string_view name;
    Index components;
  };
  constexpr std::array<Kind, 9> kinds{{{"vectors", 3},
                                       {"normals", 3},
                                       {"tensors", 9},
                                       {"tensors6", 6},
                                       {"global_ids", 1},
                                       {"pedigree_ids", 1},
                                       {"edge_flags", 1},
                                       {"texture_coordinates", 0},
                                       {"scalars", 0}}};
  std::size_t kind = 0;
  while (kind < kinds.size() && !same_word(kinds[kind].name, keyword)) ++kind;
  if (kind == kinds.size()) in_.refuse(SetupErrorKind::bad_file, "data such as SCALARS", in_quotes(in_.line()));
  Index components = kinds[kind].components;
  if (same_word(keyword, "texture_coordinates")) components = in_.integer("a number of components", 1, 3);
  const NumberType& type = numbers_.read_type();
  if (same_word(keyword, "scalars")) components = in_.rest().empty() ? 1 : in_.integer("a number of components", 1, 4);
  in_.end_line("the type of the data");
  if (same_word(keyword, "scalars")) {
    in_.need_line("LOOKUP_TABLE");
    if (!same_word(in_.token(), "lookup_table"))
      in_.refuse(SetupErrorKind::bad_file, "LOOKUP_TABLE", in_quotes(in_.line()));
    in_.token();
    in_.end_line("the name of a table");
  }
  read_array(name, type, components, count_);
}

}}}  // namespace palpate::PALPATE_ABI::io::vtk
