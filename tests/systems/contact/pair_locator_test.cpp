#include "systems/contact/pair_locator.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "systems/foundation/setup_error.h"
#include "systems/robot/planar_leg_bases.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"
#include "tests/systems/contact/touched_robot.h"

namespace flinch {
namespace {

std::shared_ptr<const LegBases> bases_of(const std::shared_ptr<const PlanarRrr>& robot) {
  return std::make_shared<const PlanarLegBases>(robot, std::array<double, 3>{1.1, 1.1, 1.1});
}

struct Block {
  Block()
      : block(builder.add<PairLocator>("locator", robot, bases_of(robot), TouchPairsSettings(),
                                       WrenchUncertainty(), 5ms)),
        phase(builder.export_input("phase", block.phase)),
        kinematics(builder.export_input("kinematics", block.kinematics)),
        wrench(builder.export_input("wrench", block.wrench)),
        bases(builder.export_input("bases", block.bases)),
        ticking(builder) {}

  LocatedContacts see(const ContactPhase& contact, double force) {
    const Kinematics at = test::at_home(*robot);
    const PlatformVector pushed{{-force, 0.0, 0.0}};
    BaseForceEstimate felt;
    felt.valid = true;
    felt.force_in_base.setZero(6);
    ticking.set(phase, contact);
    ticking.set(kinematics, at);
    ticking.set(wrench, test::estimate_of(at, pushed, ticking.now()));
    ticking.set(bases, felt);
    ticking.tick();
    return ticking.get(block.contacts);
  }

  std::shared_ptr<const PlanarRrr> robot = test::touched_rig();
  DiagramBuilder builder{"test", 1ms};
  PairLocator& block;
  InputPort<ContactPhase> phase;
  InputPort<Kinematics> kinematics;
  InputPort<WrenchEstimate> wrench;
  InputPort<BaseForceEstimate> bases;
  test::Ticking ticking;
};

TEST(PairLocator, LooksAtTheDetectionAndAfterEachPeriodAndSaysNothingAfterwards) {
  Block locator;
  EXPECT_FALSE(locator.see({}, 0.0).valid);
  const ContactPhase contact{.active = true, .since = 1ms};
  const LocatedContacts first = locator.see(contact, 40.0);
  ASSERT_TRUE(first.valid);
  EXPECT_EQ(first.count, 1);
  EXPECT_EQ(first.contacts[0].body, 0);
  EXPECT_NEAR(first.contacts[0].point_in_base.x(), 0.137, 1e-3);
  const test::AllocationCounter allocations;
  for (int k = 0; k < 4; ++k) EXPECT_EQ(locator.see(contact, 80.0).acquired, first.acquired) << "it stands";
  const LocatedContacts anew = locator.see(contact, 80.0);
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_EQ(anew.acquired, 6ms);
  EXPECT_NEAR(-anew.contacts[0].force_in_base.x(), 80.0, 2.0);
  EXPECT_FALSE(locator.see({.active = false, .since = 1ms}, 0.0).valid);
}

TEST(PairLocator, AsksForAPeriod) {
  const auto robot = test::touched_rig();
  EXPECT_THROW(PairLocator(robot, bases_of(robot), {}, {}, 0ms), SetupError);
}

}  // namespace
}  // namespace flinch
