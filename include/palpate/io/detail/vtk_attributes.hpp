// The data after the grid of a legacy VTK file: the regions are kept, the rest is skipped.
#pragma once

#include <palpate/io/detail/labels.hpp>
#include <palpate/io/detail/vtk_numbers.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::vtk {

/// Cell arrays that are used as region numbers, in this order of preference: Gmsh writes CellEntityIds, meshio all with
/// a colon.
inline constexpr std::array<std::string_view, 11> region_arrays{
    "region",    "CellEntityIds", "gmsh:physical", "material",        "MaterialIds", "Material",
    "medit:ref", "tetgen:ref",    "nastran:ref",   "avsucd:material", "netgen:index"};

/// The names that are looked for: `labels`, if it is not empty, instead of region_arrays.
std::span<const std::string_view> region_names(const std::string_view& labels) noexcept;

/// Whether there are cells of different regions.
bool has_regions(const std::vector<int>& regions) noexcept;

/// Whether an array that is not used is worth a note: not one of region_arrays.
bool may_be_unknown(std::string_view name) noexcept;

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
  void skip_metadata();

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

}}}  // namespace palpate::PALPATE_ABI::io::vtk

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/vtk_attributes.ipp>
#endif
