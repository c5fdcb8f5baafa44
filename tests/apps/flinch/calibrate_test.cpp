// flinch calibrate, as typed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "systems/foundation/sha256.h"
#include "tests/apps/flinch/documented_keys.h"
#include "tests/apps/flinch/program.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using test::flinch;
using test::Outcome;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* square = "scenarios/square.yaml";
constexpr const char* random_motion = "scenarios/random_motion.yaml";
constexpr const char* collision = "scenarios/platform_collision.yaml";

class CalibrateThresholds : public ::testing::Test {
 protected:
  /// Half a minute of contact-free motion with two estimators.
  std::string contact_free_recording() const {
    place.replace(square, "duration_s: 3.5", "duration_s: 33");
    place.replace(square, "laps: 2", "laps: 24");
    place.replace(square, "control:\n",
                  "control:\n  estimators: [momentum_observer, momentum_kalman_filter]\n");
    EXPECT_EQ(flinch({"run", place.at(square), "--out", place.at("free"), "--quiet"}).status, 0);
    return place.at("free/run.h5");
  }

  test::Workplace place;
};

TEST_F(CalibrateThresholds, FindsThoseOfEachEstimatorAndAScenarioTakesThem) {
  const std::string recording = contact_free_recording();
  const Outcome outcome =
      flinch({"calibrate", "thresholds", recording, "--json", "--out", place.at("thresholds.yaml")});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(json["thresholds"].size(), 2U);
  EXPECT_THAT(test::undocumented_keys(json, "Thresholds"), IsEmpty());
  for (const auto& of : json["thresholds"]) {
    EXPECT_GT(of["force_N"]["value"], of["force_N"]["largest"]) << of;
    EXPECT_LT(of["force_N"]["value"], 5.0) << "the plant is as modelled: " << of;
  }
  EXPECT_THAT(
      test::bytes_of(place / "thresholds.yaml"),
      HasSubstr("  - {file: '" + recording + "', sha256: '" + sha256(test::bytes_of(recording)) + "'}\n"));
  EXPECT_EQ(flinch({"check", place.at("thresholds.yaml")}).status, 0);
  const std::string found = test::bytes_of(place / "thresholds.yaml");
  place.write("broken.yaml", found.substr(0, found.find("control:")) + "control: {contact_detctor: {}}\n");
  EXPECT_THAT(flinch({"check", place.at("broken.yaml")}).err,
              HasSubstr("control.contact_detctor: is not a known key; did you mean 'contact_detector'?"));
  place.replace(collision, "control:\n", "calibrations: [{file: ../thresholds.yaml}]\ncontrol:\n");
  const Outcome run = flinch({"run", place.at(collision), "--out", place.at("out"), "--json"});
  const auto contact = nlohmann::json::parse(run.out)["contacts"][0];
  EXPECT_LT(contact["detection_ms"], 11.0) << "its threshold is below the 10 N with which it takes 12 ms";

  flinch({"report", place.at("out/run.h5"), "--out", place.at("again.html")});
  EXPECT_TRUE(test::bytes_of(place / "again.html") == test::bytes_of(place / "out/report.html"))
      << "the recording keeps them";
}

TEST_F(CalibrateThresholds, FindsWhatTheFusedDetectorJudgesByAndAScenarioTakesIt) {
  place.replace(random_motion, "duration_s: 36", "duration_s: 32.5");
  EXPECT_EQ(flinch({"run", place.at(random_motion), "--out", place.at("free"), "--quiet"}).status, 0);
  const Outcome outcome = flinch(
      {"calibrate", "thresholds", place.at("free/run.h5"), "--json", "--out", place.at("thresholds.yaml")});
  EXPECT_THAT(outcome.err, HasSubstr("warning: one recording does not tell how robots differ"));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(test::undocumented_keys(nlohmann::json::parse(outcome.out), "Thresholds"), IsEmpty());
  const auto json = nlohmann::json::parse(outcome.out)["fused_detector"];
  ASSERT_EQ(json.size(), 2U);
  for (const auto& of : json) {
    for (const char* part : {"level", "change"}) {
      EXPECT_GT(of[part]["value"], of[part]["largest"]) << of;
      EXPECT_LT(of[part]["variation"], 0.05) << of;
      EXPECT_LT(of[part]["best_guess"], 8.0)
          << "normal errors need 6 deviations, and the longest tail 7: " << of;
      constexpr double inertia = 0.3;  // at the drives, hardly ever less [kg m^2]
      EXPECT_GT(std::hypot(of[part]["noise"].get<double>(), inertia * of[part]["acceleration"].get<double>()),
                0.05)
          << "of the currents alone: " << of;
    }
    EXPECT_GT(of["onset"]["value"], of["onset"]["largest"]) << of;
    EXPECT_LT(of["onset"]["innovation"], 1.0) << "errors tell something of those that follow: " << of;
  }
  place.replace(collision, "control:\n",
                "calibrations: [{file: ../thresholds.yaml}]\ncontrol:\n"
                "  detectors: [contact_detector, fused_detector]\n");
  const Outcome run = flinch({"run", place.at(collision), "--out", place.at("out"), "--json"});
  const auto by = nlohmann::json::parse(run.out)["contacts"][0]["detection_by_estimator_ms"];
  EXPECT_LT(by["fused_detector"], 6.0);
  EXPECT_LT(by["fused_detector"], by["momentum_observer"]);

  place.replace(collision, "control:\n", "control:\n  fused_detector: {rule: likelihood_ratio}\n");
  const Outcome by_onsets = flinch({"run", place.at(collision), "--out", place.at("onsets"), "--json"});
  const auto times = nlohmann::json::parse(by_onsets.out)["contacts"][0]["detection_by_estimator_ms"];
  EXPECT_LT(times["fused_detector"], 6.0);
}

