// Which clampings could be told at all. Of contacts that nobody has learned from: how hard the less touched
// link is touched when the shipped model is asked, for how long both links have been, and how nearly one
// contact alone makes the true wrench. And what classifiers tell that learn from the same contacts: what was
// estimated, what was true, and what was true 3 ms before. FLINCH_CLASSIFIED in the environment says of how
// many contacts (4000 are all), FLINCH_LEARNED how many are learned from (12000 are all).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>

#include "experiments/campaign/campaign_run.h"
#include "experiments/dataset/contact_samples.h"
#include "experiments/dataset/data_spec.h"
#include "experiments/dataset/make_data_set.h"
#include "experiments/simulated/experiment.h"
#include "learning/evaluation.h"
#include "learning/onnx_file.h"
#include "learning/train_network.h"
#include "plant/contact_truth.h"
#include "plant/plant_truth.h"
#include "systems/framework/recorded_values.h"
#include "systems/signals/contact_detection.h"
#include "tests/campaign/classification/named_moments.h"
#include "tests/support/in_parallel.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

constexpr int all_asked = 4000, all_learned = 12000;

/// A sample of a contact, with what was true at its tick.
struct Contact {
  DataSample estimated, exact;  ///< as a classifier sees it, and as it was
  DataSample late;              ///< as it was 3 ms ago
  double weaker_share = 0.0;    ///< of the forces on both links, that on the one touched less hard
  double apart = 0.0;     ///< by how much the second link of the leg was touched later than anything [s]
  double both_for = 0.0;  ///< how long ago both links of the leg were touched first [s]
};

/// First tick at which `is` holds; none: the number of samples.
std::size_t first_tick(const Recording& recording, const std::function<bool(std::size_t)>& is) {
  std::size_t tick = 0;
  while (tick < recording.samples() && !is(tick)) ++tick;
  return tick;
}

std::size_t first_detection(const Recording& recording, const std::string& path) {
  const RecordedValues<ContactDetection> detection(recording, path);
  return first_tick(recording, [&](std::size_t tick) { return detection[tick].level != ContactLevel::none; });
}

/// What the plant did at a tick and before it, in the place of what was estimated.
void set_to_truth(const RecordedValues<PlantTruth>& truth, const RecordedValues<ContactTruth>& contact,
                  std::size_t tick, DataSample& sample) {
  sample.pose = truth[tick].pose;
  for (std::size_t i = 0; i < window_ages.size(); ++i) {
    const std::size_t then = tick - static_cast<std::size_t>(window_ages[i] / 1ms);
    sample.course[i] = {contact[then].wrench_in_base, truth[then].velocity};
  }
}

/// The moments of a run at which a classifier is judged.
std::vector<Contact> contacts_of(const DataSpec& spec, std::size_t number) {
  const CampaignRun run = draw_contact(spec, number);
  std::vector<std::string> signals = sampled_signals(spec.samples);
  signals.push_back("truth");
  const Recording recording = run_for_signals(run.scenario, signals);
  const RecordedValues<ContactTruth> contact(recording, "contact");
  const RecordedValues<PlantTruth> truth(recording, "truth");
  const std::size_t early = std::min(first_detection(recording, "detection"),
                                     first_detection(recording, "detection_by_" + spec.samples.early_by));
  const std::size_t first = first_tick(recording, [&](std::size_t tick) { return contact[tick].in_contact; });
  const std::size_t both = first_tick(recording, [&](std::size_t tick) { return contact[tick].clamping; });
  std::vector<Contact> result;
  for (DataSample& sample : contact_samples(recording, *run.scenario.robot.robot, spec.samples).samples) {
    sample.run = static_cast<int>(number);
    const std::size_t tick = early + static_cast<std::size_t>(std::lround(1e3 * sample.since_early));
    const ContactTruth now = contact[tick];
    const double harder = now.strongest.strength(), weaker = now.clamping ? now.second.strength() : 0.0;
    Contact& seen = result.emplace_back(Contact{.estimated = sample, .exact = sample, .late = sample});
    seen.weaker_share = harder > 0.0 ? weaker / (harder + weaker) : 0.0;
    seen.apart = 1e-3 * (static_cast<double>(both) - static_cast<double>(first));
    seen.both_for = 1e-3 * (static_cast<double>(tick) - static_cast<double>(both));
    set_to_truth(truth, contact, tick, seen.exact);
    set_to_truth(truth, contact, tick - 3, seen.late);
  }
  return result;
}

