#include "experiments/dataset/make_data_set.h"

#include <gmock/gmock.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "experiments/dataset/contact_samples.h"
#include "experiments/dataset/data_journal.h"
#include "experiments/dataset/data_spec.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "systems/foundation/fnv1a.h"
#include "systems/foundation/sha256.h"
#include "systems/framework/recording.h"
#include "tests/support/problems_of.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

DataSpec few(std::size_t runs, std::uint64_t seed = 1) {
  return read_data_spec(FLINCH_SOURCE_DIR "/apps/models/bodies.yaml", {.runs = runs, .seed = seed});
}

class MakeDataSet : public ::testing::Test {
 protected:
  std::string made(const std::string& name, const DataSpec& spec, std::size_t threads) {
    make_data_set(spec, place / name, threads);
    return test::bytes_of(place / name);
  }
  test::Workplace place;
};

TEST_F(MakeDataSet, FindsTheSameBitsOnAnyNumberOfThreads) {
  const std::string one = made("one.h5", few(8), 1);
  EXPECT_FALSE(one.empty());
  EXPECT_EQ(made("three.h5", few(8), 3), one);
  EXPECT_NE(made("other.h5", few(8, 2), 3), one);
}

TEST_F(MakeDataSet, GoesOnWhereItWasStopped) {
  const std::string whole = made("whole.h5", few(8), 2);
  EXPECT_THAT(test::problems_of([&] {
                make_data_set(few(8), place / "part.h5", 1, [](std::size_t done) { return done < 3; });
              }),
              testing::ElementsAre(testing::HasSubstr("the same call goes on from there")));
  const std::string left = test::bytes_of(place / "part.h5.part");
  EXPECT_FALSE(left.empty());
  place.write("part.h5.part", left.substr(0, left.size() - 5));  // torn
  EXPECT_EQ(made("part.h5", few(8), 2), whole);
  EXPECT_FALSE(std::filesystem::exists(place / "part.h5.part"));
  place.write("part.h5.part", left);
  EXPECT_THAT(test::problems_of([&] { make_data_set(few(8, 3), place / "part.h5", 1); }),
              testing::ElementsAre(testing::HasSubstr("holds the samples of another specification")));
}

// As on a full disk: what is written anew takes the place of what is there once it is whole.
TEST_F(MakeDataSet, KeepsWhatIsThereWhereNothingCanBeWrittenAnew) {
  EXPECT_FALSE(test::problems_of([&] {
                 make_data_set(few(8), place / "part.h5", 1, [](std::size_t done) { return done < 3; });
               }).empty());
  const std::string left = test::bytes_of(place / "part.h5.part");
  const std::filesystem::path anew = place / "part.h5.part.new";
  std::filesystem::create_directory(anew);
  EXPECT_THAT(test::problems_of([&] { make_data_set(few(8), place / "part.h5", 1); }),
              testing::ElementsAre(testing::HasSubstr("part.h5.part: the file cannot be written")));
  EXPECT_EQ(test::bytes_of(place / "part.h5.part"), left);
}

TEST_F(MakeDataSet, GoesOnWithNoRunThatComesOutOtherwise) {
  EXPECT_FALSE(test::problems_of([&] {
                 make_data_set(few(8), place / "part.h5", 1, [](std::size_t done) { return done < 3; });
               }).empty());
  const std::string left = test::bytes_of(place / "part.h5.part");
  const std::size_t first = left.find('\n') + 1;
  std::uint64_t start[2] = {0, 0};
  std::memcpy(start, left.data() + first, sizeof start);
  std::string frame = left.substr(first + sizeof start, start[0]);
  frame.back() = static_cast<char>(frame.back() ^ 1);  // the sign or exponent of one number
  start[1] = fnv1a(frame);
  place.write("part.h5.part", left.substr(0, first) +
                                  std::string(reinterpret_cast<const char*>(start), sizeof start) + frame);
  EXPECT_THAT(test::problems_of([&] { make_data_set(few(8), place / "part.h5", 1); }),
              testing::ElementsAre(testing::HasSubstr("part.h5.part: run 0 comes out otherwise now")));
}