TEST_F(CalibrateThresholds, OfSeveralRobotsAreHigherThanOfOneThatVariesAsMuch) {
  place.replace(random_motion, "duration_s: 36", "duration_s: 16");
  place.replace(random_motion,
                "momentum_observer, momentum_kalman_filter, sliding_mode_observer, direct_extended_imu_ekf, "
                "disturbance_filter, imu_residual",
                "disturbance_filter");
  for (const char* const seed : {"1", "2"})
    flinch({"run", place.at(random_motion), "--seed", seed, "--out", place.at(seed), "--quiet"});
  const auto level = [&](std::vector<std::string> also) {
    std::vector<std::string> call = {"calibrate", "thresholds", place.at("1/run.h5"), place.at("2/run.h5"),
                                     "--json"};
    call.insert(call.end(), also.begin(), also.end());
    return nlohmann::json::parse(flinch(call).out)["fused_detector"][0]["level"];
  };
  const auto several = level({}), one = level({"--one-robot"});
  EXPECT_GT(several["between_robots"], 0.0);
  EXPECT_EQ(one["between_robots"], 0.0);
  EXPECT_NEAR(several["variation"].get<double>(), one["variation"].get<double>(), 1e-9);
  EXPECT_GT(several["value"], one["value"]);
}

TEST_F(CalibrateThresholds, OfAnEstimatorDecideWhenItsDetectorNotices) {
  place.replace(collision, "control:\n",
                "control:\n  estimators: [momentum_observer, momentum_kalman_filter]\n");
  place.replace(collision, "contact_detector: {reaction_force_N: 10, reaction_moment_Nm: 1}",
                "contact_detector: {reaction_force_N: 10, reaction_moment_Nm: 1, by_estimator: [{estimator: "
                "momentum_kalman_filter, reaction_force_N: 1000, reaction_moment_Nm: 1000}]}");
  const Outcome outcome = flinch({"run", place.at(collision), "--out", place.at("out"), "--json"});
  const auto by = nlohmann::json::parse(outcome.out)["contacts"][0]["detection_by_estimator_ms"];
  EXPECT_TRUE(by["momentum_kalman_filter"].is_null());
  EXPECT_FALSE(by["momentum_observer"].is_null());
}

TEST_F(CalibrateThresholds, TellsEveryRecordingThatWillNotDo) {
  flinch({"run", place.at(collision), "--out", place.at("touched"), "--quiet"});
  const Outcome outcome =
      flinch({"calibrate", "thresholds", place.at("touched/run.h5"), place.at("none.h5")});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("touched/run.h5: something touched or pushed the robot at 0."));
  EXPECT_THAT(outcome.err, HasSubstr("none.h5: there is no such file"));
}

TEST_F(CalibrateThresholds, TellsAnEstimatorThatNobodyKnows) {
  place.replace(collision, "reaction_moment_Nm: 1}",
                "reaction_moment_Nm: 1, by_estimator: [{estimator: momentum_obsever, reaction_force_N: 5}]}");
  const Outcome outcome = flinch({"check", place.at(collision)});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("by_estimator[0].estimator: is 'momentum_obsever'"));
  EXPECT_THAT(outcome.err, HasSubstr("did you mean 'momentum_observer'?"));
}

TEST(Calibrate, SaysWhatItCanCalibrate) {
  for (const std::vector<std::string>& typed :
       {std::vector<std::string>{"calibrate"}, {"calibrate", "treshold"}}) {
    const Outcome outcome = flinch(typed);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err,
                HasSubstr("needs a kind; known are: thresholds, torque-constant, dynamics, imu-pose, all"));
  }
  EXPECT_THAT(flinch({"--help"}).out, HasSubstr("VERB"));
  EXPECT_THAT(flinch({"calibrate", "--help"}).out, HasSubstr("WHAT"));
}

}  // namespace
}  // namespace flinch
