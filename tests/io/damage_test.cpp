// Effects of text-level damage in every format: spellings of numbers, line ends, truncated files, random damage,
// locale.
#include "samples.hpp"

#include <algorithm>
#include <clocale>
#include <locale>
#include <random>

using namespace palpate;
using test::with;

namespace {

const std::string bad = "bad_file", not_finite = "non_finite", range = "index_out_of_range", other = "unsupported",
                  good = "accepted";

std::string replace_all(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

bool is_text(const std::string& format) {
  return format.find("binary") == std::string::npos;
}
bool is_gmsh(const std::string& format) {
  return format.starts_with("msh");
}
/// Whether the last line of the sample needs no line end.
bool has_end(const std::string& format) {
  return is_gmsh(format) || format == "abaqus" || format == "medit";
}

const std::vector<std::pair<std::string, std::string>> spellings{
    {"nan 1 1", not_finite},   {"NaN 1 1", not_finite}, {"inf 1 1", not_finite}, {"-infinity 1 1", not_finite},
    {"1e400 1 1", not_finite}, {"1e-400 1 1", good},    {"1e-310 1 1", good},    {"0x1p3 1 1", bad},
    {"1,5 1 1", bad},          {"1 5 1 1", bad},        {"1.5 1", bad},          {"1.5d0 1 1", bad},
    {"1.5x 1 1", bad},         {"1.5.0 1 1", bad},      {"--1.5 1 1", bad},      {"+-1.5 1 1", bad},
    {"\"1.5\" 1 1", bad},      {"1.5 1 1 1", bad},      {"1e 1 1", bad},         {"- 1 1", bad},
    {"\x01 1 1", bad},         {"\xff\xff 1 1", bad},   {"+1.5e+00 1. 1", good}, {"-1.5E3 -0 1", good},
    {"1.5\t1\v1 \r", good},
};

}  // namespace

TEST_CASE("Coordinates are plain finite decimals", "[io][extreme][C3]") {
  for (const auto& [spelling, expected] : spellings)
    for (const auto& [format, text] : test::samples()) {
      if (!is_text(format) || format == "veg" || format == "abaqus") continue;
      INFO(format << ": " << spelling);
      const bool flows = format.starts_with("vtk") && spelling == "1.5 1";  // the next line fills in
      const std::string damaged = std::string(text).replace(text.rfind("1.5 1 1"), 7, spelling);
      CHECK(test::verdict(damaged, format) == (flows ? bad : expected));
    }
}

TEST_CASE("Unsupported Gmsh formats are refused with their name and the command that converts them",
          "[io][extreme][C5]") {
  for (const std::string& base : {test::msh2, test::msh4}) {
    const std::string format = base.substr(12, 7);
    for (const auto& [to, expected] : std::vector<std::pair<std::string, std::string>>{{"4 0 8", other},
                                                                                       {"4.0 0 8", other},
                                                                                       {"4.2 0 8", other},
                                                                                       {"3 0 8", other},
                                                                                       {"1 0 8", other},
                                                                                       {"2.2 1 8", bad},
                                                                                       {"4.1 1 8", bad},
                                                                                       {"4.1 2 8", range},
                                                                                       {"nan 0 8", not_finite},
                                                                                       {"2,2 0 8", bad},
                                                                                       {"2.2 0", bad},
                                                                                       {"2.2", bad}}) {
      INFO(to);
      CHECK(test::verdict(with(base, format, to)) == expected);
    }
    CHECK(test::verdict(with(base, "$EndMeshFormat\n", "")) == bad);
  }
  CHECK(test::verdict(with(test::msh2, "2.2 0 8", "2 0 8")) == good);
  CHECK(test::verdict(with(test::msh2, "2.2 0 8", "4.1 0 8")) == bad);
  CHECK(test::verdict(with(test::msh4, "4.1 0 8", "2.2 0 8")) == bad);
  CHECK(test::complaint(with(test::msh4, "4.1 0 8", "4 0 8")) ==
        "unsupported: mesh:2: expected MSH 1, 2.2 or 4.1, found MSH 4. "
        "Convert it: gmsh mesh -save -format msh41 -o converted.msh");
  CHECK(test::verdict("# vtk DataFile Version 4.2\n") == bad);
  CHECK(test::verdict(std::string("\0\0\0\0$MeshFormat", 15)) == bad);
  CHECK(test::verdict("\xff\xfe$\0M\0") == bad);
  CHECK(test::verdict("") == bad);
  CHECK(test::verdict("\n\n  \n") == bad);
}

TEST_CASE("Line ends, tabs, blanks, marks and long lines do not matter", "[io][extreme][C5]") {
  for (const auto& [format, base] : test::samples()) {
    if (!is_text(format)) continue;
    INFO(format);
    const std::string blanks(1000000, ' ');
    CHECK(test::verdict(replace_all(base, "\n", "\r\n"), format) == good);
    if (!format.starts_with("vtk")) CHECK(test::verdict(replace_all(base, "\n", "\n\n \t\n"), format) == good);
    CHECK(test::verdict(replace_all(base, "\n", "  \n\t "), format) == (has_end(format) ? good : bad));
    CHECK(test::verdict("\xEF\xBB\xBF" + base, format) == good);
    CHECK(test::verdict(replace_all(base, "1.5", blanks + "1.5" + blanks), format) == good);
    CHECK(test::verdict(replace_all(base, "1.5", std::string(1000000, '1')), format) == not_finite);
    CHECK(test::verdict(replace_all(base, "1.5", std::string(1000000, 'x')), format) == bad);
    CHECK(test::verdict(replace_all(base, "\n", "\r"), format) == (format == "medit" ? good : bad));  // a blank
    CHECK(test::verdict(replace_all(base, "\n", ""), format) != good);
    CHECK(test::verdict(base.substr(0, base.size() - 1), format) == (has_end(format) ? good : bad));
  }
  CHECK(test::verdict(replace_all(test::msh2, " 1 ", "\t1\t")) == good);
}

TEST_CASE("A text read as another format is refused", "[io][extreme][C5]") {
  for (const auto& [format, base] : test::samples())
    for (const auto& [wanted, ignored] : test::samples()) {
      if (format.substr(0, 3) == wanted.substr(0, 3)) continue;
      INFO(format << " as " << wanted);
      CHECK(test::verdict(base, wanted) != good);
      CHECK(test::verdict(base, wanted) != "unsound");
    }
}

TEST_CASE("A mesh without the requested solids is refused with a hint", "[io]") {
  const auto surface =
      with(with(test::msh2, "3 4 2 1 1 1 2 3 4\n4 4 2 1 1 2 3 4 5\n", ""), "Elements\n4", "Elements\n2");
  CHECK(test::verdict(surface) == other);
  CHECK_THAT(test::complaint(surface),
             test::contains("found a surface of 1 faces") && test::contains("gmsh solid.geo -3"));
  const auto point = with(with(surface, "2 2 2 2 1 1 3 2\n", ""), "Elements\n2", "Elements\n1");
  CHECK(test::verdict(point) == "empty_mesh");
  const auto tet10 = with(test::msh2, "4 4 2 1 1 2 3 4 5", "4 11 2 1 1 2 3 4 5 1 2 3 4 5 1");
  CHECK_THAT(test::complaint(tet10), test::contains("mesh:23: expected a 4-node tetrahedron, "
                                                    "found a 10-node tetrahedron"));
}

TEST_CASE("A refusal states file, line, what was expected and what was found", "[io]") {
  CHECK(test::complaint(with(test::msh2, "1.5 1 1", "1,5 1 1")) ==
        "bad_file: mesh:16: expected a coordinate, found '1,5'");
  CHECK(test::complaint(with(test::msh2, "2 3 4 5\n", "2 3 4 6\n")) ==
        "index_out_of_range: mesh:23: expected a node id between 1 and 5, found '6'");
  CHECK_THAT(test::complaint(with(test::msh2, "Nodes\n5", "Nodes\n999")),
             test::contains("mesh:11: expected a number of nodes between"));
  CHECK(test::complaint(test::msh2.substr(0, 30)) == "bad_file: mesh:3: expected $EndMeshFormat, found '$EndMeshFo'");
  CHECK(test::complaint(with(test::msh2, "4 4 2 1 1", "4 " + std::string(100, '\a'))) ==
        "bad_file: mesh:23: expected an element type, found '" + std::string(40, '?') + "...'");
  const auto& all = test::samples();
  CHECK(test::complaint(with(all.at("tetgen"), "2 2 3 4 5 1", "2 2 3 4 9 1"), "tetgen") ==
        "index_out_of_range: mesh.ele:3: expected a node id between 1 and 5, found '9'");
  CHECK(test::complaint(with(all.at("veg"), "1.5 1 1", "1,5 1 1"), "veg") ==
        "bad_file: mesh:8: expected the end of the line after a node, found '1'");
  CHECK(test::complaint(with(all.at("vtk2"), "\n4 1 2 3 4", "\n4 1 2 3 7"), "vtk2") ==
        "index_out_of_range: mesh:16: expected a node between 0 and 4, found '7'");
  CHECK(test::complaint(with(all.at("msh2 binary"), test::f64(1.5), test::f64(infinity)), "msh2 binary")
            .starts_with("non_finite: mesh:byte 2"));
}

TEST_CASE("No truncated file is accepted", "[io][extreme][C1]") {
  for (const auto& [format, base] : test::samples()) {
    INFO(format);
    const std::size_t types = base.find("10 10 \n"), binary_types = base.find("\n\nCELL_DATA");
    std::size_t accepted = 0, unsound = 0;
    for (std::size_t size = 0; size <= base.size(); ++size) {
      const std::string copy =
          base.substr(0, size);  // a separate copy of the text, so that a sanitizer detects reads beyond its end
      const std::string found = test::verdict(copy, format);
      unsound += found == "unsound" ? 1 : 0;
      if (found != good) continue;
      ++accepted;
      INFO(size << " of " << base.size() << " bytes");
      // In formats without an end mark, only whole lines after the elements may be missing; in Abaqus, which has no
      // counts, also lines of elements.
      if (is_gmsh(format)) CHECK(size + 1 >= base.size());
      if (format.starts_with("vtk")) CHECK(size >= std::min(types, binary_types));
      if (format == "veg") CHECK((size > base.find("\n\n*MATERIAL") && copy.back() == '\n'));
      if (format == "abaqus")
        CHECK((size > base.find("    30") && (copy.back() == '\n' || copy[copy.rfind('\n') + 1] == '*')));
      // A text without End is accepted with a note, if its last line is whole.
      if (format == "medit") CHECK((size + 5 >= base.size() && (size + 1 >= base.size() || copy.back() == '\n')));
      if (format.starts_with("medit binary")) CHECK(size + 8 >= base.size());  // the end without its position
      if (format.starts_with("tetgen"))
        CHECK((size >= base.rfind('\x1f') && (copy.back() == '\n' || copy.back() == '\x1f')));
    }
    CHECK(accepted >= 1);
    if (is_gmsh(format)) CHECK(accepted == 2);  // all of it, and all but the last line end
    CHECK(unsound == 0);
  }
  for (const char* name : {"mesh_v22.msh", "mesh_v41.msh"}) {
    const std::string text = io::read_file(PALPATE_TEST_DATA "/oracle/A_two_cubes/tet4/" + std::string(name));
    std::size_t accepted = 0;
    for (std::size_t size = 0; size + 1 < text.size(); ++size)
      accepted += test::verdict(text.substr(0, size)) == good ? 1 : 0;
    CHECK(accepted == 0);
  }
}

TEST_CASE("Random damage is refused or harmless", "[io][extreme][C2]") {
  std::mt19937 random(20240131);
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  const std::string bytes = "0123456789-+.,eE $\"\n\r\tNadx\x01\x80";
  std::size_t unsound = 0;
  for (const auto& [format, base] : test::samples())
    for (int i = 0; i < 4000; ++i) {
      std::string text = base;
      for (std::size_t edits = 1 + below(4); edits > 0; --edits) {
        const std::size_t at = below(text.size());
        switch (below(4)) {
          case 0:
            text[at] = bytes[below(bytes.size())];
            break;
          case 1:
            text.insert(at, 1, bytes[below(bytes.size())]);
            break;
          case 2:
            text.erase(at, 1 + below(8));
            break;
          default:
            text.insert(at, text.substr(below(text.size()), 1 + below(16)));
            break;
        }
      }
      unsound += test::verdict(text, format) == "unsound" ? 1 : 0;
    }
  CHECK(unsound == 0);
}

TEST_CASE("A few bytes cannot cause large memory use or long run time", "[io][extreme][C2]") {
  // Every one of 3000 elements in 3000 groups: 30 kB of text, 9 million memberships.
  std::string tags, elements, names;
  for (int i = 1; i <= 3000; ++i) tags += ' ' + std::to_string(i);
  for (int i = 1; i <= 3000; ++i) elements += std::to_string(i) + " 1 2 3 4\n";
  auto text = with(test::msh4, "1 1 1 1\n$EndEnt", "3000" + tags + " 0\n$EndEnt");
  text = with(text, "3 1 4 2\n3 1 2 3 4\n4 2 3 4 5\n", "3 1 4 3000\n" + elements);
  text = with(text, "3 4 1 4\n", "3 3002 1 4\n");
  CHECK(test::complaint(text).find("expected elements in groups at most") != std::string::npos);

  for (int i = 1; i <= 10001; ++i) names += "2 " + std::to_string(i + 10) + " \"g" + std::to_string(i) + "\"\n";
  CHECK(test::verdict(with(test::msh2, "3\n0 3 \"tip\"\n", "10004\n0 3 \"tip\"\n" + names)) == "count_too_large");

  std::string ranges = "*Nset, nset=all\n", numbers = "*Elset, elset=some\n";
  for (int i = 0; i < 300; ++i) ranges += "*Nset, nset=all, generate\n10, 99, 2\n";
  for (int i = 0; i < 300; ++i) numbers += "*Elset, elset=some\nsome, some\n";
  CHECK(test::verdict(test::abaqus + ranges, "abaqus") == good);
  CHECK(test::verdict(test::abaqus + numbers, "abaqus") == good);
  numbers = with(numbers, "=some\n", "=some\n7\n");
  CHECK(test::complaint(test::abaqus + numbers, "abaqus").find("sets at most") != std::string::npos);

  std::string regions;
  for (int i = 0; i < 9000; ++i) regions += "*REGION\nallElements, soft\n";
  CHECK(test::verdict(test::samples().at("veg") + regions, "veg") == good);
}

TEST_CASE("The locale of the process does not matter", "[io][extreme][C4]") {
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const std::string before = std::setlocale(LC_ALL, nullptr);
  const std::locale old = std::locale::global(std::locale(std::locale::classic(), new Comma));
  if (std::setlocale(LC_ALL, "de_DE.UTF-8") == nullptr)
    WARN("de_DE.UTF-8 is not installed: only C++ streams use a comma");
  const auto mesh = io::parse_mesh<Tet4>(test::msh2);
  const std::string comma = test::verdict(with(test::msh2, "1.5", "1,5")), text = io::to_decimal(1234567.5);
  const std::string message = test::complaint(test::msh2.substr(0, 40));
  std::map<std::string, std::string> verdicts, with_comma;
  for (const auto& [format, sample] : test::samples()) {
    verdicts[format] = test::verdict(sample, format);
    with_comma[format] = test::verdict(replace_all(sample, "1.5", "1,5"), format);
  }
  std::locale::global(old);
  std::setlocale(LC_ALL, before.c_str());
  for (const auto& [format, verdict] : verdicts) {
    INFO(format);
    CHECK(verdict == good);
    CHECK(with_comma[format] == (is_text(format) ? bad : good));  // binary files contain no decimals to damage
  }
  CHECK(mesh.positions[4] == Vector3(1.5, 1.0, 1.0));
  CHECK(comma == bad);
  CHECK(text == "1234567.5");
  CHECK(message == test::complaint(test::msh2.substr(0, 40)));
}
