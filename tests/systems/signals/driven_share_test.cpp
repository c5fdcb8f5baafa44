#include "systems/signals/driven_share.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flinch {
namespace {

TEST(DrivenShare, AddsUpToTheDrivenTime) {
  double sum = 0.0;
  for (Time time = 0us; time < 1ms; time += 1us) {
    EXPECT_NEAR(driven_time(time), sum, 1e-8);
    sum += 1e-6 * 0.5 * (driven_share(time) + driven_share(time + 1us));
  }
  EXPECT_NEAR(driven_time(1ms), 0.85e-3, 1e-12) << "0.15 ms late in the mean";
}

// 1 - exp(-t / L) of a loop whose current follows its command with a bandwidth of 1 / (2 pi L).
TEST(DrivenShare, MayBeThatOfAnyCurrentLoopFromAKilohertzOn) {
  for (const double bandwidth : {1e3, 2e3, 5e3, 50e3}) {
    for (Time time = 1us; time < 1ms; time += 1us) {
      const double share = 1.0 - std::exp(-to_seconds(time) * 2.0 * 3.141592653589793 * bandwidth);
      EXPECT_NEAR(share, driven_share(time), driven_uncertainty(time) + 0.03) << to_seconds(time) << " s";
    }
  }
  EXPECT_EQ(driven_uncertainty(1ms), 0.0) << "what is held is known";
}

}  // namespace
}  // namespace flinch
