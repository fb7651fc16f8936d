// Reads VegaFEM meshes (*.veg).
#pragma once

#include <palpate/io/file.hpp>
#include <palpate/io/numbered_rows.hpp>
#include <palpate/io/veg_lines.hpp>

#include <set>

namespace palpate { inline namespace PALPATE_ABI { namespace io::veg {

/// Parses one file: *VERTICES, *ELEMENTS, then *MATERIAL, *SET and *REGION in any number.
class Parser {
 public:
  Parser(std::string_view text, const std::string& name, Include include)
      : lines_(text, name, std::move(include)), mesh_(name) {}

  FileMesh parse() {
    need_keyword("*VERTICES");
    read_vertices();
    need_keyword("*ELEMENTS");
    read_elements();
    sets_["allElements"];
    while (lines_.next_line()) read_section();
    add_tags();
    mesh_.files = lines_.names;
    return std::move(mesh_);
  }

 private:
  TextReader& in() { return lines_.in(); }

  void need_keyword(std::string_view keyword) {
    lines_.need_line(keyword);
    if (in().line() != keyword) in().refuse(SetupErrorKind::bad_file, keyword, TextReader::quoted(in().line()));
  }

  /// Counts are not compared with the size of this file: the lines may come from another one. Nothing is reserved.
  static constexpr std::size_t any_size = std::size_t{1} << 40;

  void read_vertices() {
    lines_.need_line("the header of the vertices");
    const NodeHeader header = NodeHeader::read(in(), std::min(any_size, static_cast<std::size_t>(max_int) * 7));
    RowNumbers numbers;
    for (Index i = 0; i < header.count; ++i) {
      lines_.need_line("a vertex");
      read_node_row(in(), header, numbers, mesh_);
    }
    base_ = std::max<Index>(numbers.base(), 0);
  }

  void read_elements() {
    lines_.need_line("TET or CUBIC");
    const std::string_view type = in().line();
    const bool is_cubic = type.starts_with("CUBIC");
    if (!is_cubic && !type.starts_with("TET"))
      in().refuse(SetupErrorKind::unsupported, "TET or CUBIC", TextReader::quoted(type));
    lines_.need_line("the header of the elements");
    const CellHeader header = CellHeader::read(in(), is_cubic ? CellShape::hexahedron8 : CellShape::tetrahedron4,
                                               std::min(any_size, static_cast<std::size_t>(max_int) * 9));
    for (Index i = 0; i < header.count; ++i) {
      lines_.need_line("an element");
      const Index place = in().place(), id = elements_.read(in(), "an element id");
      read_cell_nodes(in(), facts(header.shape).nodes, base_, mesh_);
      for (Index a = 0; a < header.attributes; ++a) in().real("an attribute");
      in().end_line("an element");
      mesh_.add_cell(id, place, header.shape, 0, header.order, lines_.file());
    }
  }

  void read_section() {
    const std::string keyword(in().token());
    if (keyword == "*MATERIAL") {
      read_material();
    } else if (keyword == "*SET") {
      read_set();
    } else if (keyword == "*REGION") {
      read_region();
    } else {
      in().refuse(SetupErrorKind::bad_file, "*MATERIAL, *SET or *REGION", TextReader::quoted(keyword));
    }
  }

  std::string read_name(std::string_view what) {
    const std::string name(in().token());
    if (name.empty()) in().refuse(SetupErrorKind::bad_file, what, TextReader::quoted(name));
    in().end_line(what);
    return name;
  }

  /// The constants are read to see that they are numbers, and left to the code that makes the model.
  void read_material() {
    materials_.insert(read_name("the name of a material"));
    lines_.need_line("a material such as ENU, density, E, nu");
    const std::string_view type = in().token();
    if (type.empty() || type.front() == '*')
      in().refuse(SetupErrorKind::bad_file, "a material such as ENU, density, E, nu", TextReader::quoted(type));
    while (!in().rest().empty()) in().real("a material constant");
  }

