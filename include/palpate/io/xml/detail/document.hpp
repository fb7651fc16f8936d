// XML files, parsed by pugixml, with the line of every element.
#pragma once

#include <palpate/io/detail/text_reader.hpp>

#include <pugixml.hpp>

#include <algorithm>
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
  Index line_of(pugi::xml_node element) {
    return line_at(static_cast<std::size_t>(std::max<std::ptrdiff_t>(element.offset_debug(), 0)));
  }

  /// `file:line` of an element.
  std::string place_of(pugi::xml_node element) { return location_text(in_.name(), line_of(element)); }

  /// The only child of that name.
  pugi::xml_node need_child(pugi::xml_node element, const char* name);

  /// An attribute that must be there.
  std::string_view need_attribute(pugi::xml_node element, const char* name);

  /// The same as an integer.
  Index integer(pugi::xml_node element, const char* name, Index low, Index high,
                SetupErrorKind kind = SetupErrorKind::index_out_of_range);

  [[noreturn]] void refuse(pugi::xml_node element, SetupErrorKind kind, const Pieces& expected, const Pieces& found,
                           const Pieces& hint = {}) {
    in_.restart({}, line_of(element) + 1);
    in_.refuse(kind, expected, found, hint);
  }

 private:
  Index line_at(std::size_t offset);

  std::string_view text_;
  std::string buffer_;  ///< of the same offsets, changed by the parser
  pugi::xml_document document_;
  TextReader in_;
  std::size_t known_offset_ = 0;
  Index known_line_ = 1;
};

inline Document::Document(std::string_view text, const std::string& name, TextSyntax syntax, std::string_view tail)
    : text_(text), buffer_(joined({text, tail})), in_({}, name, syntax) {
  const pugi::xml_parse_result result =
      document_.load_buffer_inplace(buffer_.data(), buffer_.size(), pugi::parse_escapes, pugi::encoding_utf8);
  if (!result) {
    in_.restart({}, line_at(static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0))) + 1);
    in_.refuse(SetupErrorKind::bad_file, "well-formed XML", result.description());
  }
}

inline Index Document::line_at(std::size_t offset) {
  offset = std::min(offset, text_.size());
  const auto [first, last] = std::minmax(offset, known_offset_);
  const auto lines = static_cast<Index>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(first),
                                                   text_.begin() + static_cast<std::ptrdiff_t>(last), '\n'));
  known_line_ += offset < known_offset_ ? -lines : lines;
  known_offset_ = offset;
  return known_line_;
}

inline TextReader& Document::text_of(pugi::xml_node element) {
  const pugi::xml_node text = element.first_child();
  const bool has_text = text.type() == pugi::node_pcdata;
  if ((has_text && text.next_sibling()) || (text && !has_text))
    refuse(element, SetupErrorKind::bad_file, {"only text in <", element.name(), ">"}, "other content");
  const std::string_view value = text.value();
  const Index line = has_text ? line_at(static_cast<std::size_t>(text.value() - buffer_.data())) : line_of(element);
  in_.restart(value, line);
  in_.next_line();
  return in_;
}

inline pugi::xml_node Document::need_child(pugi::xml_node element, const char* name) {
  const pugi::xml_node child = element.child(name);
  if (!child) refuse(element, SetupErrorKind::bad_file, {"<", name, "> in <", element.name(), ">"}, "none");
  if (const pugi::xml_node other = child.next_sibling(name))
    refuse(other, SetupErrorKind::unsupported, {"one <", name, ">"}, "another");
  return child;
}

inline std::string_view Document::need_attribute(pugi::xml_node element, const char* name) {
  const pugi::xml_attribute attribute = element.attribute(name);
  if (!attribute)
    refuse(element, SetupErrorKind::bad_file, {"the attribute ", name, " of <", element.name(), ">"}, "none");
  return attribute.value();
}

inline Index Document::integer(pugi::xml_node element, const char* name, Index low, Index high, SetupErrorKind kind) {
  in_.restart(need_attribute(element, name), line_of(element));
  in_.next_line();
  const Index value = in_.integer(name, low, high, kind);
  in_.end_line(name);
  return value;
}

}}}  // namespace palpate::PALPATE_ABI::io::xml
