#include "diagrams/base_force_isolation.h"

#include <gtest/gtest.h>

#include <memory>

#include "diagrams/contact_control.h"
#include "diagrams/robot_settings.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "tests/systems/contact/touched_robot.h"

namespace flinch {
namespace {

ContactControl control_of(const std::shared_ptr<const ParallelRobot>& robot, bool sensors, int legs = 3) {
  DiagramBuilder builder("test", 1ms);
  ContactControlSettings settings =
      settings_for(*robot, default_drives(robot->drive_kind(0), robot->drives()), {});
  if (sensors) {
    settings.isolation.base_forces.emplace();
    settings.isolation.base_forces->first_moment = JointVector::Constant(legs, 1.1);
  }
  return add_contact_control(builder, robot, settings);
}

TEST(BaseForceIsolation, IsThereWhereTheSettingsKnowOfTheSensors) {
  const auto robot = test::touched_rig();
  const ContactControl without = control_of(robot, false);
  EXPECT_FALSE(without.base_forces);
  EXPECT_TRUE(without.others.located_contacts.empty());
  const ContactControl with = control_of(robot, true);
  EXPECT_TRUE(with.base_forces);
  ASSERT_EQ(with.others.located_contacts.size(), 1U);
  EXPECT_EQ(with.others.located_contacts[0].name, "located_contacts");
  EXPECT_EQ(with.others.base_forces.at(0).name, "base_force");
}

TEST(BaseForceIsolation, IsRefusedWhereNothingIsKnownOfTheBaseJoints) {
  EXPECT_THROW(control_of(test::touched_rig(), true, 2), SetupError);
  const auto spatial =
      std::make_shared<const Hexapod>(hexapod_robot(HexapodPayload::none, HexapodFriction::none));
  EXPECT_THROW(control_of(spatial, true, 6), SetupError);
}

}  // namespace
}  // namespace flinch
