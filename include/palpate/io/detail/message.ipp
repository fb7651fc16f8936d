// Definitions of message.hpp.
#pragma once

#include <palpate/io/detail/message.hpp>

#include <array>
#include <charconv>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

namespace detail {

PALPATE_COLD inline void append_quoted(std::string& text, std::string_view word) {
  if (word.empty()) {
    text.append("the end of the line");
    return;
  }
  text += '\'';
  for (const char c : word.substr(0, 40)) text += c < ' ' || c > '~' ? '?' : c;
  text.append(word.size() > 40 ? "...'" : "'");
}

}  // namespace detail

PALPATE_INLINE void Piece::add_to(std::string& text) const {
  if (kind_ == Kind::text) {
    text.append(text_, static_cast<std::size_t>(value_));
  } else if (kind_ == Kind::integer) {
    std::array<char, 24> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value_).ptr;
    text.append(digits.data(), static_cast<std::size_t>(end - digits.data()));
  } else if (kind_ == Kind::real) {
    text.append(number(std::bit_cast<double>(value_)));
  } else {
    detail::append_quoted(text, {text_, static_cast<std::size_t>(value_)});
  }
}

PALPATE_INLINE void append(std::string& text, std::initializer_list<Piece> pieces) {
  for (const Piece& piece : pieces) piece.add_to(text);
}

PALPATE_COLD PALPATE_INLINE std::string joined(const Pieces& pieces) {
  std::string text;
  for (const Piece& piece : pieces) piece.add_to(text);
  return text;
}

PALPATE_COLD PALPATE_INLINE void refuse(SetupErrorKind kind, const Pieces& what, const Pieces& hint) {
  raise(kind, joined(what), joined(hint));
}

}}}  // namespace palpate::PALPATE_ABI::io
