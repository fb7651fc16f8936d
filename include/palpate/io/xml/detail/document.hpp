// XML files, parsed by pugixml, with the line of every element.
#pragma once

#include <palpate/io/detail/text_reader.hpp>

#include <pugixml.hpp>

#include <string>
#include <string_view>

namespace palpate { inline namespace PALPATE_ABI { namespace io::xml {

/// A parsed file. The text must outlive it. Entities other than those of characters are not expanded, and no other file
/// is read. Memory is proportional to the size of the text.
class Document {
 public:
  /// Refuses a text that is not well-formed as bad_file. `tail` is parsed after the text; `syntax` is that of numbers.
  Document(std::string_view text, const std::string& name, TextSyntax syntax, std::string_view tail = {});
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;

  pugi::xml_node root() const { return document_.document_element(); }

  /// A reader at the first line of the text in an element, valid until the next call.
  TextReader& text_of(pugi::xml_node element);

  /// The line of an element. Time is proportional to the distance from the element or text of the previous call.
  Index line_of(pugi::xml_node element);

  /// `file:line` of an element.
  std::string place_of(pugi::xml_node element) { return place_text(in_.name(), line_of(element)); }

  /// The only child of that name.
  pugi::xml_node need_child(pugi::xml_node element, const char* name);

  /// An attribute that must be there.
  std::string_view need_attribute(pugi::xml_node element, const char* name);

  /// The same as an integer.
  Index integer(pugi::xml_node element, const char* name, Index low, Index high,
                SetupErrorKind kind = SetupErrorKind::index_out_of_range);

  [[noreturn]] void refuse(pugi::xml_node element, SetupErrorKind kind, const Pieces& expected, const Pieces& found,
                           const Pieces& hint = {});

 private:
  Index line_at(std::size_t offset);

  std::string_view text_;
  std::string buffer_;  ///< of the same offsets, changed by the parser
  pugi::xml_document document_;
  TextReader in_;
  std::size_t known_offset_ = 0;
  Index known_line_ = 1;
};

}}}  // namespace palpate::PALPATE_ABI::io::xml

#include <palpate/io/xml/detail/document.ipp>
