#include "tests/identification/coverage.h"

#include <gtest/gtest.h>

namespace flinch {
namespace {

// A slice of tests/campaign/identification: 90 intervals, of which a twentieth are wrong by chance.
TEST(IntervalsOfTorqueConstants, CoverTheTruthInNearlyAllCalibrations) {
  EXPECT_GE(test::cover(30, 1000).share(), 0.87);
}

}  // namespace
}  // namespace flinch
