#include "learning/evaluation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "learning/evaluation_output.h"
#include "learning/evaluation_page.h"
#include "systems/framework/random.h"
#include "tests/learning/contact_examples.h"

namespace flinch {
namespace {

Answered answered(int right, const std::vector<double>& probability) {
  return {
      0, 0, right,
      Eigen::Map<const Eigen::VectorXd>(probability.data(), static_cast<Eigen::Index>(probability.size()))};
}

TEST(Confusion, CountsRowsOfWhatIsTrueAndColumnsOfWhatIsSaid) {
  const std::vector<Answered> answers = {answered(0, {0.9, 0.1}), answered(0, {0.4, 0.6}),
                                         answered(0, {0.7, 0.3}), answered(0, {0.8, 0.2}),
                                         answered(1, {0.3, 0.7}), answered(1, {})};
  const Confusion confusion = confusion_of(answers, {"a", "b"}, {0, 1});
  EXPECT_EQ(confusion.counts, (Eigen::Matrix2d() << 3, 1, 0, 1).finished());
  EXPECT_EQ(confusion.unanswered, 1U);
  EXPECT_EQ(confusion.row_normalised(), (Eigen::Matrix2d() << 0.75, 0.25, 0, 1).finished());
  EXPECT_EQ(confusion.balanced_accuracy(), 0.875);  // and not 4 of 5
  EXPECT_EQ(confusion_of({}, {"a", "b"}, {0, 1}).balanced_accuracy(), std::nullopt);
}

TEST(Confusion, AddsUpClassesThatCountAsOneAndLeavesOthersOut) {
  // Classes 0 and 1 are collisions, class 2 is a clamping, class 3 is asked about nowhere.
  const std::vector<Answered> answers = {answered(0, {0.3, 0.3, 0.35, 0.05}),
                                         answered(2, {0.2, 0.1, 0.1, 0.6}),
                                         answered(3, {0.0, 0.0, 0.0, 1.0})};
  const Confusion confusion = confusion_of(answers, {"collision", "clamping"}, {0, 0, 1, -1});
  EXPECT_EQ(confusion.counts, (Eigen::Matrix2d() << 1, 0, 1, 0).finished());
}

TEST(Confusion, IsToldWithoutSharesWhereNothingWasAsked) {
  Evaluation evaluation;
  evaluation.moment = "later";
  evaluation.confusion = confusion_of({answered(0, {0.9, 0.1})}, {"a", "b"}, {0, 1});
  const std::string table = evaluation_table(evaluation, {evaluation});
  EXPECT_THAT(table, testing::ContainsRegex("a +100.0 % +0.0 % +1\n"));
  EXPECT_THAT(table, testing::ContainsRegex("b +- +- +0\n"));
}

TEST(Reliability, ComparesConfidenceWithHowOftenItWasRight) {
  const std::vector<Answered> answers = {answered(0, {0.95, 0.05}), answered(0, {0.95, 0.05}),
                                         answered(1, {0.95, 0.05}), answered(0, {0.65, 0.35})};
  const std::vector<ReliabilityBin> bins = reliability_of(answers, 10);
  EXPECT_EQ(bins[9].count, 3U);
  EXPECT_NEAR(bins[9].confidence, 0.95, 1e-12);
  EXPECT_NEAR(bins[9].accuracy, 2.0 / 3.0, 1e-12);
  EXPECT_EQ(bins[6].count, 1U);
  // (3 |2/3 - 0.95| + 1 |1 - 0.65|) / 4
  EXPECT_NEAR(expected_calibration_error(bins), (3 * (0.95 - 2.0 / 3.0) + 0.35) / 4.0, 1e-12);
}

TEST(Reliability, FindsNoErrorWhereProbabilitiesAreTrue) {
  RandomGenerator random(1);
  std::vector<Answered> answers;
  for (int i = 0; i < 50'000; ++i) {
    const double p = random.uniform(0.5, 1.0);
    answers.push_back(answered(random.uniform(0.0, 1.0) < p ? 0 : 1, {p, 1.0 - p}));
  }
  EXPECT_LT(expected_calibration_error(reliability_of(answers)), 0.01);
}

TEST(Rejection, LeavesOutWhatIsNotSure) {
  const std::vector<Answered> answers = {answered(0, {0.9, 0.1}), answered(0, {0.8, 0.2}),
                                         answered(1, {0.7, 0.3}), answered(0, {0.6, 0.4})};
  EXPECT_EQ(reject_at(answers, 0.0).wrong_of_accepted, 0.25);
  EXPECT_EQ(reject_at(answers, 0.75).rejected, 0.5);
  EXPECT_EQ(reject_at(answers, 0.75).wrong_of_accepted, 0.0);
  EXPECT_EQ(reject_at(answers, 0.95).rejected, 1.0);
  EXPECT_EQ(acceptance_for(answers, 0.0), 0.8);
  EXPECT_EQ(acceptance_for(answers, 0.25), 0.6);
}

TEST(Rejection, OfAShareTakesTheLeastSure) {
  std::vector<Answered> answers;
  for (int i = 0; i < 20; ++i) {  // of 20 answers that get surer the first and the fourth are wrong
    const double sure = 0.6 + 0.01 * i;
    answers.push_back(answered(i == 0 || i == 3 ? 1 : 0, {sure, 1.0 - sure}));
  }
  const RejectPoint tenth = reject_share(answers, 0.1);
  EXPECT_DOUBLE_EQ(tenth.rejected, 0.1);
  EXPECT_EQ(tenth.accepted_from, 0.62);
  EXPECT_DOUBLE_EQ(tenth.wrong_of_accepted, 1.0 / 18.0);
  EXPECT_EQ(reject_share(answers, 0.2).wrong_of_accepted, 0.0);
  EXPECT_DOUBLE_EQ(reject_share(answers, 0.12).rejected, 0.1);  // not more than was allowed
  const std::vector<RejectPoint> curve = reject_curve(answers);
  ASSERT_EQ(curve.size(), 100U);
  EXPECT_DOUBLE_EQ(curve.front().wrong_of_accepted, 0.1);
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const RejectPoint same = reject_at(answers, curve[i].accepted_from);
    EXPECT_DOUBLE_EQ(same.rejected, curve[i].rejected);
    EXPECT_DOUBLE_EQ(same.wrong_of_accepted, curve[i].wrong_of_accepted);
  }
  EXPECT_EQ(reject_share({}, 0.1).rejected, 0.0);
}

TEST(Evaluation, TellsBodiesClampingsAndLegsApart) {
  const FeatureSet features(Question::touched, test::contact_examples(1, 1).robot);
  const auto sure = [](int right, int given) {
    std::vector<double> probability(10, 0.01);
    probability[static_cast<std::size_t>(given)] = 0.91;
    return answered(right, probability);
  };
  // Platform right; leg1_link1 taken for its link2; leg1_clamping for leg1_link1; leg2_clamping right.
  const Evaluation evaluation =
      evaluate({sure(0, 0), sure(1, 2), sure(7, 1), sure(8, 8)}, features, 0.5, "later");
  EXPECT_EQ(evaluation.samples, 4U);
  EXPECT_EQ(evaluation.body, 0.5);
  EXPECT_EQ(evaluation.collision, 1.0);
  EXPECT_EQ(evaluation.clamping, 0.5);
  EXPECT_EQ(evaluation.collision_clamping, 0.75);
  EXPECT_EQ(evaluation.chain, 1.0);
  const auto json = nlohmann::json::parse(evaluation_json(evaluation, {evaluation}));
  EXPECT_EQ(json["accuracy"]["body"], 0.5);
  EXPECT_EQ(json["accuracy"]["collision_clamping"], 0.75);
  EXPECT_EQ(json["accuracy"]["chain"], 1.0);
  EXPECT_EQ(json["samples"], 4);
  EXPECT_EQ(json["rejected"], 0.0);
  EXPECT_EQ(json["wrong_of_accepted"], 0.5);
  EXPECT_EQ(json["wrong_at_tenth_rejected"], 0.5);
  EXPECT_EQ(json["moments"]["later"]["wrong_at_tenth_rejected"], 0.5);
  EXPECT_EQ(json["reject_curve"].size(), 100U);
  EXPECT_EQ(json["reject_curve"][0]["accuracy_of_accepted"], 0.5);
  EXPECT_NEAR(json["expected_calibration_error"].get<double>(), 0.41, 1e-12);
  EXPECT_EQ(json["confusion"]["classes"][7], "leg1_clamping");
  EXPECT_EQ(json["confusion"]["rows"][7][1], 1.0);
}

TEST(RejectPoint, RejectsSureAnswersAboutWrenchesOfWhichNothingWasLearned) {
  DataSet data = test::contact_examples(2, 1);
  data.samples[0].course.front().wrench_in_base = Eigen::Vector3d(6.0, 0.0, 0.0);  // 3 deviations
  data.samples[1].course.front().wrench_in_base = Eigen::Vector3d(0.0, 0.0, 1.0);  // 5
  std::vector<Answered> answers = {answered(0, {0.9, 0.1}), answered(0, {0.9, 0.1})};
  answers[1].sample = 1;
  disbelieve_small(answers, data, 4.0);
  EXPECT_FALSE(answers[0].believable);
  EXPECT_TRUE(answers[1].believable);
  EXPECT_EQ(reject_at(answers, 0.5).rejected, 0.5);
}

TEST(EvaluationPage, KeepsNamesFromBecomingMarkup) {
  DataSet data = test::contact_examples(1, 1);
  data.card["title"] = "<script>alert(1)</script>";
  ClassifierModel model;
  model.provenance["robot.name"] = "\"><b>";
  const FeatureSet features(Question::clamping, data.robot);
  const Evaluation evaluation = evaluate({answered(0, {0.9, 0.1})}, features, 0.5, "later");
  const std::string page = evaluation_page({model, data, evaluation, {evaluation}});
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find("<b>"), std::string::npos);
  EXPECT_NE(page.find("&lt;script&gt;"), std::string::npos);
  EXPECT_NE(page.find("100.0 %"), std::string::npos);
}

TEST(EvaluationPage, CaptionsEachAxis) {
  const DataSet data = test::contact_examples(1, 1);
  const FeatureSet features(Question::clamping, data.robot);
  const Evaluation evaluation = evaluate({answered(0, {0.9, 0.1})}, features, 0.5, "later");
  const std::string page = evaluation_page({ClassifierModel(), data, evaluation, {evaluation}});
  for (const char* const caption : {">probability that it gives<", ">how often it was right<", ">rejected<",
                                    ">wrong of what is accepted<"})
    EXPECT_NE(page.find(caption), std::string::npos) << caption;
}

}  // namespace
}  // namespace flinch