TEST_F(MakeDataSet, KeepsTheTextsThatDecideAboutTheData) {
  make_data_set(few(2), place / "data.h5", 2);
  const auto card = read_data_set(place / "data.h5").card;
  const auto shipped = [](const std::string& file) {
    return test::bytes_of(FLINCH_SOURCE_DIR "/apps/models/" + file);
  };
  EXPECT_EQ(card.at("spec.text"), shipped("bodies.yaml"));
  EXPECT_EQ(card.at("campaign.2.file"), "clamped.yaml");
  EXPECT_EQ(card.at("campaign.2.text"), shipped("bodies/clamped.yaml"));
  EXPECT_EQ(card.at("campaign.2.scenario.1.file"), "moving_robot.yaml");
  EXPECT_EQ(card.at("campaign.2.scenario.1.text"), shipped("bodies/moving_robot.yaml"));
  EXPECT_EQ(card.at("campaign.5.scenario.1.text"), shipped("bodies/held_robot.yaml"));
  EXPECT_EQ(card.at("identity"), sha256(few(2).identity()));
}

TEST_F(MakeDataSet, SaysWhatToDoWithRunsOfAnotherLayout) {
  EXPECT_FALSE(test::problems_of([&] {
                 make_data_set(few(8), place / "part.h5", 1, [](std::size_t done) { return done < 1; });
               }).empty());
  const std::string left = test::bytes_of(place / "part.h5.part");
  const std::size_t first = left.find('\n') + 1;
  std::uint64_t length = 0;
  std::memcpy(&length, left.data() + first, sizeof length);
  const std::string longer = left.substr(first + 16, length) + "12345678";
  const std::uint64_t start[2] = {longer.size(), fnv1a(longer)};
  place.write("part.h5.part", left.substr(0, first) +
                                  std::string(reinterpret_cast<const char*>(start), sizeof start) + longer);
  EXPECT_THAT(
      test::problems_of([&] { make_data_set(few(8), place / "part.h5", 1); }),
      testing::ElementsAre(place.at("part.h5.part") +
                           ": holds a run of another length than its samples; begin anew with --fresh"));
}

TEST_F(MakeDataSet, MakesTheSameRunsHoweverManyFollow) {
  const DataSet few_runs = make_data_set(few(4), place / "few.h5", 2);
  const DataSet more_runs = make_data_set(few(8), place / "more.h5", 2);
  ASSERT_FALSE(few_runs.samples.empty());
  ASSERT_GT(more_runs.samples.size(), few_runs.samples.size());
  for (std::size_t i = 0; i < few_runs.samples.size(); ++i) {
    EXPECT_EQ(few_runs.samples[i].wrench_in_base(), more_runs.samples[i].wrench_in_base());
    EXPECT_EQ(few_runs.samples[i].run, more_runs.samples[i].run);
  }
}

TEST_F(MakeDataSet, LabelsTheMomentsOfEveryContact) {
  const DataSet data = make_data_set(few(16), place / "data.h5", 2);
  const ContactClasses classes = classes_of(*data.robot);
  std::map<int, std::array<double, 3>> moments;
  int right_force = 0;
  for (const DataSample& sample : data.samples) {
    EXPECT_TRUE(classes.contains(sample.touched));
    EXPECT_GE(sample.since_onset, 0.0);
    for (int i = 0; i < 3; ++i) {
      if ((sample.moment >> i & 1) != 0)
        moments[sample.run][static_cast<std::size_t>(i)] = sample.since_early;
    }
    if (sample.wrench_in_base().head<2>().norm() > 2.0) ++right_force;
    // At the early tick nothing but noise and errors of the model was there at the first moment.
    if ((sample.moment & Moment::early) != 0 && sample.since_onset < 0.010) {
      const PlatformVector& first = sample.course.back().wrench_in_base;
      EXPECT_LT(first.head<2>().norm(), 0.5 * sample.wrench_in_base().head<2>().norm());
    }
  }
  EXPECT_GT(moments.size(), 10U);
  int complete = 0;
  for (const auto& [run, times] : moments) {
    EXPECT_EQ(times[0], 0.0);
    if (times[2] == 0.0) continue;  // the slower detector saw nothing
    ++complete;
    EXPECT_GE(times[1], 0.0);
    EXPECT_NEAR(times[2] - times[1], 0.010, 1e-9);
  }
  EXPECT_GT(complete, 8);
  EXPECT_GT(right_force, static_cast<int>(data.samples.size()) * 9 / 10);
}

