// Texts composed of pieces: a refusal is one call that constructs no string at the call site, which keeps compile time
// and code size small.
#pragma once

#include <palpate/core/setup_error.hpp>

#include <array>
#include <bit>
#include <charconv>
#include <concepts>
#include <initializer_list>
#include <string>
#include <string_view>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// A piece of a message: a text, an integer or a real number. A text is referenced, not copied.
class Piece {
 public:
  enum class Kind { text, quoted, integer, real };

  constexpr Piece(std::string_view text, Kind kind = Kind::text) noexcept
      : text_(text.data()), value_(static_cast<std::int64_t>(text.size())), kind_(kind) {}
  constexpr Piece(const char* text) noexcept : Piece(std::string_view(text)) {}
  Piece(const std::string& text) noexcept : Piece(std::string_view(text)) {}
  constexpr Piece(std::integral auto number) noexcept
      : value_(static_cast<std::int64_t>(number)), kind_(Kind::integer) {}
  constexpr Piece(double number) noexcept : value_(std::bit_cast<std::int64_t>(number)), kind_(Kind::real) {}
  Piece(char) = delete;
  Piece(bool) = delete;

  /// Adds it to the end of `text`.
  void add_to(std::string& text) const;

 private:
  const char* text_ = nullptr;
  std::int64_t value_;  ///< the number, or the length of the text
  Kind kind_;
};

/// A sequence of pieces; only for arguments, not to be stored.
class Pieces {
 public:
  constexpr Pieces() noexcept : single_(0) {}
  constexpr Pieces(std::initializer_list<Piece> list) noexcept
      : single_(0), list_(first_of(list)), count_(list.size()) {}
  template <std::convertible_to<Piece> T>
  constexpr Pieces(const T& single) noexcept : single_(single), count_(1) {}

  constexpr const Piece* begin() const noexcept { return list_ == nullptr ? &single_ : list_; }
  constexpr const Piece* end() const noexcept { return begin() + count_; }

 private:
  static constexpr const Piece* first_of(std::initializer_list<Piece> list) noexcept { return list.begin(); }

  Piece single_;
  const Piece* list_ = nullptr;
  std::size_t count_ = 0;
};

/// The pieces as a text.
PALPATE_COLD inline std::string joined(const Pieces& pieces) {
  std::string text;
  for (const Piece& piece : pieces) piece.add_to(text);
  return text;
}

/// Adds the pieces to the end of `text`.
inline void append(std::string& text, std::initializer_list<Piece> pieces) {
  for (const Piece& piece : pieces) piece.add_to(text);
}

/// A word for a message: in quotes, shortened, printable.
constexpr Piece in_quotes(std::string_view word) noexcept {
  return {word, Piece::Kind::quoted};
}

/// Throws SetupError.
[[noreturn]] PALPATE_COLD inline void refuse(SetupErrorKind kind, const Pieces& what, const Pieces& hint = {}) {
  raise(kind, joined(what), joined(hint));
}

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

inline void Piece::add_to(std::string& text) const {
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

}}}  // namespace palpate::PALPATE_ABI::io
