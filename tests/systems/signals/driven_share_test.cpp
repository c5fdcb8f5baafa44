#include "systems/signals/driven_share.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace flinch