TEST_F(MakeDataSet, TakesLabelledRecordings) {
  const std::filesystem::path scenario = test::shipped("scenarios/platform_collision.yaml");
  record_experiment(read_simulated_scenario(scenario), place / "run.h5");
  record_experiment(read_simulated_scenario(scenario, 2), place / "other.h5");
  place.write("spec.yaml",
              "recordings: [{file: run.h5, touched: leg2_link2, configuration: 4}, {file: other.h5}]\n");
  const DataSet data = make_data_set(read_data_spec(place / "spec.yaml"), place / "data.h5", 1);
  ASSERT_FALSE(data.samples.empty());
  for (const DataSample& sample : data.samples) {
    EXPECT_EQ(sample.touched, sample.run == 0 ? BodyId::link2(1).index() : 0)
        << "the label, or else the truth";
    EXPECT_EQ(sample.configuration, sample.run == 0 ? 4 : 0);
  }
  EXPECT_EQ(data.card.at("recording.1.sha256"), sha256(test::bytes_of(place / "run.h5")));
  EXPECT_FALSE(data.card.contains("seed")) << "nothing was drawn";
  place.write("spec.yaml", "recordings: [{file: run.h5, touched: leg2_link3}]\n");
  EXPECT_THAT(
      test::problems_of([&] { make_data_set(read_data_spec(place / "spec.yaml"), place / "data.h5", 1); }),
      testing::ElementsAre(
          testing::HasSubstr("'leg2_link3' is nothing that can be touched; there are platform")));
}

/// What another controller would have logged of a run: readings alone.
Recording log_of(const Recording& run) {
  Recording log;
  log.period = run.period;
  log.time_ns = run.time_ns;
  for (const char* const name : {"joints", "drives", "status"}) log.signals.push_back(run.signal(name));
  log.attributes = run.attributes;
  return log;
}

TEST_F(MakeDataSet, TakesContactsThatAreMarkedInLogs) {
  const std::string scenario = test::shipped("scenarios/platform_collision.yaml");
  record_experiment(read_simulated_scenario(scenario), place / "run.h5");
  write_recording(log_of(read_recording(place / "run.h5")), place / "log.h5");
  const auto made = [&](const std::string& recordings) {
    place.write("spec.yaml", "samples: {wrench: momentum_observer}\nrecordings: [" + recordings + "]\n");
    return make_data_set(read_data_spec(place / "spec.yaml"), place / "data.h5", 1);
  };
  const DataSet of_run = made("{file: run.h5, touched: platform}");
  const std::string log = "{file: log.h5, scenario: " + scenario + ", configuration: 2, contacts: [";
  const DataSet of_log = made(log + "{at_s: 0.2, touched: platform}]}");
  ASSERT_FALSE(of_run.samples.empty());
  ASSERT_EQ(of_log.samples.size(), of_run.samples.size());
  for (std::size_t i = 0; i < of_run.samples.size(); ++i) {
    const DataSample &here = of_log.samples[i], &there = of_run.samples[i];
    EXPECT_EQ(here.wrench_in_base(), there.wrench_in_base());
    EXPECT_EQ(here.moment, there.moment);
    EXPECT_EQ(here.configuration, 2);
    EXPECT_GT(here.since_onset, here.since_early) << "the contact was said to begin earlier";
  }
  EXPECT_EQ(of_log.card.at("recording.1.scenario.text"), test::bytes_of(scenario));
  // Of two marked contacts the second one is another run, and what is not detected is told.
  const DataSet of_two = made(log + "{at_s: 0.01, touched: leg1_link1}, {at_s: 0.2, touched: platform}]}");
  ASSERT_EQ(of_two.samples.size(), of_run.samples.size());
  EXPECT_EQ(of_two.samples.front().run, 1);
  EXPECT_EQ(of_two.card.at("left_out"), "not detected: 1\n");
}

