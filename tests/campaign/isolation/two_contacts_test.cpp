// Whether wrench and base forces together tell two contacts from one, and where both are: realistic robots,
// posts and motions drawn anew. FLINCH_CONTACTS in the environment says how many single contacts of each body
// instead of 40, FLINCH_PAIRS how many pairs of posts instead of 150, FLINCH_SEED which.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_run.h"
#include "systems/signals/located_contacts.h"
#include "tests/campaign/isolation/second_post.h"
#include "tests/campaign/isolation/touched_bodies.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

using test::quantile;
using test::share;
using test::Touched;

constexpr std::size_t settled = 20;  // after the detection [samples, ms]

Campaign campaign(const char* count, std::size_t usual) {
  return read_campaign("apps/campaigns/two_contacts.yaml",
                       {.draws = test::wanted<std::size_t>(count, usual),
                        .seed = test::wanted<std::uint64_t>("FLINCH_SEED", 61)});
}

/// What touches at a sample, harder than 5 N, and each obstacle one body only.
std::vector<TouchTruth> touches(const Touched& run, std::size_t sample) {
  const auto truth = run.at<ContactTruth>("contact", sample);
  std::vector<TouchTruth> found;
  const auto add = [&](const TouchTruth& touch) {
    if (touch.strength() > 5.0) found.push_back(touch);
  };
  add(truth.strongest);
  add(truth.second);
  for (const TouchTruth& touch : truth.further) add(touch);
  return found;
}

/// All bodies that were touched until a sample: what is over is still felt for a while.
std::set<int> bodies_until(const Touched& run, std::size_t sample) {
  std::set<int> bodies;
  for (std::size_t k = 0; k <= sample; ++k) {
    for (const test::Touching& each : test::touching(run.at<ContactTruth>("contact", k)))
      bodies.insert(each.body);
  }
  return bodies;
}

double distance(const LocatedContacts& located, const TouchTruth& touch) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < located.count; ++i) {
    const LocatedContact& contact = located.contacts[static_cast<std::size_t>(i)];
    least = std::min(least, (contact.point_in_base - touch.point_in_base).norm());
  }
  return least;
}

bool has(const LocatedContacts& located, int body) {
  return located.contacts[0].body == body || (located.count > 1 && located.contacts[1].body == body);
}

/// Which share would be told as two by other limits of the odds.
void print_by_limit(const std::vector<double>& odds) {
  std::printf("  told as two from ln odds of");
  for (const double limit : {2.0, 4.0, 6.0, 8.0, 10.0}) {
    const auto above = std::count_if(odds.begin(), odds.end(), [limit](double each) { return each > limit; });
    std::printf(" %.0f: %.1f %%;", limit,
                100.0 * static_cast<double>(above) / static_cast<double>(odds.size()));
  }
  std::printf("\n");
}

TEST(TwoContacts, AreNotSaidOfOne) {
  const Campaign singles = campaign("FLINCH_CONTACTS", 40);
  std::size_t judged = 0, two = 0, none = 0, right = 0;
  std::vector<double> errors, odds;
  for (std::size_t number = 0; number < singles.runs(); ++number) {
    const Touched run(draw_run(singles, number).scenario, {"located_contacts"});
    const std::size_t sample = run.detection() + settled;
    if (sample >= run.samples()) continue;
    const std::vector<TouchTruth> truth = touches(run, sample);
    const auto located = run.at<LocatedContacts>("located_contacts", sample);
    const bool touches_itself = run.at<ContactTruth>("contact", sample).self_contact;
    if (truth.size() != 1 || bodies_until(run, sample).size() != 1 || !located.valid || touches_itself)
      continue;
    ++judged;
    odds.push_back(located.log_odds_of_two);
    two += located.count == 2;
    none += located.count == 0;
    if (located.count == 2) {
      std::printf("  run %zu: body %d, %.0f N, told as %d and %d with ln odds %.1f\n", number,
                  truth.front().body, truth.front().strength(), located.contacts[0].body,
                  located.contacts[1].body, located.log_odds_of_two);
    }
    if (located.count != 1) continue;
    right += has(located, truth.front().body);
    errors.push_back(1e3 * distance(located, truth.front()));
  }
  std::printf(
      "one contact: told as two %s, as neither %s; the right body %s; placed %.1f mm off (90 %%: %.1f)\n",
      share(two, judged).c_str(), share(none, judged).c_str(), share(right, judged).c_str(),
      quantile(errors, 0.5), quantile(errors, 0.9));
  print_by_limit(odds);
  ASSERT_GT(judged, 30U);
  EXPECT_LT(test::bounds(two, judged)[0], 0.01);
  EXPECT_LT(quantile(errors, 0.5), 30.0);
}

/// Pairs whose weaker push is as strong as `least` [N].
struct Told {
  double least;
  std::size_t judged = 0, two = 0, none = 0, right = 0;
  std::vector<double> worse{}, each{}, odds{};

  void add(const std::vector<TouchTruth>& truth, const LocatedContacts& located) {
    if (std::min(truth[0].strength(), truth[1].strength()) < least) return;
    ++judged;
    odds.push_back(located.log_odds_of_two);
    two += located.count == 2;
    none += located.count == 0;
    if (located.count != 2) return;
    right += has(located, truth[0].body) && has(located, truth[1].body);
    const double one = 1e3 * distance(located, truth[0]), other = 1e3 * distance(located, truth[1]);
    worse.push_back(std::max(one, other));
    each.insert(each.end(), {one, other});
  }
  void print() const {
    std::printf("two contacts of %.0f N and more: told as two %s, as neither %s; both bodies right %s\n",
                least, share(two, judged).c_str(), share(none, judged).c_str(), share(right, judged).c_str());
    std::printf("  placed: each %.1f mm off (90 %%: %.1f), the worse %.1f mm off (90 %%: %.1f)\n",
                quantile(each, 0.5), quantile(each, 0.9), quantile(worse, 0.5), quantile(worse, 0.9));
    print_by_limit(odds);
  }
};

TEST(TwoContacts, AreToldAndBothPlaced) {
  const Campaign pairs = campaign("FLINCH_PAIRS", 150 / 3);
  std::array<Told, 3> told{Told{.least = 5.0}, Told{.least = 10.0}, Told{.least = 20.0}};
  for (std::size_t number = 0; number < pairs.runs(); ++number) {
    SimulatedScenario scenario = draw_run(pairs, number).scenario;
    scenario.station.rig.obstacles.resize(1);
    RandomGenerator random(derive_seed(scenario.seed, "second post"));
    if (!test::add_post(scenario, scenario.expected.contact.value_or(""), random)) continue;
    const Touched run(scenario, {"located_contacts"});
    const std::size_t sample = run.detection() + settled;
    if (sample >= run.samples()) continue;
    const std::vector<TouchTruth> truth = touches(run, sample);
    const auto located = run.at<LocatedContacts>("located_contacts", sample);
    if (truth.size() != 2 || bodies_until(run, sample).size() != 2 || !located.valid) continue;
    for (Told& of : told) of.add(truth, located);
  }
  for (const Told& of : told) of.print();
  const Told& clear = told[1];
  ASSERT_GT(clear.judged, 30U);
  EXPECT_GT(test::bounds(clear.two, clear.judged)[1], 0.95);
  EXPECT_LT(quantile(clear.each, 0.5), 30.0);
}

}  // namespace
}  // namespace flinch
