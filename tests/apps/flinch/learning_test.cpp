// flinch dataset, train and evaluate, as typed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "learning/onnx_file.h"
#include "systems/framework/recorded_values.h"
#include "systems/framework/recording.h"
#include "systems/signals/contact_classes.h"
#include "tests/apps/flinch/documented_keys.h"
#include "tests/apps/flinch/program.h"
#include "tests/support/workplace.h"

#if FLINCH_HAS_LEARNING

namespace flinch {
namespace {

using test::flinch;
using test::Outcome;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// A small data set and its model.
class LearningVerbs : public ::testing::Test {
 protected:
  void SetUp() override {
    made = flinch({"dataset", FLINCH_SOURCE_DIR "/apps/models/bodies.yaml", "--runs", "60", "--seed", "5",
                   "--out", data(), "--threads", "2", "--quiet"});
    trained = flinch(
        {"train", data(), "-o", model(), "--epochs", "40", "--threads", "2", "--folds", "3", "--json"});
  }

  std::string data() const { return place.at("data.h5"); }
  std::string model() const { return place.at("model.onnx"); }
  Outcome evaluate(std::vector<std::string> more) const {
    more.insert(more.begin(), {"evaluate", model(), data(), "--threads", "2"});
    return flinch(more);
  }

  test::Workplace place;
  Outcome made, trained;
};

TEST_F(LearningVerbs, SayWhatTheyHaveMade) {
  EXPECT_EQ(made.status, 0) << made.err;
  EXPECT_THAT(made.out, HasSubstr("60 runs"));
  EXPECT_THAT(made.out, HasSubstr("platform"));
  ASSERT_EQ(trained.status, 0) << trained.err;
  const auto json = nlohmann::json::parse(trained.out);
  EXPECT_GT(json["samples"], 200);
  EXPECT_GT(json["accuracy"], 0.3) << "chance is 0.1";
  EXPECT_EQ(json["question"], "touched");
  EXPECT_THAT(test::undocumented_keys(json, "JSON"), ElementsAre());
  EXPECT_TRUE(std::filesystem::exists(model()));
}

TEST_F(LearningVerbs, EvaluateWithTheKeysOfTheDocument) {
  const Outcome outcome = evaluate({"--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  for (const char* key :
       {"samples", "accuracy", "confusion", "expected_calibration_error", "rejected", "wrong_of_accepted"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_THAT(test::undocumented_keys(json, "Classifiers"), ElementsAre());
  for (const char* key : {"body", "collision_clamping", "chain"})
    EXPECT_TRUE(json["accuracy"].contains(key)) << key;
  EXPECT_EQ(json["at"], "later");
  EXPECT_GT(json["moments"]["all"]["samples"], json["samples"]);
  EXPECT_THAT(test::bytes_of(place.at("data_model.html")), HasSubstr("Reliability"));
  EXPECT_EQ(nlohmann::json::parse(evaluate({"--json", "--at", "early"}).out)["at"], "early");
  const Outcome misspelt = evaluate({"--at", "erly"});
  EXPECT_EQ(misspelt.status, 2);
  EXPECT_THAT(misspelt.err, HasSubstr("did you mean 'early'?"));
}

TEST_F(LearningVerbs, WarnWhereAModelIsAskedWhatItHasLearned) {
  EXPECT_THAT(evaluate({"--quiet"}).err,
              AllOf(HasSubstr("warning: " + data() + ": the model has learned from these data; "),
                    Not(HasSubstr("same title"))));
  const Outcome shipped =
      flinch({"evaluate", FLINCH_SOURCE_DIR "/apps/models/bodies.onnx", data(), "--quiet"});
  EXPECT_EQ(shipped.status, 0) << shipped.err;
  EXPECT_EQ(shipped.err, "") << "it has learned from contacts of seed 1, these are of seed 5";
}

TEST_F(LearningVerbs, SayOnceThatAModelIsForAnotherRobot) {
  ASSERT_EQ(
      flinch({"run", place.at("scenarios/five_bar_collision.yaml"), "--out", place.at("five_bar"), "--quiet"})
          .status,
      0);
  place.write("five_bar.yaml", "recordings: [{file: five_bar/run.h5, touched: platform}]\n");
  const Outcome made_of =
      flinch({"dataset", place.at("five_bar.yaml"), "--out", place.at("five_bar.h5"), "--quiet"});
  ASSERT_EQ(made_of.status, 0) << made_of.err;
  EXPECT_THAT(made_of.out, HasSubstr(": 1 runs, "));
  const Outcome other =
      flinch({"evaluate", FLINCH_SOURCE_DIR "/apps/models/bodies.onnx", place.at("five_bar.h5")});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("train it anew with data of this robot"));
  EXPECT_EQ(std::count(other.err.begin(), other.err.end(), '\n'), 1) << other.err;
}

TEST_F(LearningVerbs, TakeTheBestNetworkOfTheGrid) {
  const Outcome outcome = flinch({"train", data(), "-o", place.at("chain.onnx"), "--question", "chain",
                                  "--grid", "--epochs", "2", "--folds", "2", "--threads", "2", "--quiet"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::istringstream lines(outcome.out);
  std::string line;
  std::getline(lines, line);
  struct Tried {
    std::size_t layers = 0;
    int width = 0;
    double l2 = 0.0;
    int epochs = 0;
    double accuracy = 0.0;
    std::string percent;
    double cross_entropy = 0.0;
  };
  std::vector<Tried> table;
  for (Tried tried; std::getline(lines, line);) {
    std::istringstream row(line);
    row >> tried.layers >> tried.width >> tried.l2 >> tried.epochs >> tried.accuracy >> tried.percent;
    if (row >> tried.cross_entropy) table.push_back(tried);
  }
  ASSERT_EQ(table.size(), 80U) << outcome.out;
  const auto is_better = [](const Tried& a, const Tried& b) { return a.cross_entropy < b.cross_entropy; };
  const auto [best, worst] = std::minmax_element(table.begin(), table.end(), is_better);
  EXPECT_LT(best->cross_entropy, worst->cross_entropy);
  const ClassifierModel model = read_onnx(place.at("chain.onnx"));
  const auto chosen = std::find_if(table.begin(), table.end(), [&model](const Tried& tried) {
    return model.network.layers.size() == tried.layers + 1 &&
           model.network.layers.front().weights.rows() == tried.width &&
           std::stod(model.provenance.at("l2")) == tried.l2;
  });
  ASSERT_NE(chosen, table.end());
  EXPECT_EQ(chosen->cross_entropy, best->cross_entropy);
  EXPECT_EQ(chosen->epochs, 2);
}

TEST_F(LearningVerbs, MakeAModelThatARunCanFollow) {
  const Outcome outcome = flinch({"run", place.at("scenarios/platform_collision.yaml"), "--classifier",
                                  model(), "--out", place.at("run"), "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto contact = nlohmann::json::parse(outcome.out)["contacts"][0];
  EXPECT_EQ(contact["classified"], "platform");
  EXPECT_GT(contact["probability"], 0.3);
  const Outcome other = flinch({"run", place.at("scenarios/five_bar_collision.yaml"), "--classifier", model(),
                                "--out", place.at("other")});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("train it anew with data of this robot"));
}

TEST_F(LearningVerbs, MakeAModelThatEveryRunOfACampaignCanFollow) {
  place.write("campaigns/one.yaml", "scenario: ../scenarios/platform_collision.yaml\nruns: 1\n");
  const auto campaign = [&](const std::string& folder, const std::vector<std::string>& options) {
    std::vector<std::string> words = {"campaign", place.at("campaigns/one.yaml"), "--out", place.at(folder)};
    words.insert(words.end(), options.begin(), options.end());
    return flinch(words);
  };
  const Outcome follows = campaign("table", {"--classifier", model()});
  EXPECT_EQ(follows.status, 0) << follows.err;
  const Outcome does_not = campaign("table", {});
  EXPECT_EQ(does_not.status, 2) << "results of two classifiers in one table";
  EXPECT_THAT(does_not.err, HasSubstr("holds the results of another campaign"));
  const Outcome alone = campaign("alone", {"--classifier", model(), "--run", "0", "--json"});
  ASSERT_EQ(alone.status, 0) << alone.err;
  const Outcome usual = campaign("usual", {"--run", "0", "--json"});
  const auto probability = [](const Outcome& outcome) {
    return nlohmann::json::parse(outcome.out)["contacts"][0]["probability"];
  };
  EXPECT_NE(probability(alone), probability(usual));
  const Outcome wrong = campaign("wrong", {"--classifier", place.at("campaigns/one.yaml")});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("this is no ONNX file"));
}

TEST_F(LearningVerbs, LetAScenarioNameTheNetworksThatItAsks) {
  const std::string scenario = place.at("scenarios/platform_collision.yaml");
  const auto run = [&](const std::string& settings) {
    return flinch({"run", scenario, "--set", "control.classifiers=[papers_networks, model_classifier]",
                   "--set", "control.isolation=" + settings, "--out", place.at("named"), "--json"});
  };
  const Outcome shipped = run("{observer_gain_per_s: 20}");
  ASSERT_EQ(shipped.status, 0) << shipped.err;
  EXPECT_TRUE(nlohmann::json::parse(shipped.out)["contacts"][0]["classified"].is_string());
  const Outcome wrong = run("{papers_networks: {body: '" + model() + "'}}");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("answers the question 'touched', and that of 'body' is asked for"));
  const std::filesystem::path own = place.at("scenarios/own.onnx");
  std::filesystem::copy_file(FLINCH_SOURCE_DIR "/apps/models/papers_body.onnx", own);
  EXPECT_EQ(run("{papers_networks: {body: own.onnx}}").status, 0) << "from the scenario on";
  std::filesystem::remove(own);
  const Outcome report =
      flinch({"report", place.at("named/run.h5"), "--out", place.at("named/again.html"), "--quiet"});
  EXPECT_EQ(report.status, 0) << report.err;
  const Outcome gone = run("{papers_networks: {body: own.onnx}}");
  EXPECT_EQ(gone.status, 2);
  EXPECT_THAT(gone.err, AllOf(HasSubstr("control.isolation.papers_networks.body: "), HasSubstr("own.onnx")));
  const Outcome none = flinch({"run", scenario, "--set", "control.classifiers=[papers_network]", "--out",
                               place.at("none"), "--json"});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("did you mean 'papers_networks'?"));
}

TEST_F(LearningVerbs, MakeThePapersThreeModelsThatARunCanFollow) {
  std::vector<std::string> three;
  const auto follow = [&](const std::string& scenario, const std::vector<std::string>& models) {
    std::vector<std::string> words = {"run", place.at("scenarios/" + scenario), "--out", place.at("run"),
                                      "--json"};
    for (const std::string& each : models) words.insert(words.end(), {"--classifier", each});
    return flinch(words);
  };
  for (const std::string question : {"clamping", "chain", "body"}) {
    three.push_back(place.at(question + ".onnx"));
    const Outcome made_it = flinch({"train", data(), "-o", three.back(), "--question", question, "--hidden",
                                    "10,10", "--epochs", "10", "--folds", "3", "--threads", "2", "--quiet"});
    ASSERT_EQ(made_it.status, 0) << made_it.err;
  }
  const Outcome outcome = follow("platform_collision.yaml", three);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Recording recording = read_recording(place.at("run/run.h5"));
  EXPECT_NE(recording.find("classification_model_classifier"), nullptr) << "no longer the followed one";
  const RecordedValues<ContactClassification> said(recording, "classification");
  std::size_t told = 0;
  for (std::size_t k = 0; k < recording.samples(); ++k) {
    const ContactClassification now = said[k];
    if (!now.valid) continue;
    ++told;
    ASSERT_EQ(now.probability.size(), 10);
    EXPECT_NEAR(now.probability.sum(), 1.0, 1e-9);
    EXPECT_GT(now.confidence(), 0.1) << "the largest of ten";
  }
  EXPECT_GT(told, 10U);
  const Outcome missing = follow("platform_collision.yaml", {three[0], three[2]});
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.err, HasSubstr("the question 'chain' has no model"));
  const Outcome twice = follow("platform_collision.yaml", {three[0], three[1], three[2], three[1]});
  EXPECT_EQ(twice.status, 2);
  EXPECT_THAT(twice.err, HasSubstr("both answer the question 'chain'"));
  const Outcome mixed = follow("platform_collision.yaml", {model(), three[0]});
  EXPECT_EQ(mixed.status, 2);
  EXPECT_THAT(mixed.err, HasSubstr("a model of the question 'touched' needs no other beside it"));
  const Outcome other = follow("five_bar_collision.yaml", three);
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("body.onnx: the model was trained for the robot"));
}

TEST_F(LearningVerbs, SayOnceWhatIsWrongWithAFile) {
  const std::string whole = test::bytes_of(model());
  place.write("short.onnx", whole.substr(0, whole.size() / 2));
  const Outcome torn = flinch({"evaluate", place.at("short.onnx"), data()});
  EXPECT_EQ(torn.status, 2);
  EXPECT_THAT(torn.err, HasSubstr("short.onnx: this is no ONNX file, or only a part of one"));
  const Outcome absent = flinch({"train", place.at("none.h5"), "-o", place.at("x.onnx")});
  EXPECT_EQ(absent.status, 2);
  EXPECT_THAT(absent.err, HasSubstr("none.h5: there is no such file"));
  const Outcome other = flinch({"train", data(), "-o", place.at("x.onnx"), "--question", "chian"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("did you mean 'chain'?"));
  EXPECT_FALSE(std::filesystem::exists(place.at("x.onnx")));
  const Outcome folds = flinch({"train", data(), "-o", place.at("x.onnx"), "--folds-by", "configurations"});
  EXPECT_EQ(folds.status, 2);
  EXPECT_THAT(folds.err, HasSubstr("did you mean 'configuration'?"));
}

}  // namespace
}  // namespace flinch

#endif