  /// The ids of the elements, on any number of lines up to the next keyword.
  void read_set() {
    const std::string name = read_name("the name of a set");
    if (sets_.contains(name)) in().refuse(SetupErrorKind::bad_file, "a new set", TextReader::quoted(name) + " again");
    std::vector<Index>& set = sets_[name];
    names_.push_back(name);
    const Index base = std::max<Index>(elements_.base(), 0), count = elements_.count();
    while (lines_.next_line()) {
      if (in().line().front() == '*') return lines_.hold();
      while (!in().rest().empty()) set.push_back(in().integer("an element id", base, base + count - 1) - base);
    }
  }

  /// `set, material`. A later region overrides an earlier one.
  void read_region() {
    in().end_line("*REGION");
    lines_.need_line("a set and a material");
    const std::string set(in().token()), material(in().token());
    if (!sets_.contains(set)) in().refuse(SetupErrorKind::bad_file, "a set of this file", TextReader::quoted(set));
    if (!materials_.contains(material))
      in().refuse(SetupErrorKind::bad_file, "a material of this file", TextReader::quoted(material));
    in().end_line("a region");
    regions_.push_back(set);
  }

  /// Gives every element the tag of the last region whose set holds it. Each set is walked once, however many regions
  /// name it.
  void put_regions(std::vector<std::vector<int>>& tags) {
    std::set<std::string> done;
    for (std::size_t r = regions_.size(); r-- > 0;) {
      if (!done.insert(regions_[r]).second) continue;
      const auto put = [&](std::size_t e) {
        if (tags[e].empty()) tags[e].push_back(static_cast<int>(r) + 1);
      };
      for (const Index e : sets_[regions_[r]]) put(static_cast<std::size_t>(e));
      if (regions_[r] == "allElements")
        for (std::size_t e = 0; e < tags.size(); ++e) put(e);
    }
  }

  /// Region r gets tag r + 1, set s a tag above those; both have the name of the set.
  void add_tags() {
    mesh_.last_region = static_cast<int>(regions_.size());
    std::vector<std::vector<int>> tags(mesh_.cells.size());
    for (std::size_t r = 0; r < regions_.size(); ++r) mesh_.names.push_back({3, static_cast<int>(r) + 1, regions_[r]});
    put_regions(tags);
    int tag = mesh_.last_region;
    for (const std::string& name : names_) {
      mesh_.names.push_back({3, ++tag, name});
      for (const Index e : sets_[name]) {
        auto& of_element = tags[static_cast<std::size_t>(e)];
        if (of_element.empty() || of_element.back() != tag) of_element.push_back(tag);
      }
    }
    std::map<std::vector<int>, std::uint32_t> known;
    for (std::size_t e = 0; e < tags.size(); ++e) mesh_.cells[e].tag_set = mesh_.set_of(known, tags[e]);
  }

  Lines lines_;
  FileMesh mesh_;
  Index base_ = 0;  ///< the id of the first vertex
  RowNumbers elements_;
  std::set<std::string> materials_;
  std::map<std::string, std::vector<Index>> sets_;
  std::vector<std::string> names_, regions_;  ///< sets in the order of the file; the set of every region
};

/// Reads a file; `include` fetches those it names. Every set is a group with its elements; the set of every *REGION is
/// a region; elements in none form the region "body". Errors: bad_file, index_out_of_range, non_finite, unsupported,
/// with file and line. Linear in the size of the texts but for the number of regions.
inline FileMesh parse(std::string_view text, const std::string& name, Include include) {
  return Parser(text, name, std::move(include)).parse();
}

/// Reads a file and those it includes, which lie in its folder.
inline FileMesh read(const std::string& path) {
  const auto folder = std::filesystem::path(path).parent_path();
  return parse(read_file(path), path, [&](const std::string& name) {
    const std::filesystem::path other = folder / name;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(other, ignored))
      raise(SetupErrorKind::bad_file, path + ": *INCLUDE " + name + ": there is no such file");
    return read_file(other.string());
  });
}

}}}  // namespace palpate::io::veg
