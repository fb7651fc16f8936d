// Definitions of abaqus_lines.hpp.
#pragma once

#include <palpate/io/detail/abaqus_lines.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace io::abaqus {

PALPATE_COLD PALPATE_INLINE std::string upper(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool is_blank = c == ' ' || c == '\t';
    if (is_blank && (out.empty() || out.back() == ' ')) continue;
    out += is_blank ? ' ' : c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  if (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

PALPATE_COLD PALPATE_INLINE std::string_view without_quotes(std::string_view name) noexcept {
  const bool is_quoted = name.size() > 1 && name.front() == '"' && name.back() == '"';
  return is_quoted ? name.substr(1, name.size() - 2) : name;
}

PALPATE_INLINE bool Lines::next_line() {
  if (stays_) return !(stays_ = false);
  while (in.next_line()) {
    if (!in.line().starts_with("**")) return true;
    is_used_ = false;
  }
  return false;
}

PALPATE_INLINE bool Lines::next_keyword() {
  while (next_line()) {
    if (in.line().front() == '*') {
      is_used_ = false;
      keyword = upper(in.token().substr(1));
      keyword.erase(std::remove(keyword.begin(), keyword.end(), ' '), keyword.end());
      return true;
    }
    if (keyword.empty()) in.refuse(SetupErrorKind::bad_file, "a keyword such as *NODE", in_quotes(in.line()));
  }
  return false;
}

PALPATE_INLINE bool Lines::next_data() {
  if (!next_line()) return false;
  stays_ = in.line().front() == '*';
  is_used_ = !stays_;
  return is_used_;
}

PALPATE_COLD PALPATE_INLINE void Lines::need_data(std::string_view expected) {
  if (next_data()) return;
  if (stays_) in.refuse(SetupErrorKind::bad_file, expected, in_quotes(in.line()));
  in.refuse(SetupErrorKind::bad_file, expected, "the end of the file");
}

PALPATE_INLINE void Lines::need_field(std::string_view expected) {
  if (in.rest().empty()) need_data(expected);
}

PALPATE_COLD PALPATE_INLINE void Lines::read_parameters() {
  parameters_.clear();
  is_used_ = true;
  for (;;) {
    while (!in.rest().empty()) add_parameter(in.token());
    if (!in.line().ends_with(',') || !next_line()) return;
    stays_ = in.line().front() == '*';
    if (stays_) return;
  }
}

PALPATE_COLD PALPATE_INLINE void Lines::add_parameter(std::string_view text) {
  const std::size_t sign = std::min(text.find('='), text.size());
  const std::string name = upper(text.substr(0, sign));
  if (name.empty() || name.front() < 'A' || name.front() > 'Z')
    in.refuse(SetupErrorKind::bad_file, "a parameter such as NSET=name", in_quotes(text));
  std::string_view value = text.substr(std::min(sign + 1, text.size()));
  while (value.starts_with(' ') || value.starts_with('\t')) value.remove_prefix(1);
  parameters_.push_back({name, std::string(without_quotes(value))});
}

PALPATE_COLD PALPATE_INLINE const Lines::Parameter* Lines::find(std::string_view parameter) const noexcept {
  for (const Parameter& p : parameters_)
    if (p.name == parameter) return &p;
  return nullptr;
}

PALPATE_COLD PALPATE_INLINE std::string_view Lines::value(std::string_view parameter) const noexcept {
  const Parameter* p = find(parameter);
  return p == nullptr ? std::string_view{} : std::string_view(p->value);
}

PALPATE_COLD PALPATE_INLINE std::string Lines::need_value(std::string_view parameter) const {
  const std::string_view found = value(parameter);
  if (found.empty()) in.refuse(SetupErrorKind::bad_file, {parameter, "=name"}, in_quotes(in.line()));
  return std::string(found);
}

PALPATE_COLD PALPATE_INLINE void Lines::refuse_keyword(std::string_view expected, const Pieces& hint) const {
  in.refuse(SetupErrorKind::unsupported, expected, in_quotes(in.line()), hint);
}

PALPATE_COLD PALPATE_INLINE void Lines::need_whole_data() const {
  if (is_used_) in.need_last_line_end();
}

}}}  // namespace palpate::PALPATE_ABI::io::abaqus
