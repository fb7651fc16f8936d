// Texts put together from pieces: one call each, so that a refusal costs the compiler little.
#pragma once

#include <palpate/core/setup_error.hpp>

#include <concepts>
#include <initializer_list>
#include <string>
#include <string_view>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// A piece of a text: a text or a whole number. It refers to the text.
class Piece {
 public:
  Piece(std::string_view text) noexcept : text_(text), is_text_(true) {}
  Piece(const char* text) noexcept : text_(text), is_text_(true) {}
  Piece(const std::string& text) noexcept : text_(text), is_text_(true) {}
  Piece(std::integral auto number) noexcept : number_(static_cast<std::int64_t>(number)) {}
  Piece(char) = delete;

  /// Adds it to the end of `text`.
  void add_to(std::string& text) const;

 private:
  std::string_view text_;
  std::int64_t number_ = 0;
  bool is_text_ = false;
};

/// The pieces one behind the other.
std::string joined(std::initializer_list<Piece> pieces);

/// Adds the pieces to the end of `text`.
void append(std::string& text, std::initializer_list<Piece> pieces);

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/message.ipp>
#endif
