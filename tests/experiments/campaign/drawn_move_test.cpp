#include "experiments/campaign/drawn_move.h"

#include <gtest/gtest.h>

#include <cmath>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/campaign/run_campaign.h"
#include "experiments/campaign/run_result.h"
#include "systems/framework/random.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

DrawnContact on_the_left() {
  return {"platform", Eigen::Vector3d(-0.2, 0.1, 0.0), Eigen::Vector3d(-1.0, 0.0, 0.0),
          Eigen::Vector3d(-0.3, 0.0, 0.0)};
}

TEST(ADrawnMeeting, IsAtThePlaceAtTheTimeAndComesNearerBefore) {
  CampaignContact settings;
  settings.speed = 1.0;
  RandomGenerator random(1);
  int found = 0;
  for (int i = 0; i < 200; ++i) {
    const auto move = draw_meeting(settings, on_the_left(), 0.7, 2, random);
    if (!move) continue;
    ++found;
    const ObstaclePath path(move->path);
    EXPECT_TRUE(
        (move->position_in_base + path.at(0.7).displacement).isApprox(on_the_left().position_in_base, 1e-12));
    const Eigen::Vector3d velocity = path.at(0.7).velocity;
    EXPECT_LE(velocity.norm(), settings.speed * 1.0001);
    EXPECT_GE((on_the_left().velocity - velocity).dot(on_the_left().normal), 0.05 - 1e-9);
    EXPECT_EQ(velocity.z(), 0.0);
  }
  EXPECT_GT(found, 80);
  EXPECT_LT(found, 200);
}

TEST(ADrawnPush, StretchesItsSpringByTheForceAndGoesBack) {
  CampaignContact settings;
  settings.force = {20.0, 60.0};
  settings.angle = 0.4;
  settings.rise = 0.5;
  settings.hold = 0.2;
  RandomGenerator random(1);
  for (int i = 0; i < 100; ++i) {
    const DrawnMove move = draw_push(settings, on_the_left(), 0.4, 2, random);
    const ObstaclePath path(move.path);
    EXPECT_EQ(path.at(0.4).displacement.norm(), 0.0);
    EXPECT_NEAR(path.at(1.6).displacement.norm(), 0.0, 1e-12);
    const Eigen::Vector3d pressed = path.at(1.0).displacement;
    // Where it first touches, it has gone as far as it stood off the body along the normal.
    const double angle = std::acos(-pressed.normalized().dot(on_the_left().normal));
    EXPECT_LE(angle, 0.4 + 1e-9);
    const double to_touch = 0.005 / std::cos(angle);
    const double force = pushing_stiffness * (pressed.norm() - to_touch);
    EXPECT_GE(force, 20.0 - 1e-6);
    EXPECT_LE(force, 60.0 + 1e-6);
  }
}

class CampaignOf : public ::testing::Test {
 protected:
  CampaignResults run(const std::string& name) {
    const Campaign campaign =
        read_campaign(FLINCH_SOURCE_DIR "/apps/models/bodies/" + name, {.set = {}, .draws = 8});
    std::filesystem::create_directories(place / "out");
    return run_campaign(campaign, place / "out", 2);
  }
  test::Workplace place;
};

/// Whether what was touched first is of the kind that was to be touched.
double share_touched_as_drawn(const CampaignResults& results) {
  int right = 0;
  for (const RunResult& result : results) {
    for (const auto& [key, value] : result.values)
      if (key == "contact" && value.ends_with(result.body)) ++right;
  }
  return right / static_cast<double>(results.size());
}

TEST_F(CampaignOf, MovingObjectsTouchesWhatItMeans) {
  EXPECT_GT(share_touched_as_drawn(run("run_into.yaml")), 0.7);
}

TEST_F(CampaignOf, PressingHandsTouchesWhatItMeansAndAsHardAsItSays) {
  const auto results = run("pressed.yaml");
  EXPECT_GT(share_touched_as_drawn(results), 0.9);
  for (const RunResult& result : results) EXPECT_LT(result.peak_force.value_or(0.0), 80.0);
}

}  // namespace
}  // namespace flinch
