// Bad files: every row of the table has its expected result. `test_io "[table]"` prints the table.
#include "bad_files.hpp"

#include <cstdio>
#include <set>

using namespace palpate;
using test::BadFile;

namespace {

std::string edited(const BadFile& f) {
  return test::with(test::samples().at(f.format), f.from, f.to);
}

/// Bytes that do not print as \xHH, shortened.
std::string printable(const std::string& text, std::size_t length = 60) {
  std::string out;
  for (const char c : text.substr(0, length)) {
    char hex[8];
    std::snprintf(hex, sizeof hex, "\\x%02x", static_cast<unsigned>(static_cast<unsigned char>(c)));
    out += c == '\n' ? "\\n" : c == '|' ? "\\|" : c < ' ' || c > '~' ? std::string(hex) : std::string(1, c);
  }
  return out;
}

}  // namespace

TEST_CASE("Every sample is accepted", "[io]") {
  for (const auto& [format, text] : test::samples()) {
    INFO(format);
    CHECK(test::complaint(text, format) == "");
    CHECK(test::verdict(text, format) == "accepted");
  }
}

TEST_CASE("Every bad file is refused as expected", "[io][extreme][C2][C3][C5]") {
  std::set<std::pair<std::string, std::string>> distinct;
  std::size_t refused = 0;
  for (const BadFile& f : test::table::files) {
    INFO(f.format << ": '" << printable(f.from) << "' -> '" << printable(f.to) << "'");
    const std::string text = edited(f);
    CHECK(test::verdict(text, f.format) == f.verdict);
    refused += f.verdict == "accepted" ? 0 : 1;
    distinct.emplace(f.format, text);
  }
  CHECK(distinct.size() == test::table::files.size());  // no row is repeated
  CHECK(refused >= 200);
}

TEST_CASE("A refusal states the place, what was expected and what was found", "[io]") {
  for (const BadFile& f : test::table::files) {
    if (f.verdict == "accepted") continue;
    const std::string text = edited(f), message = test::complaint(text, f.format);
    INFO(f.format << ": '" << printable(f.from) << "' -> '" << printable(f.to) << "': " << message);
    CHECK(message.starts_with(f.verdict + ": "));
    CHECK(message.size() < 400);
    if (message.find("has two names") != message.npos || message.find("no file") != message.npos) continue;
    CHECK((message.find(": expected ") != message.npos && message.find(", found ") != message.npos));
    const bool has_place = message.find(":byte ") != message.npos || message.find_first_of("123456789") != message.npos;
    CHECK(has_place);
  }
}

TEST_CASE("The table of bad files", "[.][table]") {
  std::printf("| format | found in a good file | replaced by | result |\n|---|---|---|---|\n");
  for (const BadFile& f : test::table::files) {
    const std::string message = test::complaint(edited(f), f.format);
    std::printf("| %s | `%s` | `%s` | %s |\n", f.format.c_str(), printable(f.from).c_str(), printable(f.to).c_str(),
                message.empty() ? "accepted" : printable(message, 200).c_str());
  }
}