/// The contacts of as many runs of the shipped models' specification, in their order.
std::vector<Contact> contacts(std::uint64_t seed, int runs) {
  const auto count = static_cast<std::size_t>(runs);
  const DataSpec spec =
      read_data_spec(FLINCH_SOURCE_DIR "/apps/models/bodies.yaml", {.runs = count, .seed = seed});
  const auto parts = test::in_parallel(count, [&](std::size_t number) { return contacts_of(spec, number); });
  std::vector<Contact> all;
  for (const std::vector<Contact>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

std::shared_ptr<const ParallelRobot> shipped_robot() {
  return draw_contact(read_data_spec(FLINCH_SOURCE_DIR "/apps/models/bodies.yaml"), 0).scenario.robot.robot;
}

DataSet data_of(const std::vector<Contact>& contacts, DataSample Contact::*as) {
  DataSet data;
  data.robot = shipped_robot();
  for (const Contact& contact : contacts) data.samples.push_back(contact.*as);
  return data;
}

/// How far the true wrench is from what one contact with a single body could make, with as much friction as
/// the contacts had [N; 0.1 Nm count as much].
std::vector<double> beyond_one_contact(const std::vector<Contact>& contacts) {
  const std::shared_ptr<const ParallelRobot> robot = shipped_robot();
  const ContactClasses classes(robot->body_count(), robot->legs());
  TouchHypothesesSettings settings;
  settings.friction = 0.2;  // and twice this
  settings.points_along = 200;
  settings.points_around = 360;
  const TouchHypotheses hypotheses(robot, settings);
  const PlatformMatrix unit = PlatformVector(Eigen::Vector3d(1.0, 1.0, 0.01)).asDiagonal();
  std::vector<double> all;
  Kinematics now;
  ContactEvidence evidence;
  for (const Contact& contact : contacts) {
    robot->kinematics(contact.exact.pose, contact.exact.velocity(), now);
    hypotheses.weigh(now, contact.exact.wrench_in_base(), unit, evidence);
    all.push_back(std::sqrt(evidence.residual.head(classes.bodies()).minCoeff()));
  }
  return all;
}

/// Clampings of a sort, and how many of them were told as such, at each moment.
struct Told {
  std::array<int, named_moments.size()> all{}, right{};

  double share(std::size_t moment) const {
    return all[moment] > 0 ? static_cast<double>(right[moment]) / all[moment] : 1.0;
  }
  void print(const std::string& sort) const {
    std::printf("| %-45s |", sort.c_str());
    for (std::size_t i = 0; i < named_moments.size(); ++i)
      std::printf(" %5.1f %% of %4d |", 100.0 * share(i), all[i]);
    std::printf("\n");
  }
};

/// Counts clampings whose number in `by` is in each of the ranges between `limits`.
std::vector<Told> count(const std::vector<Contact>& contacts, const std::vector<bool>& told,
                        const std::vector<double>& by, const std::vector<double>& limits) {
  std::vector<Told> sorts(limits.size() + 1);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const auto place = std::upper_bound(limits.begin(), limits.end(), by[i]) - limits.begin();
    Told& sort = sorts[static_cast<std::size_t>(place)];
    for (std::size_t k = 0; k < named_moments.size(); ++k) {
      if ((contacts[i].estimated.moment & named_moments[k].which) == 0) continue;
      ++sort.all[k];
      sort.right[k] += told[i] ? 1 : 0;
    }
  }
  return sorts;
}

void print(const std::string& what, const std::vector<std::string>& names, const std::vector<Told>& sorts) {
  std::printf("%s\n", what.c_str());
  for (std::size_t i = 0; i < sorts.size(); ++i) sorts[i].print(names[i]);
}

TEST(TellableClampings, AreThoseWhoseLinksHaveBothBeenTouchedForAWhile) {
  const int runs = test::wanted("FLINCH_CLASSIFIED", 60);
  std::vector<Contact> clampings;
  const ContactClasses classes = classes_of(*shipped_robot());
  for (const Contact& contact : contacts(2, runs)) {
    if (contact.estimated.moment != 0 && classes.is_clamping(contact.estimated.touched))
      clampings.push_back(contact);
  }
  ASSERT_FALSE(clampings.empty());
  const DataSet data = data_of(clampings, &Contact::estimated);
  const ClassifierModel model = read_onnx(FLINCH_SOURCE_DIR "/apps/models/bodies.onnx");
  const FeatureSet features(Question::touched, data.robot);
  std::vector<bool> told(clampings.size(), false);
  for (const Answered& answer :
       answers_of(NeuralNetwork(model.network), questions_of(data, features, {}, false), data))
    told[answer.sample] = answer.probability.tail(classes.legs()).sum() > 0.5;
  std::vector<double> apart, both_for, weaker;
  for (const Contact& contact : clampings) {
    apart.push_back(contact.apart);
    both_for.push_back(contact.both_for);
    weaker.push_back(contact.weaker_share);
  }
  count(clampings, told, both_for, {}).front().print("all");
  const std::vector<Told> by_apart = count(clampings, told, apart, {9.5e-3});
  print("both links touched", {"within 9 ms", "10 ms or more after one another"}, by_apart);
  const std::vector<Told> by_time = count(clampings, told, both_for, {4.5e-3, 9.5e-3, 19.5e-3});
  print("both links touched for", {"less than 5 ms", "5 to 9 ms", "10 to 19 ms", "20 ms or more"}, by_time);
  const std::vector<Told> by_share = count(clampings, told, weaker, {0.1, 0.2, 0.3});
  print("the link touched less hard bears", {"less than a tenth", "to a fifth", "to 0.3", "more"}, by_share);
  print("one contact would make the true wrench to within", {"0.5 N", "2 N", "more"},
        count(clampings, told, beyond_one_contact(clampings), {0.5, 2.0}));
  const bool is_whole = runs >= all_asked;
  for (std::size_t moment = 0; moment < named_moments.size(); ++moment) {
    EXPECT_GT(by_time.back().share(moment), is_whole ? 0.94 : 0.85) << named_moments[moment].name;
    EXPECT_GT(by_share.back().share(moment), is_whole ? 0.94 : 0.85) << named_moments[moment].name;
  }
  if (is_whole) {
    constexpr std::array asked{0.93, 0.96, 0.97};
    for (std::size_t moment = 0; moment < named_moments.size(); ++moment)
      EXPECT_GT(by_apart.front().share(moment), asked[moment]) << named_moments[moment].name;
    EXPECT_LT(by_time.front().share(2), 0.6) << "these can be told now: theory.md says otherwise";
  }
}

/// Prints how contacts are told by who has learned from others, and returns the last moment.
Evaluation learned(const std::string& what, const DataSet& taught, const DataSet& asked) {
  const FeatureSet features(Question::touched, taught.robot);
  TrainingSettings settings;  // as the shipped model's
  settings.hidden = {80, 48};
  settings.l2 = 1e-4;
  settings.epochs = 14;
  const Questions lessons = questions_of(taught, features, {}, false);
  const NeuralNetwork network(train_network(lessons.set, features.outputs(), settings));
  Evaluation seen;
  for (const NamedMoment& moment : named_moments) {
    const Questions questions = questions_of(asked, features, {moment.which, {}}, false);
    seen = evaluate(answers_of(network, questions, asked), features, 0.0, moment.name);
    std::printf("| %-10s | %-8s | %5.1f %% | %5.1f %% | %5.1f %% | %5.2f %% |\n", what.c_str(), moment.name,
                100.0 * seen.body.value_or(0.0), 100.0 * seen.collision.value_or(0.0),
                100.0 * seen.clamping.value_or(0.0), 100.0 * seen.at_tenth.wrong_of_accepted);
  }
  return seen;
}

TEST(TellableClampings, AreNearlyAllWhereTheTrueWrenchIsKnown) {
  const int runs = test::wanted("FLINCH_LEARNED", 120);
  const std::vector<Contact> lessons = contacts(1, runs);
  const std::vector<Contact> questions = contacts(2, test::wanted("FLINCH_CLASSIFIED", 60));
  std::printf("| learned from | at | body | collision | clamping | wrong, were one in ten rejected |\n");
  const Evaluation estimated =
      learned("estimates", data_of(lessons, &Contact::estimated), data_of(questions, &Contact::estimated));
  const Evaluation exact =
      learned("the truth", data_of(lessons, &Contact::exact), data_of(questions, &Contact::exact));
  learned("3 ms late", data_of(lessons, &Contact::late), data_of(questions, &Contact::late));
  const double right = exact.confusion.balanced_accuracy().value_or(0.0);
  if (runs < all_learned) {
    EXPECT_GT(right, 0.75);
  } else {
    EXPECT_GT(right, estimated.confusion.balanced_accuracy().value_or(1.0) + 0.03);
    EXPECT_GT(exact.clamping.value_or(0.0), 0.96);
  }
}

}  // namespace
}  // namespace flinch
