// Definitions of read_mesh.hpp: reads VegaFEM files.
#pragma once

#include <palpate/io/detail/numbered_rows.hpp>
#include <palpate/io/detail/tag_sets.hpp>
#include <palpate/io/detail/veg_lines.hpp>
#include <palpate/io/file.hpp>
#include <palpate/io/read_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::veg {

namespace detail {

/// Parses one file: *VERTICES, *ELEMENTS, then *MATERIAL, *SET and *REGION in any number.
class Parser {
 public:
  Parser(std::string_view text, const std::string& name, Include include)
      : lines_(text, name, std::move(include)), mesh_(name) {}

  FileMesh parse();

 private:
  TextReader& in() { return lines_.in(); }

  void need_keyword(std::string_view keyword);

  /// Counts are not compared with the size of this file, because lines may be in an included file. No memory is
  /// reserved.
  static constexpr std::size_t any_size = std::size_t{1} << 40;

  void read_vertices();

  void read_elements();

  void read_section();

  std::string read_name(std::string_view what);

  /// The constants are checked to be numbers and otherwise ignored; materials are set by the code that constructs the
  /// model.
  void read_material();

  /// The ids of the elements, on any number of lines up to the next keyword.
  void read_set();

  /// `set, material`. A later region overrides an earlier one.
  void read_region();

  /// Gives every element the tag of the last region whose set contains it. Each set is processed once, even if several
  /// regions use it.
  void put_regions(std::vector<std::vector<int>>& tags) const;

  /// Region r gets tag r + 1, set s a larger tag; both have the name of the set.
  void add_tags();

  using NameMap = std::map<std::string, std::size_t>;
  struct Set {
    std::string name;
    std::vector<Index> elements;
  };

  Set& add_set(const std::string& name);