TEST_F(MakeDataSet, AsksWhatWasTouchedInALog) {
  const std::string scenario = test::shipped("scenarios/platform_collision.yaml");
  record_experiment(read_simulated_scenario(scenario), place / "run.h5");
  write_recording(log_of(read_recording(place / "run.h5")), place / "log.h5");
  const auto problems = [&](const std::string& recordings) {
    place.write("spec.yaml", "recordings: [" + recordings + "]\n");
    return test::problems_of(
        [&] { make_data_set(read_data_spec(place / "spec.yaml"), place / "data.h5", 1); });
  };
  EXPECT_THAT(problems("{file: log.h5}"),
              testing::ElementsAre(testing::HasSubstr("is a log, which does not say what was touched")));
  EXPECT_THAT(problems("{file: log.h5, touched: platform}"),
              testing::ElementsAre(testing::HasSubstr("force_torque")));
  EXPECT_THAT(problems("{file: run.h5, scenario: " + scenario + ", touched: platform}"),
              testing::ElementsAre(testing::HasSubstr("'scenario' is for logs")));
  EXPECT_THAT(problems("{file: log.h5, contacts: [{at_s: 0.5, touched: platform}, {at_s: 0.4}]}"),
              testing::ElementsAre(testing::HasSubstr("is not after that of the contact before it"),
                                   testing::HasSubstr("touched")));
}

TEST_F(MakeDataSet, RefusesPartsOfAnotherRobot) {
  record_experiment(read_simulated_scenario(test::shipped("scenarios/platform_collision.yaml")),
                    place / "a.h5");
  record_experiment(read_simulated_scenario(test::shipped("scenarios/five_bar_collision.yaml")),
                    place / "b.h5");
  place.write("spec.yaml", "recordings: [{file: a.h5}, {file: b.h5}]\n");
  EXPECT_THAT(
      test::problems_of([&] { make_data_set(read_data_spec(place / "spec.yaml"), place / "data.h5", 1); }),
      testing::ElementsAre(testing::HasSubstr("b.h5: is of another robot than what stands before it")));
}

TEST(DataSpec, HasTheIdentityOfWhatItIsMadeOf) {
  const test::Workplace place;
  const auto identity = [&place](const std::string& spec) {
    place.write("spec.yaml", spec);
    return read_data_spec(place / "spec.yaml").identity();
  };
  place.write("run.h5", "one");
  place.write("campaign.yaml", "scenario: scenarios/platform_collision.yaml\nruns: 2\n");
  const std::string spec =
      "runs: 9\ncontacts: [{campaign: campaign.yaml}]\nrecordings: [{file: run.h5, touched: platform}]\n";
  const std::string before = identity(spec);
  EXPECT_EQ(identity("title: other words\n" + spec), before);
  EXPECT_NE(identity("seed: 2\n" + spec), before);
  EXPECT_NE(identity("samples: {every: 2}\n" + spec), before);
  place.write("run.h5", "two");
  EXPECT_NE(identity(spec), before) << "another recording";
  place.write("run.h5", "one");
  EXPECT_EQ(identity(spec), before);
  const std::string robot = test::bytes_of(place / "robots/planar_3rrr.yaml");
  place.write("robots/planar_3rrr.yaml", robot + "\n# another word\n");
  EXPECT_NE(identity(spec), before) << "another robot file";
}

TEST(DataSpec, NamesAllThatIsWrong) {
  const test::Workplace place;
  place.write("spec.yaml", "title: nothing\n");
  EXPECT_THAT(test::problems_of([&] { read_data_spec(place / "spec.yaml"); }),
              testing::ElementsAre(testing::HasSubstr("names neither 'contacts' nor 'recordings'")));
  place.write("campaign.yaml", "scenario: scenarios/platform_collision.yaml\nruns: 2\nspeed: 3\n");
  place.write(
      "spec.yaml",
      "contacts: [{campaign: campaign.yaml, share: 0}]\nsamples: {every: 0, from_force_N: -1}\nepochs: 3\n");
  EXPECT_EQ(test::problems_of([&] { read_data_spec(place / "spec.yaml"); }).size(), 5U);
}

}  // namespace
}  // namespace flinch
