// How often a classifier says that no single contact explains the wrench: of robots that one thing touches,
// where that is a false alarm, and of those that two posts touch at once. Robots, posts and motions are drawn
// anew. FLINCH_CONTACTS in the environment says how many contacts of each sort instead of 20, FLINCH_PAIRS
// how many pairs of posts instead of 150, FLINCH_SEED which.
#include <gtest/gtest.h>

#if FLINCH_HAS_LEARNING

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "apps/flinch/learning_verbs.h"
#include "diagrams/isolation_settings.h"
#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_run.h"
#include "systems/contact/touch_hypotheses.h"
#include "systems/framework/random.h"
#include "tests/campaign/isolation/second_post.h"
#include "tests/campaign/isolation/touched_bodies.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

using test::add_post;
using test::bounds;
using test::share;
using test::sort_of;
using test::Touched;
using test::Touching;
using test::touching;

constexpr std::size_t window = 10;      // after the detection, when the answer stands [samples, ms]
constexpr double within_noise = 5.991;  // chi-square, 95 %, two degrees

const std::array<std::pair<const char*, const char*>, 2> classifiers{
    {{"model", "classification_model_classifier"}, {"learned", "classification"}}};

/// Realistic robots that run into something, with both classifiers in their control paths.
class Contacts {
 public:
  Contacts(const std::vector<std::string>& bodies, std::size_t draws, std::uint64_t seed)
      : campaign_(read_campaign("apps/campaigns/touched_bodies.yaml",
                                {.set = {"plant.realism=bench"}, .draws = draws, .seed = seed})),
        follow_learned_(classifier_of({"apps/models/bodies.onnx"})) {
    campaign_.contact->bodies = bodies;
  }

  std::size_t count() const { return campaign_.runs(); }
  SimulatedScenario draw(std::size_t run) const {
    SimulatedScenario scenario = draw_run(campaign_, run).scenario;
    follow_learned_(scenario);
    return scenario;
  }

 private:
  Campaign campaign_;
  std::function<void(Scenario&)> follow_learned_;
};

/// All that touches at any sample from the first contact to `last`.
std::set<Touching> touched_until(const Touched& run, std::size_t last) {
  std::set<Touching> found;
  for (std::size_t k = 0; k <= last; ++k) found.merge(touching(run.at<ContactTruth>("contact", k)));
  return found;
}

/// What one thing has touched, as a class: a body, or both links of a leg. None: several bodies.
std::optional<int> class_of(const Touched& run, const std::set<Touching>& touches) {
  const ContactClasses classes(run.robot->body_count(), run.robot->legs());
  if (touches.size() == 1) return touches.begin()->body;
  if (touches.size() != 2) return std::nullopt;
  const BodyId one = BodyId::from_index(touches.begin()->body);
  const BodyId other = BodyId::from_index(touches.rbegin()->body);
  if (one.leg() < 0 || one.leg() != other.leg()) return std::nullopt;
  return classes.clamping(one.leg());
}

/// By how much the best single contact misses the true wrench of all contacts, e^T S^-1 e with the covariance
/// S that the model classifier takes it to have; the mean over the window with the weight of the force
/// squared.
double missed_by_one(const Touched& run, std::size_t detection) {
  const IsolationSettings settings;
  const TouchHypotheses hypotheses(run.robot, settings.hypotheses);
  const ConfigurationSpace space = run.robot->space();
  double sum = 0.0, weights = 0.0;
  for (std::size_t k = detection; k <= detection + window; ++k) {
    const auto now = run.at<PlantTruth>("truth", k);
    const PlatformVector F = run.at<ContactTruth>("contact", k).wrench_in_base;
    const double weight = F.head(space.translations()).squaredNorm();
    Kinematics at;
    run.robot->kinematics(now.pose, now.velocity, at);
    ContactEvidence evidence;
    hypotheses.weigh(at, F, settings.uncertainty.covariance(space, F), evidence);
    if (!evidence.valid) continue;
    sum += weight * evidence.residual.minCoeff();
    weights += weight;
  }
  return weights > 0.0 ? sum / weights : 0.0;
}

constexpr std::array limits{2.0, 3.0, 4.0, 6.0, 9.0, 12.0, 15.0, 20.0, 30.0};

/// What a classifier said of contacts of one sort when its answer stood.
struct Answers {
  std::size_t said = 0, several = 0, accepted = 0;
  std::vector<double> residuals;

  void add(const ContactClassification& answer) {
    if (!answer.valid) return;
    ++said;
    several += answer.several_contacts;
    accepted += answer.accepted;
    residuals.push_back(answer.residual);
  }
  void add(const Answers& others) {
    said += others.said;
    several += others.several;
    accepted += others.accepted;
    residuals.insert(residuals.end(), others.residuals.begin(), others.residuals.end());
  }
  std::size_t above(double limit) const {
    return static_cast<std::size_t>(std::count_if(residuals.begin(), residuals.end(),
                                                  [limit](double residual) { return residual > limit; }));
  }
  void print(const std::string& classifier, const std::string& sort) const {
    std::printf("| %s | %s | %s | %s | %s |\n", classifier.c_str(), sort.c_str(),
                share(several, said).c_str(), share(accepted, said).c_str(),
                share(said - several - accepted, said).c_str());
  }
  void print_limits(const std::string& classifier, const std::string& sort) const {
    std::printf("| %s | %s |", classifier.c_str(), sort.c_str());
    for (const double limit : limits)
      std::printf(" %.1f |", 100.0 * static_cast<double>(above(limit)) / static_cast<double>(said));
    std::printf("\n");
  }
};

