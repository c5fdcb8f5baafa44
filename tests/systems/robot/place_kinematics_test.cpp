#include "systems/robot/place_kinematics.h"

#include "systems/framework/random.h"
#include "tests/systems/robot/mechanism_laws.h"

namespace flinch::test {
namespace {

// Of mechanisms with a place of their own; the others take it out of the whole, which the test of invalid
// poses is left to try.
class PlaceLaws : public MechanismLaws {
 protected:
  PlaceKinematics place_at(const Configuration& pose) const {
    PlaceKinematics place;
    place.valid = true;
    robot.place(pose, place);
    return place;
  }
  void expect_that_of_the_whole(const Configuration& pose) const {
    const Kinematics whole = kinematics_at(pose, PlatformVector::Zero(n));
    const PlaceKinematics place = place_at(pose);
    ASSERT_EQ(place.valid, whole.valid) << pose.transpose();
    if (!whole.valid) return;
    EXPECT_EQ(place.J_qa_x, whole.J_qa_x);
    EXPECT_EQ(place.det_A, whole.det_A);
    EXPECT_EQ(place.det_B, whole.det_B);
    EXPECT_EQ(place.sigma_kappa, whole.sigma_kappa);
    for (int leg = 0; leg < robot.legs(); ++leg) {
      const auto i = static_cast<std::size_t>(leg);
      EXPECT_EQ(place.legs[i].base_joint, whole.legs[i].base_joint);
      EXPECT_EQ(place.legs[i].passive_joint, whole.legs[i].passive_joint);
      EXPECT_EQ(place.legs[i].coupling_joint, whole.legs[i].coupling_joint);
    }
  }
};
FLINCH_FOR_ALL_MECHANISMS(PlaceLaws);

TEST_P(PlaceLaws, IsThatOfTheWholeKinematicsToTheBit) {
  for (const MotionState& state : states) expect_that_of_the_whole(state.pose);
}

// On both sides of singularities and beyond reach.
TEST_P(PlaceLaws, IsValidWhereTheWholeIsAlsoFarFromHome) {
  RandomGenerator random(1);
  int valid = 0, invalid = 0;
  for (int k = 0; k < 2000; ++k) {
    const double width = random.uniform(0.0, 8.0);
    PlatformVector moved(n);
    for (int i = 0; i < n; ++i) moved[i] = width * GetParam().region[i] * random.uniform(-1.0, 1.0);
    const Configuration pose = space.plus(robot.home_pose(), moved);
    expect_that_of_the_whole(pose);
    ++(place_at(pose).valid ? valid : invalid);
  }
  EXPECT_GT(valid, 100);
  EXPECT_GT(invalid, 100);
}

TEST_P(PlaceLaws, OfWhatIsNoPoseIsNotValid) {
  EXPECT_FALSE(place_at(Configuration()).valid);
  Configuration infinite = robot.home_pose();
  infinite[0] = HUGE_VAL;
  EXPECT_FALSE(place_at(infinite).valid);
}

}  // namespace
}  // namespace flinch::test