  Lines lines_;
  FileMesh mesh_;
  Index base_ = 0;  ///< the id of the first vertex
  RowNumbers elements_;
  NameMap materials_, set_of_name_;
  std::vector<Set> sets_;             ///< in the order of the file; the first contains all elements
  std::vector<std::size_t> regions_;  ///< the set of every region
};

inline FileMesh Parser::parse() {
  need_keyword("*VERTICES");
  read_vertices();
  need_keyword("*ELEMENTS");
  read_elements();
  add_set("allElements");
  while (lines_.next_line()) read_section();
  add_tags();
  mesh_.files = std::move(lines_.names);
  mesh_.notes = std::move(lines_.notes);
  return std::move(mesh_);
}

PALPATE_COLD inline void Parser::need_keyword(std::string_view keyword) {
  lines_.need_line(keyword);
  if (in().line() != keyword) in().refuse(SetupErrorKind::bad_file, keyword, in_quotes(in().line()));
}

inline void Parser::read_vertices() {
  lines_.need_line("the header of the vertices");
  const NodeHeader header = NodeHeader::read(in(), std::min(any_size, static_cast<std::size_t>(max_int) * 7));
  RowNumbers numbers;
  for (Index i = 0; i < header.count; ++i) {
    lines_.need_line("a vertex");
    read_node_row(in(), header, numbers, mesh_);
  }
  base_ = std::max<Index>(numbers.base(), 0);
}

inline void Parser::read_elements() {
  lines_.need_line("TET or CUBIC");
  const std::string_view type = in().line();
  const bool is_cubic = type.starts_with("CUBIC");
  if (!is_cubic && !type.starts_with("TET")) in().refuse(SetupErrorKind::unsupported, "TET or CUBIC", in_quotes(type));
  lines_.need_line("the header of the elements");
  const CellHeader header = CellHeader::read(in(), is_cubic ? CellShape::hexahedron8 : CellShape::tetrahedron4,
                                             std::min(any_size, static_cast<std::size_t>(max_int) * 9));
  for (Index i = 0; i < header.count; ++i) {
    lines_.need_line("an element");
    const Index place = in().location(), id = elements_.read(in(), "an element id");
    read_cell_nodes(in(), facts(header.shape).nodes, base_, mesh_);
    for (Index a = 0; a < header.attributes; ++a) in().real("an attribute");
    in().end_line("an element");
    mesh_.add_cell(id, place, header.shape, 0, header.order, lines_.file());
  }
}

PALPATE_COLD inline void Parser::read_section() {
  const std::string_view keyword = in().token();
  if (keyword == "*MATERIAL") {
    read_material();
  } else if (keyword == "*SET") {
    read_set();
  } else if (keyword == "*REGION") {
    read_region();
  } else {
    in().refuse(SetupErrorKind::bad_file, "*MATERIAL, *SET or *REGION", in_quotes(keyword));
  }
}

PALPATE_COLD inline std::string Parser::read_name(std::string_view what) {
  const std::string name(in().token());
  if (name.empty()) in().refuse(SetupErrorKind::bad_file, what, in_quotes(name));
  in().end_line(what);
  return name;
}

PALPATE_COLD inline void Parser::read_material() {
  materials_.try_emplace(read_name("the name of a material"), materials_.size());
  lines_.need_line("a material such as ENU, density, E, nu");
  const std::string_view type = in().token();
  if (type.empty() || type.front() == '*')
    in().refuse(SetupErrorKind::bad_file, "a material such as ENU, density, E, nu", in_quotes(type));
  while (!in().rest().empty()) in().real("a material constant");
}

PALPATE_COLD inline Parser::Set& Parser::add_set(const std::string& name) {
  set_of_name_.try_emplace(name, sets_.size());
  sets_.emplace_back().name = name;
  return sets_.back();
}

inline void Parser::read_set() {
  const std::string name = read_name("the name of a set");
  if (set_of_name_.find(name) != set_of_name_.end())
    in().refuse(SetupErrorKind::bad_file, "a new set", {in_quotes(name), " again"});
  std::vector<Index>& set = add_set(name).elements;
  const Index base = std::max<Index>(elements_.base(), 0), count = elements_.count();
  lines_.reads_list = true;
  while (lines_.next_line() && in().line().front() != '*')
    while (!in().rest().empty()) set.push_back(in().integer("an element id", base, base + count - 1) - base);
  lines_.reads_list = false;
  if (!in().line().empty()) lines_.stay();
}

PALPATE_COLD inline void Parser::read_region() {
  in().end_line("*REGION");
  lines_.need_line("a set and a material");
  const std::string set(in().token()), material(in().token());
  const auto known = set_of_name_.find(set);
  if (known == set_of_name_.end()) in().refuse(SetupErrorKind::bad_file, "a set of this file", in_quotes(set));
  if (materials_.find(material) == materials_.end())
    in().refuse(SetupErrorKind::bad_file, "a material of this file", in_quotes(material));
  in().end_line("a region");
  regions_.push_back(known->second);
}

inline void Parser::put_regions(std::vector<std::vector<int>>& tags) const {
  std::vector<char> is_done(sets_.size());
  for (std::size_t r = regions_.size(); r-- > 0;) {
    if (std::exchange(is_done[regions_[r]], char{1}) != 0) continue;
    const auto put = [&](std::size_t e) {
      if (tags[e].empty()) tags[e].push_back(static_cast<int>(r) + 1);
    };
    for (const Index e : sets_[regions_[r]].elements) put(static_cast<std::size_t>(e));
    if (regions_[r] == 0)
      for (std::size_t e = 0; e < tags.size(); ++e) put(e);
  }
}

inline void Parser::add_tags() {
  mesh_.last_region = static_cast<int>(regions_.size());
  std::vector<std::vector<int>> tags(mesh_.cells.size());
  for (std::size_t r = 0; r < regions_.size(); ++r)
    mesh_.names.push_back({3, static_cast<int>(r) + 1, sets_[regions_[r]].name});
  put_regions(tags);
  int tag = mesh_.last_region;
  for (std::size_t s = 1; s < sets_.size(); ++s) {
    mesh_.names.push_back({3, ++tag, sets_[s].name});
    for (const Index e : sets_[s].elements) {
      std::vector<int>& of_element = tags[static_cast<std::size_t>(e)];
      if (of_element.empty() || of_element.back() != tag) of_element.push_back(tag);
    }
  }
  TagSets known;
  for (std::size_t e = 0; e < tags.size(); ++e) mesh_.cells[e].tag_set = known.find_or_add(mesh_, tags[e]);
}

}  // namespace detail

PALPATE_INLINE FileMesh parse(std::string_view text, const std::string& name, Include include) {
  return detail::Parser(text, name, std::move(include)).parse();
}

PALPATE_INLINE FileMesh read(const std::string& path) {
  return parse(read_file(path), path, [&](const std::string& name) {
    const std::string other = joined({folder_of(path), name});
    if (!is_regular_file(other))
      refuse(SetupErrorKind::bad_file, {path, ": *INCLUDE ", name, ": there is no such file"});
    return read_file(other);
  });
}

}}}  // namespace palpate::PALPATE_ABI::io::veg
