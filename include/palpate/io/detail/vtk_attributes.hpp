// The data after the grid of a legacy VTK file: the regions are kept, the rest is skipped.
#pragma once

#include <palpate/io/detail/vtk_numbers.hpp>
#include <palpate/io/file_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::vtk {

/// Cell arrays that are used as region numbers, in this order of preference; the second is what Gmsh writes.
inline constexpr std::array<std::string_view, 6> region_arrays{"region",   "CellEntityIds", "gmsh:physical",
                                                               "material", "MaterialIds",   "Material"};

/// Reads the parts of CELL_DATA and POINT_DATA, and FIELD.
class AttributeReader {
 public:
  AttributeReader(TextReader& in, NumberStream& numbers) : in_(in), numbers_(numbers) {}

  /// Reads the rest of the line `CELL_DATA count` or `POINT_DATA count`.
  void begin(bool of_cells, Index expected);

  /// Reads the part that begins with the word `keyword`.
  void read(std::string_view keyword);

  std::vector<int> regions;  ///< of each cell; empty if the file has none

 private:
  void skip_metadata();

  /// Reads an array if it contains the regions, else skips it.
  void read_array(std::string_view name, const NumberType& type, Index components, Index tuples);

  /// `FIELD name arrays`, then `name components tuples type` and the numbers of each.
  void read_field();

  /// The attributes with a keyword of their own.
  void read_attribute(std::string_view keyword);

  TextReader& in_;
  NumberStream& numbers_;
  std::size_t region_rank_ = region_arrays.size();  ///< of the array in `regions`
  bool has_begun_ = false, of_cells_ = false;
  Index count_ = 0;
};

}}}  // namespace palpate::PALPATE_ABI::io::vtk

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/vtk_attributes.ipp>
#endif
