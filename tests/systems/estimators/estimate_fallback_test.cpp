#include "systems/estimators/estimate_fallback.h"

#include <gtest/gtest.h>

#include "tests/support/ticking.h"

namespace flinch {
namespace {

WrenchEstimate estimate(double force, bool valid) {
  WrenchEstimate estimate;
  estimate.valid = valid;
  estimate.wrench_in_base = PlatformVector::Constant(3, force);
  estimate.health.innovation = force;
  return estimate;
}

TEST(EstimateFallback, TakesTheOtherInTheTickInWhichThePreferredFailsAndSaysSo) {
  DiagramBuilder builder;
  auto& block = builder.add<EstimateFallback>("block");
  const auto preferred = builder.export_input("preferred", block.preferred);
  const auto other = builder.export_input("other", block.other);
  test::Ticking ticking(builder);
  for (const bool first : {true, false, true}) {
    for (const bool second : {true, false}) {
      ticking.set(preferred, estimate(1.0, first));
      ticking.set(other, estimate(2.0, second));
      ticking.tick();
      const WrenchEstimate& seen = ticking.get(block.wrench);
      EXPECT_EQ(seen.valid, first || second);
      EXPECT_EQ(seen.wrench_in_base[0], first ? 1.0 : 2.0);
      EXPECT_EQ(seen.health.fallen_back, !first);
      EXPECT_EQ(seen.health.innovation, 1.0);  // why it fell back
    }
  }
}

}  // namespace
}  // namespace flinch
