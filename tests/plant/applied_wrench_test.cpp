#include "plant/applied_wrench.h"

#include <gtest/gtest.h>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram_builder.h"

namespace flinch {
namespace {

const WrenchRamp push{
    .peak_in_base = PlatformVector{{40.0, 0.0, 0.0}}, .start = 1s, .rise = 2s, .hold = 500ms, .fall = 4s};

double force_at(Time now) { return push.at(now).x(); }

TEST(WrenchRamp, RisesHoldsAndFalls) {
  EXPECT_EQ(force_at(0s), 0.0);
  EXPECT_EQ(force_at(1s), 0.0);
  EXPECT_DOUBLE_EQ(force_at(1500ms), 10.0);
  EXPECT_DOUBLE_EQ(force_at(3s), 40.0);
  EXPECT_DOUBLE_EQ(force_at(3400ms), 40.0);
  EXPECT_DOUBLE_EQ(force_at(3500ms), 40.0);
  EXPECT_DOUBLE_EQ(force_at(5500ms), 20.0);
  EXPECT_EQ(force_at(7500ms), 0.0);
  EXPECT_EQ(force_at(100s), 0.0);
}

TEST(WrenchRamp, OfNoDurationIsAStep) {
  const WrenchRamp step{
      .peak_in_base = PlatformVector{{0.0, 0.0, 3.0}}, .start = 1ms, .rise = 0s, .hold = 2ms, .fall = 0s};
  EXPECT_EQ(step.at(Time(999999)).z(), 0.0);
  EXPECT_EQ(step.at(1ms).z(), 3.0);
  EXPECT_EQ(step.at(Time(2999999)).z(), 3.0);
  EXPECT_EQ(step.at(3ms).z(), 0.0);
}

TEST(AppliedWrenchScript, AddsItsRampsUp) {
  DiagramBuilder builder("test", 1ms);
  const WrenchRamp other{
      .peak_in_base = PlatformVector{{1.0, 2.0, 3.0}}, .start = 0s, .rise = 0s, .hold = 10s, .fall = 0s};
  auto& script = builder.add<AppliedWrenchScript>("script", std::vector{push, other});
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  context.set_time(2s);
  diagram->evaluate(context);
  EXPECT_EQ(context.get(script.wrench).wrench_in_base, Eigen::Vector3d(21.0, 2.0, 3.0));
}

TEST(AppliedWrenchScript, RefusesNegativeDurations) {
  EXPECT_THROW(AppliedWrenchScript({{.fall = -1s}}), SetupError);
}

TEST(AppliedWrenchScript, RefusesWrenchesOfDifferentSizes) {
  EXPECT_THROW(AppliedWrenchScript({push, {.peak_in_base = PlatformVector::Ones(6)}}), SetupError);
}

}  // namespace
}  // namespace flinch