/// Of each sort, by its name.
using BySort = std::map<std::string, Answers>;

void print_shares(const std::array<BySort, 2>& answers) {
  std::printf("| classifier | contacts | told as several | taken for one class | for none |\n");
  for (std::size_t c = 0; c < classifiers.size(); ++c)
    for (const auto& [sort, said] : answers[c]) said.print(classifiers[c].first, sort);
  std::printf("| classifier | contacts | %% above 2 | 3 | 4 | 6 | 9 | 12 | 15 | 20 | 30 |\n");
  for (std::size_t c = 0; c < classifiers.size(); ++c)
    for (const auto& [sort, said] : answers[c]) said.print_limits(classifiers[c].first, sort);
  std::fflush(stdout);
}

void add(const Touched& run, std::size_t sample, const std::string& sort, std::array<BySort, 2>& answers) {
  for (std::size_t c = 0; c < classifiers.size(); ++c)
    answers[c][sort].add(run.at<ContactClassification>(classifiers[c].second, sample));
}

TEST(SeveralContacts, AreSeldomSaidOfOne) {
  const Contacts contacts({"platform", "link1", "link2", "clamping"},
                          test::wanted<std::size_t>("FLINCH_CONTACTS", 20),
                          test::wanted<std::uint64_t>("FLINCH_SEED", 51));
  std::array<BySort, 2> answers;
  int not_detected = 0, more_than_one = 0;
  for (std::size_t i = 0; i < contacts.count(); ++i) {
    const Touched run(contacts.draw(i));
    const std::size_t sample = run.detection() + window;
    if (sample >= run.samples()) {
      ++not_detected;
      continue;
    }
    const std::optional<int> touched = class_of(run, touched_until(run, sample));
    if (!touched) {
      ++more_than_one;
      continue;
    }
    add(run, sample, sort_of({run.robot->body_count(), run.robot->legs()}, *touched), answers);
  }
  std::printf("one thing touches; not detected: %d, touched otherwise as well: %d\n", not_detected,
              more_than_one);
  for (BySort& of_classifier : answers) {
    Answers all;
    for (const auto& [sort, said] : of_classifier) all.add(said);
    of_classifier["all"] = all;
  }
  print_shares(answers);
  for (const BySort& of_classifier : answers) {
    const Answers& all = of_classifier.at("all");
    EXPECT_GT(all.said, 0.8 * static_cast<double>(contacts.count()));
    EXPECT_LT(bounds(all.several, all.said)[1], 0.08);
  }
}

/// Whether both posts touch, at one sample of the window, and not the same body.
bool both_touch(const Touched& run, std::size_t detection) {
  for (std::size_t k = detection; k <= detection + window; ++k) {
    const std::set<Touching> now = touching(run.at<ContactTruth>("contact", k));
    const bool both = !now.empty() && now.begin()->obstacle != now.rbegin()->obstacle;
    if (both && now.begin()->body != now.rbegin()->body) return true;
  }
  return false;
}

/// By how much one contact misses the true wrench of two: as by chance, beyond the limit, or in between.
std::string sort_by(double miss) {
  if (miss < within_noise) return "one makes their wrench";
  return miss > IsolationSettings().model_classifier.largest_residual ? "none makes it" : "one nearly does";
}

TEST(SeveralContacts, AreToldWhereNoSingleOneMakesTheTrueWrench) {
  const Contacts contacts({"platform", "link1", "link2"}, test::wanted<std::size_t>("FLINCH_PAIRS", 150) / 3,
                          test::wanted<std::uint64_t>("FLINCH_SEED", 51));
  std::array<BySort, 2> answers;
  int not_detected = 0, one_only = 0;
  for (std::size_t i = 0; i < contacts.count(); ++i) {
    SimulatedScenario scenario = contacts.draw(i);
    RandomGenerator random(derive_seed(scenario.seed, "second post"));
    if (!add_post(scenario, scenario.expected.contact.value_or(""), random)) continue;
    const Touched run(scenario);
    const std::size_t detection = run.detection(), sample = detection + window;
    if (sample >= run.samples()) {
      ++not_detected;
    } else if (!both_touch(run, detection)) {
      ++one_only;
    } else {
      add(run, sample, "all", answers);
      add(run, sample, sort_by(missed_by_one(run, detection)), answers);
    }
  }
  std::printf("two posts touch at once; not detected: %d, only one touched: %d\n", not_detected, one_only);
  for (const auto& [sort, said] : answers[0])
    std::printf("  %s: %s\n", sort.c_str(), share(said.said, answers[0]["all"].said).c_str());
  print_shares(answers);
  const auto of = [&](std::size_t classifier, const char* sort) { return answers[classifier][sort]; };
  const Answers by_model = of(0, "none makes it"), by_network = of(1, "none makes it");
  EXPECT_GT(bounds(by_model.several, by_model.said)[0], 0.4);
  EXPECT_GT(bounds(by_network.several, by_network.said)[0], 0.05);
  const std::size_t explained = of(0, "one makes their wrench").said, all = of(0, "all").said;
  EXPECT_GT(bounds(explained, all)[0], 0.5) << "of most pairs no wrench can tell";
  for (const std::size_t classifier : {0U, 1U}) {
    const Answers one = of(classifier, "one makes their wrench");
    EXPECT_LT(bounds(one.several, one.said)[1], 0.15);
  }
}

}  // namespace
}  // namespace flinch

#endif
