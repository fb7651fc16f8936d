// Definitions of message.hpp.
#pragma once

#include <palpate/io/message.hpp>

#include <array>
#include <charconv>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

PALPATE_INLINE void Piece::add_to(std::string& text) const {
  if (is_text_) {
    text.append(text_);
    return;
  }
  std::array<char, 24> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number_).ptr;
  text.append(digits.data(), static_cast<std::size_t>(end - digits.data()));
}

PALPATE_INLINE void append(std::string& text, std::initializer_list<Piece> pieces) {
  for (const Piece& piece : pieces) piece.add_to(text);
}

PALPATE_COLD PALPATE_INLINE std::string joined(std::initializer_list<Piece> pieces) {
  std::string text;
  append(text, pieces);
  return text;
}

}}}  // namespace palpate::PALPATE_ABI::io
