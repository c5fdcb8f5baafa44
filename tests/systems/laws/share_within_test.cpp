#include "systems/laws/share_within.h"

#include <gtest/gtest.h>

namespace flinch {
namespace {

TEST(ShareWithin, IsAllOfWhatIsNotTooLarge) {
  EXPECT_EQ(share_within(Eigen::Vector3d(1.0, -2.0, 0.5), 2.0), 1.0);
  EXPECT_EQ(share_within(Eigen::Vector3d::Zero(), 2.0), 1.0);
}

TEST(ShareWithin, LeavesTheLargestEntryAtItsLimit) {
  EXPECT_EQ(share_within(Eigen::Vector3d(1.0, -8.0, 4.0), 2.0), 0.25);
}

}  // namespace
}  // namespace flinch
