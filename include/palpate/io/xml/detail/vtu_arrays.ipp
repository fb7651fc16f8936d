// Definitions of vtu_arrays.hpp.
#pragma once

#include <palpate/io/xml/detail/vtu_arrays.hpp>

#include <limits>

namespace palpate { inline namespace PALPATE_ABI { namespace io::xml {

inline const vtk::NumberType* VtuArray::find_type(pugi::xml_node array) noexcept {
  const std::string_view type = array.attribute("type").value();
  for (const vtk::NumberType& t : vtu_types)
    if (t.name == type) return &t;
  return nullptr;
}

inline const vtk::NumberType& VtuArray::type_of(Document& document, pugi::xml_node array) {
  const std::string_view type = document.need_attribute(array, "type");
  if (const vtk::NumberType* known = find_type(array)) return *known;
  document.refuse(array, SetupErrorKind::unsupported, "a type of numbers such as Float64", in_quotes(type));
}

inline VtuArray::VtuArray(Document& document, VtuBytes& bytes, pugi::xml_node array, Index count)
    : type_(type_of(document, array)),
      is_text_(document.need_attribute(array, "format") == "ascii"),
      swap_(bytes.is_swapped()),
      line_(document.line_of(array)),
      in_({}, std::string()) {
  if (is_text_) {
    const std::string_view text = array.first_child().value();
    if (count > static_cast<Index>(text.size()) / 2 + 1)
      document.refuse(array, SetupErrorKind::count_too_large, {count, " numbers in an array"},
                      {text.size(), " bytes of text"});
    in_ = document.text_of(array);
    return;
  }
  data_ = bytes.read(array, static_cast<std::size_t>(count) * static_cast<std::size_t>(type_.bits) / 8);
  const std::string name = array.attribute("Name").value();
  in_ = TextReader(data_, joined({document.place_of(array), ": array '", name, "'"}));
}

inline Index VtuArray::integer(std::string_view what, Index low, Index high) {
  if (!is_text_) return binary_integer(in_, layout(), what, low, high, SetupErrorKind::index_out_of_range);
  in_.need_more(what);
  return in_.integer(what, low, high);
}

inline double VtuArray::real(std::string_view what) {
  if (type_.kind != vtk::NumberType::real) {
    constexpr Index limit = std::numeric_limits<Index>::max();
    return static_cast<double>(integer(what, -limit, limit));
  }
  if (!is_text_) return binary_real(in_, layout(), what);
  in_.need_more(what);
  return in_.real(what);
}

inline double VtuArray::any_number() {
  if (!is_text_) return any_binary_number(in_, layout(), type_.kind == vtk::NumberType::real);
  if (in_.rest().empty()) in_.next_line();
  return any_decimal(in_.token());
}

inline void VtuArray::end() {
  if (!is_text_) return;
  in_.end_line("an array");
  if (in_.next_line()) in_.refuse(SetupErrorKind::bad_file, "the end of an array", in_quotes(in_.line()));
}

}}}  // namespace palpate::PALPATE_ABI::io::xml
