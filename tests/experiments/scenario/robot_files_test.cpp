#include "experiments/scenario/robot_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "systems/foundation/setup_error.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;

TEST(RobotFilesOfManyScenarios, AreReadOnceEach) {
  const test::Workplace place;
  RobotFiles robots;
  const auto first = robots.read(place / "robots/planar_3rrr.yaml");
  const std::string text = test::bytes_of(place / "robots/planar_3rrr.yaml");
  EXPECT_EQ(first->text, text);
  place.write("robots/planar_3rrr.yaml", "changed meanwhile");
  EXPECT_EQ(robots.read(place / "robots/planar_3rrr.yaml"), first);
  EXPECT_NE(robots.read(place / "robots/five_bar.yaml"), first);
}

TEST(RobotFilesOfManyScenarios, ComeWithTheParameterFilesThatTheseName) {
  const test::Workplace place;
  RobotFiles robots;
  const std::string name = "calibrations/bench_thresholds.yaml";
  const std::string text = test::bytes_of(place / name);
  const auto first = robots.read_calibration(place / name);
  EXPECT_EQ(first->text, text);
  place.write(name, "changed meanwhile");
  EXPECT_EQ(robots.read_calibration(place / name), first);
  EXPECT_THROW(robots.read_calibration(place / "robots/planar_3rrr.yaml"), SetupError);
  const auto robot = robots.read(place / "robots/planar_3rrr.yaml");
  EXPECT_THAT(robots.texts(), ElementsAre(robot->text, text)) << "of what was good";
}

TEST(RobotFilesOfManyScenarios, AreReadAgainWhereTheyWereNoGood) {
  const test::Workplace place;
  RobotFiles robots;
  const std::string text = test::bytes_of(place / "robots/planar_3rrr.yaml");
  place.write("robots/planar_3rrr.yaml", "kind: nothing");
  EXPECT_THROW(robots.read(place / "robots/planar_3rrr.yaml"), SetupError);
  place.write("robots/planar_3rrr.yaml", text);
  EXPECT_EQ(robots.read(place / "robots/planar_3rrr.yaml")->text, text);
}

}  // namespace
}  // namespace flinch
