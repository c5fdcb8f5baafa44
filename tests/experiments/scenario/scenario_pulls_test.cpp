#include "experiments/scenario/scenario_pulls.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/scenario/scenario.h"
#include "tests/support/problems_of.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Mountings, AreReadWithoutWhatOnlyASimulationNeeds) {
  const Scenario scenario = read_scenario(test::shipped("scenarios/calibration_pulls.yaml"));
  ASSERT_EQ(scenario.mountings.size(), 7U);
  EXPECT_EQ(scenario.mountings[1].body, BodyId::link2(0).index());
  EXPECT_EQ(scenario.mountings[1].start, 7s);
  EXPECT_EQ(scenario.mountings[1].slack, 500ms);
  EXPECT_EQ(scenario.mountings[6].position_in_body, Eigen::Vector3d(0.05, 0.02, 0.0));
}

TEST(Mountings, MustBeOnBodiesOfTheRobotOneAfterTheOther) {
  const test::Workplace place;
  place.write("scenarios/own.yaml",
              "robot: ../robots/planar_3rrr.yaml\nduration_s: 1\npulls:\n"
              "  - {body: leg1_lnk1, position_m: [0, 0], start_s: 2}\n"
              "  - {body: platform, position_m: [0, 0], start_s: 1}\n");
  EXPECT_THAT(test::problems_of([&] { read_scenario(place / "scenarios/own.yaml"); }),
              ElementsAre(HasSubstr("did you mean 'leg1_link1'"),
                          HasSubstr("is not after that of the entry before")));
}

}  // namespace
}  // namespace flinch
