// The arrays of numbers in VTU files.
#pragma once

#include <palpate/io/detail/vtk_numbers.hpp>
#include <palpate/io/xml/detail/vtu_bytes.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace io::xml {

/// The types of numbers, as in legacy files.
inline constexpr std::array vtu_types{
    vtk::NumberType{"Int8", vtk::NumberType::integer, 8},
    vtk::NumberType{"UInt8", vtk::NumberType::unsigned_integer, 8},
    vtk::NumberType{"Int16", vtk::NumberType::integer, 16},
    vtk::NumberType{"UInt16", vtk::NumberType::unsigned_integer, 16},
    vtk::NumberType{"Int32", vtk::NumberType::integer, 32},
    vtk::NumberType{"UInt32", vtk::NumberType::unsigned_integer, 32},
    vtk::NumberType{"Int64", vtk::NumberType::integer, 64},
    vtk::NumberType{"UInt64", vtk::NumberType::unsigned_integer, 64},
    vtk::NumberType{"Float32", vtk::NumberType::real, 32},
    vtk::NumberType{"Float64", vtk::NumberType::real, 64},
};

/// Reads a `<DataArray>` number by number. The size is checked before anything is allocated.
class VtuArray {
 public:
  /// `count` numbers; refuses more and fewer.
  VtuArray(Document& document, VtuBytes& bytes, pugi::xml_node array, Index count);

  Index integer(std::string_view what, Index low, Index high);
  double real(std::string_view what);

  /// The next number, unchecked: NaN for a word that is none, or where there is none.
  double any_number();

  /// Refuses more numbers in a text.
  void end();

  const TextReader& in() const noexcept { return in_; }
  Index line() const noexcept { return is_text_ ? in_.place() : line_; }  ///< of the next number, or of the array

  static const vtk::NumberType& type_of(Document& document, pugi::xml_node array);

  /// The type of an array, nullptr if it is not known.
  static const vtk::NumberType* find_type(pugi::xml_node array) noexcept;

 private:
  BinaryLayout layout() const noexcept { return {type_.bits, type_.kind == vtk::NumberType::integer, swap_}; }

  const vtk::NumberType& type_;
  bool is_text_, swap_;
  Index line_;
  std::string data_;
  TextReader in_;
};

}}}  // namespace palpate::PALPATE_ABI::io::xml

#include <palpate/io/xml/detail/vtu_arrays.ipp>
