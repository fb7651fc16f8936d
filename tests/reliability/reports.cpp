#include "reports.hpp"

#include "catalogue.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace reliability {
namespace {

/// Reads XML one tag at a time; text between tags and comments are ignored.
class Tags {
 public:
  explicit Tags(const std::string& xml) : xml_(xml) {}
  /// The next tag without its brackets; false at the end, and when a tag is truncated.
  bool next(std::string& tag) {
    const std::size_t begin = xml_.find('<', at_);
    if (begin == std::string::npos) return false;
    if (xml_.compare(begin, 9, "<![CDATA[") == 0) {
      const std::size_t end = xml_.find("]]>", begin);
      if (end == std::string::npos) return false;
      at_ = end + 3;
      return next(tag);
    }
    std::size_t end = begin;
    for (bool quoted = false; end < xml_.size() && (quoted || xml_[end] != '>'); ++end)
      quoted = quoted != (xml_[end] == '"');  // Catch2 does not escape > in attributes
    if (end >= xml_.size()) return false;
    tag = xml_.substr(begin + 1, end - begin - 1);
    at_ = end + 1;
    return true;
  }

 private:
  const std::string& xml_;
  std::size_t at_ = 0;
};

bool is(const std::string& tag, const std::string& name) {
  return tag.compare(0, name.size(), name) == 0 &&
         (tag.size() == name.size() || tag[name.size()] == ' ' || tag[name.size()] == '/' || tag[name.size()] == '\n');
}

std::string attribute(const std::string& tag, const std::string& name) {
  const std::size_t begin = tag.find(' ' + name + "=\"");
  if (begin == std::string::npos) return {};
  const std::size_t from = begin + name.size() + 3, end = tag.find('"', from);
  std::string value = tag.substr(from, end == std::string::npos ? end : end - from);
  for (const auto& [code, letter] : {std::pair{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&amp;", "&"}})
    for (std::size_t p = 0; (p = value.find(code, p)) != std::string::npos; ++p)
      value.replace(p, std::string(code).size(), letter);
  return value;
}

/// "[A1][contact]" gives A1 and contact.
std::vector<std::string> split_tags(const std::string& text) {
  std::vector<std::string> tags;
  for (std::size_t at = 0; (at = text.find('[', at)) != std::string::npos;) {
    const std::size_t end = text.find(']', at);
    if (end == std::string::npos) break;
    tags.push_back(text.substr(at + 1, end - at - 1));
    at = end;
  }
  return tags;
}

}  // namespace

std::vector<TestResult> read_catch(const std::string& xml, const std::string& program, bool& ended) {
  std::vector<TestResult> results;
  bool open = false;
  ended = false;
  Tags tags(xml);
  for (std::string tag; tags.next(tag);) {
    if (is(tag, "TestCase")) {
      results.push_back({program, attribute(tag, "name"), split_tags(attribute(tag, "tags")), false});
      open = true;
    } else if (is(tag, "OverallResult") && open) {
      results.back().passed = attribute(tag, "success") == "true";
    } else if (is(tag, "/TestCase")) {
      open = false;
    } else if (is(tag, "FatalErrorCondition") && open) {
      results.back().passed = false;
    } else if (is(tag, "/Catch") || is(tag, "/Catch2TestRun")) {
      ended = !open;
    }
  }
  return results;
}

std::vector<TestResult> read_junit(const std::string& xml) {
  std::vector<TestResult> results;
  Tags tags(xml);
  for (std::string tag; tags.next(tag);) {
    if (!is(tag, "testcase")) continue;
    const std::string name = attribute(tag, "name"), status = attribute(tag, "status");
    if (status != "run" && status != "fail") continue;
    const std::size_t first = name.find('.'), second = name.find('.', first + 1);
    std::vector<std::string> ids;
    if (name.compare(0, 8, "extreme.") == 0) ids.push_back(name.substr(first + 1, second - first - 1));
    results.push_back({"ctest", name, ids, status == "run"});
  }
  return results;
}

std::string read_text(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::map<std::string, Standing> standings_of(const std::vector<TestResult>& results) {
  std::map<std::string, Standing> standings;
  for (const Extreme& e : catalogue) {
    Standing& s = standings[std::string(e.id)];
    for (const TestResult& r : results) {
      if (std::find(r.tags.begin(), r.tags.end(), e.id) == r.tags.end()) continue;
      ++(r.passed ? s.passed : s.failed);
      if (!r.passed) s.failures.push_back(r.program + ": " + r.name);
    }
  }
  return standings;
}

}  // namespace reliability
