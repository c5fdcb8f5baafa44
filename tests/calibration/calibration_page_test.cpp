#include "calibration/calibration_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "calibration/calibration_output.h"
#include "calibration/calibration_result.h"
#include "calibration/page_drawing.h"
#include "systems/config/parameter_file.h"
#include "tests/experiments/report/chromium.h"
#include "tests/support/temporary_folder.h"

#include <nlohmann/json.hpp>

namespace flinch {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

CalibrationResult sample() {
  CalibrationResult result;
  result.kind = "torque-constant";
  result.robot_file = "robot.yaml";
  result.robot_sha256 = std::string(64, 'b');
  result.recordings = {{"a<b>.h5", std::string(64, 'a')}, {"c.h5", std::string(64, 'c')}};
  result.unseen = {{"unseen.h5", std::string(64, 'd')}};
  result.with = {{"constants.yaml", std::string(64, 'e')}};
  result.parameters = {
      {.name = "k[0]", .value = 6.0, .deviation = 0.1, .unit = "Nm/A", .before = 6.1, .belongs_to = "robot"},
      {.name = "k[1]", .value = 7.0, .deviation = 0.2, .unit = "Nm/A"},
      {.name = "p", .value = -0.097, .unit = "m", .identifiable = false, .before = -0.097}};
  result.residual_before = 0.5;
  result.residual_after = std::nan("");
  result.residual_unit = "Nm";
  result.covariance = Eigen::Matrix3d::Zero();
  result.covariance.topLeftCorner<2, 2>() << 0.01, 0.01, 0.01, 0.04;
  result.influence = Eigen::MatrixXd::Zero(3, 2);
  result.influence(0, 1) = -0.15;
  result.plots = {{.title = "drive 1",
                   .x_name = "current",
                   .x_unit = "A",
                   .y_name = "residual",
                   .y_unit = "Nm",
                   .x = {0.0, 1.0, 2.0},
                   .before = {0.5, -0.5, 0.1},
                   .after = {0.1, 0.0, -0.1}}};
  result.validation_unit = "N";
  result.validation = {{"platform", -3.0, -1.0, 0.0, 1.0, 4.0}};
  result.warnings = {"one & two"};
  return result;
}

TEST(CalibrationPage, ShowsAllThatIsKnownAndNeedsNothingElse) {
  const std::string page = calibration_page(sample(), "2026-11-22");
  for (const char* const text :
       {"k[0]", "not identifiable", "correlation 0.50", "-1.50", "platform", "one &amp; two", "a&lt;b&gt;.h5",
        "unseen.h5", "constants.yaml", "flinch 0.", "2026-11-22", "class='before'", "class='after'"})
    EXPECT_THAT(page, HasSubstr(text));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, Not(HasSubstr("http:")));
  EXPECT_THAT(page, Not(HasSubstr("https:")));
}

TEST(CalibrationPage, IsReadableAtEveryWidthAndOnPaper) {
  CalibrationResult result = sample();
  result.residual_after = 0.1;
  const test::TemporaryFolder folder;
  expect_works_in_chromium(folder.write("page.html", calibration_page(result, "2026-11-22")),
                           "report/still_page_in_browser.py");
}

TEST(Drawings, OfNothingAreNothing) {
  EXPECT_EQ(scatter_drawing({}), "");
  EXPECT_EQ(box_drawing({}, "N"), "");
}

TEST(CalibrationJson, HasTheKeysOfEveryKind) {
  const auto json = nlohmann::json::parse(calibration_json(sample()));
  EXPECT_EQ(json["kind"], "torque-constant");
  EXPECT_EQ(json["recordings"][1], "c.h5");
  EXPECT_EQ(json["parameters"][0]["standard_deviation"], 0.1);
  EXPECT_TRUE(json["parameters"][2]["standard_deviation"].is_null());
  EXPECT_EQ(json["parameters"][2]["identifiable"], false);
  EXPECT_TRUE(json["residual_after"].is_null()) << "what is no number is no data";
  EXPECT_EQ(json["warnings"][0], "one & two");
}

TEST(CalibrationYaml, IsAParameterFile) {
  CalibrationResult result = sample();
  result.residual_after = 0.1;
  const ParameterFile file = parse_parameter_file(calibration_yaml(result, "2026-11-22"), "found.yaml");
  EXPECT_EQ(file.kind, "torque-constant");
  EXPECT_EQ(file.robot.sha256, result.robot_sha256);
  ASSERT_EQ(file.parameters.size(), 3U);
  EXPECT_EQ(file.parameters[0].value, 6.0);
  EXPECT_EQ(file.recordings[0].file, "a<b>.h5");
}

TEST(CalibrationTable, SaysWhatIsNotIdentifiable) {
  EXPECT_THAT(calibration_table(sample()), HasSubstr("not identifiable: as believed before"));
}

}  // namespace
}  // namespace flinch
