// The list of contact points compared with a search over all of its entries.
#include <palpate/contact/detail/candidate_list.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"

#include <algorithm>

using namespace palpate;

namespace { namespace candidate_list_test {

constexpr int samples = 60, tools = 2;

detail::Candidate candidate(int tool, int sample, double gap) {
  detail::Candidate c;
  c.tool = tool;
  c.sample = sample;
  c.gap = gap;
  return c;
}

int search(const detail::CandidateList& list, int tool, int sample) {
  const auto items = list.items();
  const auto found = std::find_if(items.begin(), items.end(),
                                  [&](const detail::Candidate& c) { return c.tool == tool && c.sample == sample; });
  return found == items.end() ? -1 : static_cast<int>(found - items.begin());
}

/// Number of points that the list does not find as the search does.
int differences(const detail::CandidateList& list) {
  int different = 0;
  for (int tool = 0; tool < tools; ++tool)
    for (int sample = 0; sample < samples; ++sample) different += list.find(tool, sample) != search(list, tool, sample);
  return different;
}

}  // namespace candidate_list_test
}  // namespace

TEST_CASE("A list of contact points finds them by tool and sample", "[contact]") {
  using namespace candidate_list_test;
  testing::Random random(41);
  detail::CandidateList list(40);
  CHECK(list.maximum() == 40);
  CHECK(list.find(0, 0) == -1);
  for (int round = 0; round < 3; ++round) {
    list.clear();
    CHECK(list.count() == 0);
    CHECK(differences(list) == 0);
    for (int i = 0; i < 400; ++i) {
      const int tool = static_cast<int>(random.uniform(0.0, tools));
      const int sample = static_cast<int>(random.uniform(0.0, samples));
      const detail::Candidate c = candidate(tool, sample, i);
      const int place = list.find(tool, sample);
      if (place >= 0) {
        CHECK(list.replace(place, c).gap == i);  // the same point
      } else if (list.count() < list.maximum()) {
        const detail::Candidate& added = list.add(c);
        CHECK(&added == &list[list.count() - 1]);
      } else {
        const int other = static_cast<int>(random.uniform(0.0, list.count()));
        list.replace(other, c);
        CHECK(list.find(tool, sample) == other);
      }
      REQUIRE(differences(list) == 0);
    }
    CHECK(list.count() == list.maximum());
  }
}
