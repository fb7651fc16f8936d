// What a bad file gets: every line of the corpus has its verdict.
#include "gmsh_samples.hpp"

#include <clocale>
#include <locale>
#include <random>

using namespace palpate;
using test::with;

namespace {

struct Edit {
  std::string from, to, verdict;
};

const std::string bad = "bad_file", range = "index_out_of_range", count = "count_too_large", not_finite = "non_finite",
                  other = "unsupported", good = "accepted";

void check_corpus(const std::string& base, const std::vector<Edit>& corpus) {
  REQUIRE(test::verdict(base) == good);
  for (const Edit& edit : corpus) {
    INFO("'" << edit.from << "' -> '" << edit.to << "'");
    CHECK(test::verdict(with(base, edit.from, edit.to)) == edit.verdict);
  }
}

std::string replace_all(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

const std::vector<std::pair<std::string, std::string>> spellings{
    {"nan 1 1", not_finite},   {"NaN 1 1", not_finite},    {"inf 1 1", not_finite}, {"-infinity 1 1", not_finite},
    {"1e400 1 1", not_finite}, {"1e-400 1 1", not_finite}, {"1e-310 1 1", good},    {"0x1p3 1 1", bad},
    {"1,5 1 1", bad},          {"1 5 1 1", bad},           {"1.5 1", bad},          {"1.5d0 1 1", bad},
    {"1.5x 1 1", bad},         {"1.5.0 1 1", bad},         {"--1.5 1 1", bad},      {"+-1.5 1 1", bad},
    {"\"1.5\" 1 1", bad},      {"1.5 1 1 1", bad},         {"1e 1 1", bad},         {"- 1 1", bad},
    {"\x01 1 1", bad},         {"\xff\xff 1 1", bad},      {"+1.5e+00 1. 1", good}, {"-1.5E3 -0 1", good},
    {"1.5\t1\v1 \r", good},
};

}  // namespace

TEST_CASE("Coordinates are plain finite decimals", "[io][extreme][C3]") {
  for (const auto& [spelling, expected] : spellings) {
    INFO(spelling);
    CHECK(test::verdict(with(test::msh2, "5 1.5 1 1\n", "5 " + spelling + "\n")) == expected);
    CHECK(test::verdict(with(test::msh4, "\n1.5 1 1\n", "\n" + spelling + "\n")) == expected);
  }
}

TEST_CASE("MSH 2: wrong counts, indices and words", "[io][extreme][C2]") {
  check_corpus(test::msh2, {
                               {"Nodes\n5", "Nodes\n4", bad},
                               {"Nodes\n5", "Nodes\n6", bad},
                               {"Nodes\n5", "Nodes\n-4", count},
                               {"Nodes\n5", "Nodes\n2000000000", count},
                               {"Nodes\n5", "Nodes\n99999999999999999999999", count},
                               {"Nodes\n5", "Nodes\n5.0", bad},
                               {"Nodes\n5", "Nodes\nfive", bad},
                               {"Nodes\n5", "Nodes\n5 5", bad},
                               {"Nodes\n5", "Nodes", bad},
                               {"5 1.5", "0 1.5", range},
                               {"5 1.5", "-5 1.5", range},
                               {"5 1.5", "4 1.5", bad},
                               {"5 1.5", "99999999999999999999999 1.5", range},
                               {"Elements\n4", "Elements\n3", bad},
                               {"Elements\n4", "Elements\n5", bad},
                               {"Elements\n4", "Elements\n-1", count},
                               {"Elements\n4", "Elements\n4000000000", count},
                               {"2 3 4 5\n", "2 3 4 0\n", range},
                               {"2 3 4 5\n", "2 3 4 -1\n", range},
                               {"2 3 4 5\n", "2 3 4 6\n", range},
                               {"2 3 4 5\n", "2 3 4 999999999999\n", range},
                               {"2 3 4 5\n", "2 3 4\n", bad},
                               {"2 3 4 5\n", "2 3 4 5 6\n", bad},
                               {"2 3 4 5\n", "2 3 4 5.5\n", bad},
                               {"4 4 2 1 1", "4 4 3 1 1", bad},
                               {"4 4 2 1 1", "4 4 -2 1 1", count},
                               {"4 4 2 1 1", "4 4 2000000000 1 1", bad},
                               {"4 4 2 1 1", "4 4 2 99999999999 1", range},
                               {"4 4 2 1 1", "4 4 2 -1 1", good},
                               {"4 4 2 1 1", "4 4 4 1 1 1 1", good},
                               {"4 4 2 1 1", "4 0 2 1 1", range},
                               {"4 4 2 1 1", "4 -4 2 1 1", range},
                               {"4 4 2 1 1", "4 77 2 1 1", other},
                               {"4 4 2 1 1", "0 4 2 1 1", range},
                               {"4 4 2 1 1 2 3 4 5", "4 11 2 1 1 2 3 4 5 1 2 3 4 5 1", other},
                               {"4 4 2 1 1 2 3 4 5", "4 5 2 1 1 2 3 4 5 1 2 3 4", other},
                               {"4 4 2 1 1 2 3 4 5", "4 7 2 1 1 2 3 4 5 1", other},
                               {"2 2 2 2 1 1 3 2", "2 3 2 2 1 1 3 2 4", other},
                               {"2 2 2 2 1 1 3 2", "2 3 2 0 1 1 3 2 4", good},
                               {"3\n0 3", "2\n0 3", bad},
                               {"3\n0 3", "4\n0 3", bad},
                               {"3\n0 3", "-1\n0 3", count},
                               {"3\n0 3", "1000000\n0 3", count},
                               {"\"tip\"", "tip", bad},
                               {"\"tip\"", "\"tip", bad},
                               {"\"tip\"", "\"\"", bad},
                               {"\"tip\"", "", bad},
                               {"\"tip\"", "\"the tip, of it\"", good},
                               {"0 3 \"tip\"", "3 1 \"tip\"", bad},
                               {"0 3 \"tip\"", "4 3 \"tip\"", range},
                               {"0 3 \"tip\"", "-1 3 \"tip\"", range},
                               {"$EndNodes", "$EndNode", bad},
                               {"$EndNodes\n", "", bad},
                               {"$EndElements\n", "", bad},
                               {"$Elements\n", "", bad},
                               {"$Nodes", "$Knots", bad},
                               {"$Nodes", "Nodes", bad},
                               {"$EndNodes", "$EndNodes\n$Nodes\n0\n$EndNodes", bad},
                               {"$EndElements", "$EndElements\n$Elements\n0\n$EndElements", bad},
                               {"$EndElements", "$EndElements\nthe end", bad},
                               {"$EndElements", "$EndElements\n$NodeData\n1", bad},
                           });
}

TEST_CASE("MSH 4.1: wrong counts, indices and words", "[io][extreme][C2]") {
  check_corpus(test::msh4, {
                               {"\n2 5 1 5\n", "\n1 5 1 5\n", bad},
                               {"\n2 5 1 5\n", "\n3 5 1 5\n", bad},
                               {"\n2 5 1 5\n", "\n2 4 1 5\n", bad},
                               {"\n2 5 1 5\n", "\n2 6 1 5\n", bad},
                               {"\n2 5 1 5\n", "\n2 4000000000 1 5\n", count},
                               {"\n2 5 1 5\n", "\n2000000000 5 1 5\n", count},
                               {"\n2 5 1 5\n", "\n-2 5 1 5\n", count},
                               {"\n2 5 1 5\n", "\n2 5\n", bad},
                               {"\n2 1 0 3\n", "\n2 1 0 2\n", bad},
                               {"\n2 1 0 3\n", "\n2 1 0 4\n", range},
                               {"\n2 1 0 3\n", "\n2 1 0 99999999\n", count},
                               {"\n2 1 0 3\n", "\n2 1 1 3\n", bad},
                               {"\n2 1 0 3\n", "\n4 1 0 3\n", range},
                               {"\n2 1 0 3\n", "\n2 1 2 3\n", range},
                               {"\n3\n0 0 0\n", "\n0\n0 0 0\n", range},
                               {"\n3\n0 0 0\n", "\n2\n0 0 0\n", bad},
                               {"\n3\n0 0 0\n", "\n3 3\n0 0 0\n", bad},
                               {"\n3 4 1 4\n", "\n2 4 1 4\n", bad},
                               {"\n3 4 1 4\n", "\n4 4 1 4\n", bad},
                               {"\n3 4 1 4\n", "\n3 5 1 4\n", bad},
                               {"\n3 4 1 4\n", "\n3 -4 1 4\n", count},
                               {"\n3 1 4 2\n", "\n3 1 4 1\n", bad},
                               {"\n3 1 4 2\n", "\n3 1 4 3\n", bad},
                               {"\n3 1 4 2\n", "\n3 1 4 1000000\n", count},
                               {"\n3 1 4 2\n", "\n3 2 4 2\n", range},
                               {"\n3 1 4 2\n", "\n2 1 4 2\n", bad},
                               {"\n3 1 4 2\n", "\n3 1 6 2\n", bad},
                               {"\n3 1 4 2\n", "\n3 1 44 2\n", other},
                               {"4 2 3 4 5\n", "4 2 3 4 0\n", range},
                               {"4 2 3 4 5\n", "4 2 3 4 6\n", range},
                               {"4 2 3 4 5\n", "4 2 3 4\n", bad},
                               {"4 2 3 4 5\n", "4 2 3 4 5 1\n", bad},
                               {"Entities\n1 0 1 1", "Entities\n2 0 1 1", bad},
                               {"Entities\n1 0 1 1", "Entities\n1 0 1 1000", count},
                               {"Entities\n1 0 1 1", "Entities\n1 0 1", bad},
                               {"5 1.5 1 1 1 3", "5 1.5 1 1 2 3", bad},
                               {"5 1.5 1 1 1 3", "5 1.5 1 1 0", good},
                               {"5 1.5 1 1 1 3", "5 1.5 1 1 1 -3", good},
                               {"5 1.5 1 1 1 3", "5 1.5 1 1 -1 3", count},
                               {"5 1.5 1 1 1 3", "5 1.5", bad},
                               {"1 1 1 1\n$EndEnt", "1 1 1 1000000 1\n$EndEnt", bad},
                               {"1.5 1 1 1 1 1 1\n$EndEnt", "1e+309 1 1 1 1 1 1\n$EndEnt", good},
                               {"1 0 0 0 1 1 0 1 2 0\n", "1 0 0 0 1 1 0 1 2 0\n1 0 0 0 1 1 0 1 2 0\n", bad},
                               {"$Entities", "$PartitionedEntities", other},
                           });
}

TEST_CASE("Formats that are not read are named, with the command that converts them", "[io][extreme][C5]") {
  for (const std::string& base : {test::msh2, test::msh4}) {
    const std::string format = base.substr(12, 7);
    check_corpus(base, {{format, "4 0 8", other},
                        {format, "4.0 0 8", other},
                        {format, "4.2 0 8", other},
                        {format, "3 0 8", other},
                        {format, "1 0 8", other},
                        {format, "2.2 1 8", other},
                        {format, "4.1 1 8", other},
                        {format, "4.1 2 8", range},
                        {format, "nan 0 8", not_finite},
                        {format, "2,2 0 8", bad},
                        {format, "2.2 0", bad},
                        {format, "2.2", bad},
                        {"$EndMeshFormat\n", "", bad}});
  }
  CHECK(test::verdict(with(test::msh2, "2.2 0 8", "2 0 8")) == good);
  CHECK(test::verdict(with(test::msh2, "2.2 0 8", "4.1 0 8")) == bad);
  CHECK(test::verdict(with(test::msh4, "4.1 0 8", "2.2 0 8")) == bad);
  const std::string msh1 = "$NOD\n1\n1 0 0 0\n$ENDNOD\n$ELM\n1\n1 15 1 1 1 1\n$ENDELM\n";
  CHECK(test::complaint(msh1) ==
        "unsupported: mesh:1: expected MSH 2.2 or 4.1, found MSH 1. "
        "Convert it: gmsh mesh -save -format msh41 -setnumber Mesh.Binary 0 -o converted.msh");
  CHECK(test::verdict("# vtk DataFile Version 4.2\n") == bad);
  CHECK(test::verdict(std::string("\0\0\0\0$MeshFormat", 15)) == bad);
  CHECK(test::verdict("\xff\xfe$\0M\0") == bad);
  CHECK(test::verdict("") == bad);
  CHECK(test::verdict("\n\n  \n") == bad);
}

TEST_CASE("Line ends, tabs, blanks, marks and long lines do not matter", "[io][extreme][C5]") {
  for (const std::string& base : {test::msh2, test::msh4}) {
    CHECK(test::verdict(replace_all(base, "\n", "\r\n")) == good);
    CHECK(test::verdict(replace_all(base, "\n", "\n\n \t\n")) == good);
    CHECK(test::verdict(replace_all(base, "\n", "  \n\t ")) == good);
    CHECK(test::verdict("\xEF\xBB\xBF" + base) == good);
    CHECK(test::verdict(base.substr(0, base.size() - 1)) == good);
    CHECK(test::verdict(with(base, "Nodes\n", "Nodes" + std::string(1000000, ' ') + "\n")) == good);
    CHECK(test::verdict(with(base, "$Nodes", std::string(1000000, 'x') + "\n$Nodes")) == bad);
    CHECK(test::verdict(replace_all(base, "\n", "\r")) == bad);
    CHECK(test::verdict(replace_all(base, "\n", "")) == bad);
  }
  CHECK(test::verdict(replace_all(test::msh2, " 1 ", "\t1\t")) == good);
}

TEST_CASE("A mesh without the wanted solids says what to do", "[io]") {
  const auto surface =
      with(with(test::msh2, "3 4 2 1 1 1 2 3 4\n4 4 2 1 1 2 3 4 5\n", ""), "Elements\n4", "Elements\n2");
  CHECK(test::verdict(surface) == other);
  CHECK_THAT(test::complaint(surface),
             test::contains("found a surface of 1 faces") && test::contains("gmsh solid.geo -3"));
  const auto point = with(with(surface, "2 2 2 2 1 1 3 2\n", ""), "Elements\n2", "Elements\n1");
  CHECK(test::verdict(point) == "empty_mesh");
  const auto tet10 = with(test::msh2, "4 4 2 1 1 2 3 4 5", "4 11 2 1 1 2 3 4 5 1 2 3 4 5 1");
  CHECK_THAT(test::complaint(tet10), test::contains("mesh:23: expected type 4 (4-node tetrahedron), "
                                                    "found type 11 (10-node tetrahedron)"));
}

TEST_CASE("A refusal names file, line, what was expected and what was found", "[io]") {
  CHECK(test::complaint(with(test::msh2, "1.5 1 1", "1,5 1 1")) ==
        "bad_file: mesh:16: expected a coordinate, found '1,5'");
  CHECK(test::complaint(with(test::msh2, "2 3 4 5\n", "2 3 4 6\n")) ==
        "index_out_of_range: mesh:23: expected a node id between 1 and 5, found '6'");
  CHECK_THAT(test::complaint(with(test::msh2, "Nodes\n5", "Nodes\n999")),
             test::contains("mesh:11: expected a number of nodes between"));
  CHECK(test::complaint(test::msh2.substr(0, 30)) == "bad_file: mesh:3: expected $EndMeshFormat, found '$EndMeshFo'");
  CHECK(test::complaint(with(test::msh2, "4 4 2 1 1", "4 " + std::string(100, '\a'))) ==
        "bad_file: mesh:23: expected an element type, found '" + std::string(40, '?') + "...'");
}

TEST_CASE("No prefix of a file is taken for a file", "[io][extreme][C1]") {
  for (const std::string& base : {test::msh2, test::msh4}) {
    std::size_t accepted = 0, unsound = 0;
    for (std::size_t size = 0; size <= base.size(); ++size) {
      const std::string copy = base.substr(0, size);  // a text of its own, so that a sanitizer sees its end
      const std::string found = test::verdict(copy);
      accepted += found == good ? 1 : 0;
      unsound += found == "unsound" ? 1 : 0;
    }
    CHECK(accepted == 2);  // all of it, and all but the last line end
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
  for (int i = 0; i < 20000; ++i) {
    std::string text = i % 2 == 0 ? test::msh2 : test::msh4;
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
    unsound += test::verdict(text) == "unsound" ? 1 : 0;
  }
  CHECK(unsound == 0);
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
  std::locale::global(old);
  std::setlocale(LC_ALL, before.c_str());
  CHECK(mesh.positions[4] == Vector3(1.5, 1.0, 1.0));
  CHECK(comma == bad);
  CHECK(text == "1234567.5");
  CHECK(message == test::complaint(test::msh2.substr(0, 40)));
}
