#include "systems/robot/quantity_units.h"

#include <gtest/gtest.h>

#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch {
namespace {

TEST(QuantityUnits, OfThePlanarRobotAreThoseOfTwoTranslationsARotationAndRevoluteDrives) {
  const PlanarRrr robot(rig_robot(RigGeometry::individual, RigFriction::none));
  const std::map<std::string, std::string> expected = {
      {"<pose>", "m, m, rad"},           {"<displacement>", "m, m, rad"},
      {"<velocity>", "m/s, m/s, rad/s"}, {"<acceleration>", "m/s^2, m/s^2, rad/s^2"},
      {"<wrench>", "N, N, Nm"},          {"<drive position>", "rad"},
      {"<drive velocity>", "rad/s"},     {"<drive force>", "Nm"},
      {"<drive inertia>", "kg m^2"},     {"<passive position>", "rad"}};
  EXPECT_EQ(quantity_units(robot), expected);
}

}  // namespace
}  // namespace flinch
