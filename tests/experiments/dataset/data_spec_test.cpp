#include "experiments/dataset/data_spec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/workplace.h"

namespace flinch {
namespace {

TEST(DataSpec, TellsOnceWhatIsDoubtfulAboutCalibrationsOfItsCampaigns) {
  const test::Workplace place;
  place.write("scenarios/found.yaml",
              "flinch_calibration: 1\nkind: thresholds\ndate: '2026-11-27'\n"
              "settings: [{name: control.velocity_filter.cutoff_frequency, value: '60', unit: Hz}]\n"
              "control: {contact_detector: {reaction_force_N: 5}}\n");
  place.replace("scenarios/platform_collision.yaml",
                "robot: ", "calibrations: [{file: found.yaml}]\nrobot: ");
  const std::string campaign =
      "scenario: ../scenarios/platform_collision.yaml\nruns: 1\ncontact: {body: [platform]}\n"
      "draw: [{key: motion.direction_deg, from: 0, to: 360}]\n";
  place.write("campaigns/one.yaml", campaign);
  place.write("campaigns/two.yaml", campaign);
  place.write("models/both.yaml",
              "contacts: [{campaign: ../campaigns/one.yaml}, {campaign: ../campaigns/two.yaml}]\n");
  EXPECT_THAT(read_data_spec(place / "models/both.yaml").warnings,
              ::testing::ElementsAre(::testing::Field(
                  &CalibrationWarning::sentence,
                  ::testing::HasSubstr("rests on control.velocity_filter.cutoff_frequency = 60 Hz"))));
  EXPECT_THAT(read_data_spec(test::shipped("models/bodies.yaml")).warnings, ::testing::IsEmpty());
}

}  // namespace
}  // namespace flinch
