#include "self_test.hpp"

#include "catalogue.hpp"
#include "reports.hpp"

#include <cstdio>

namespace reliability {
namespace {

int failures = 0;
void expect(bool holds, const char* what) {
  if (holds) return;
  ++failures;
  std::printf("FAILED: %s\n", what);
}

/// Catch2 v2.13: a test that passes, one with two ids that fails in a section, and another that passes.
constexpr const char* planted_v2 = R"(<?xml version="1.0" encoding="UTF-8"?>
<Catch name="test_x" filters="[A1]">
  <Group name="test_x">
    <TestCase name="fine &amp; well" tags="[A1][extreme]" filename="x.cpp" line="1">
      <OverallResult success="true"/>
    </TestCase>
    <TestCase name="a &lt; b" tags="[A2][A3][extreme]" filename="x.cpp" line="2">
      <Section name="s">
        <Expression success="false" type="CHECK" filename="x.cpp" line="3">
          <Original>a &lt; b</Original>
        </Expression>
        <OverallResults successes="3" failures="1" expectedFailures="0"/>
      </Section>
      <OverallResult success="false">
        <StdOut>[A1] text</StdOut>
      </OverallResult>
    </TestCase>
    <TestCase name="also of A3" tags="[A3]" filename="x.cpp" line="9">
      <OverallResult success="true"/>
    </TestCase>
    <OverallResults successes="9" failures="1" expectedFailures="0"/>
  </Group>
</Catch>
)";
/// Catch2 v3, whose outermost element has another name.
constexpr const char* planted_v3 = R"(<?xml version="1.0" encoding="UTF-8"?>
<Catch2TestRun name="test_y" rng-seed="1" catch2-version="3.4.0" filters="[B1]">
  <TestCase name="v3 of Smoothed&lt;Tet4>" tags="[B1]" filename="y.cpp" line="1">
    <OverallResult success="true" skips="0"/>
  </TestCase>
  <OverallResults successes="1" failures="0" expectedFailures="0" skips="0"/>
</Catch2TestRun>
)";
/// A program that was killed in its second test.
constexpr const char* planted_crash = R"(<Catch name="test_z">
  <Group name="test_z">
    <TestCase name="before" tags="[B2]" filename="z.cpp" line="1">
      <OverallResult success="true"/>
    </TestCase>
    <TestCase name="killed" tags="[B3]" filename="z.cpp" line="2">
      <Section name="half)";
/// A program whose fatal signal Catch2 caught and reported.
constexpr const char* planted_signal = R"(<Catch name="test_w"><Group name="test_w">
    <TestCase name="segv" tags="[B4]" filename="w.cpp" line="2">
      <FatalErrorCondition filename="w.cpp" line="2">SIGSEGV</FatalErrorCondition>
      <OverallResult success="false"/>
    </TestCase>
  </Group></Catch>)";
constexpr const char* planted_junit = R"(<testsuite name="x" tests="3">
  <testcase name="extreme.E9.flags" classname="extreme.E9.flags" time="1" status="run"><system-out>a</system-out></testcase>
  <testcase name="extreme.E10.memory" classname="x" time="1" status="fail"><failure message="Failed"/></testcase>
  <testcase name="extreme.F1.cut" classname="x" time="0" status="notrun"><skipped message=""/></testcase>
</testsuite>)";

}  // namespace

int self_test() {
  std::vector<TestResult> all;
  const auto add = [&all](std::vector<TestResult> results) {
    for (TestResult& r : results) all.push_back(std::move(r));
  };
  bool v2 = false, v3 = false, crash = true, signal = false, empty = true;
  add(read_catch(planted_v2, "test_x", v2));
  add(read_catch(planted_v3, "test_y", v3));
  add(read_catch(planted_crash, "test_z", crash));
  add(read_catch(planted_signal, "test_w", signal));
  add(read_catch("", "test_none", empty));
  add(read_junit(planted_junit));
  expect(v2 && v3 && signal, "complete reports are detected as complete");
  expect(!crash && !empty, "truncated and missing reports are detected as incomplete");

  const auto standings = standings_of(all);
  const auto stands = [&](const char* id, int passed, int failed, const char* word) {
    const Standing& s = standings.at(id);
    std::printf("%s: %d passed, %d failed, %s\n", id, s.passed, s.failed, s.word());
    expect(s.passed == passed && s.failed == failed && std::string(s.word()) == word, id);
  };
  stands("A1", 1, 0, "passed");
  stands("A2", 0, 1, "FAILED");
  stands("A3", 1, 1, "FAILED");
  stands("A4", 0, 0, "absent");
  stands("B1", 1, 0, "passed");
  stands("B2", 1, 0, "passed");
  stands("B3", 0, 1, "FAILED");
  stands("B4", 0, 1, "FAILED");
  stands("E9", 1, 0, "passed");
  stands("E10", 0, 1, "FAILED");
  stands("F1", 0, 0, "absent");
  expect(standings.size() == catalogue.size(), "every extreme has a standing");
  expect(standings.at("A2").failures == std::vector<std::string>{"test_x: a < b"}, "a failure is named");
  std::printf("%d failures\n", failures);
  return failures == 0 ? 0 : 1;
}

}  // namespace reliability
