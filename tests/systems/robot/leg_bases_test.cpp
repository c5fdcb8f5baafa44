#include "systems/robot/leg_bases.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "systems/foundation/setup_error.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch {
namespace {

std::shared_ptr<const PlanarRrr> rig() {
  return std::make_shared<const PlanarRrr>(rig_robot(RigGeometry::nominal, RigFriction::none));
}

TEST(LegBases, AreHeavierAsTheLegsAre) {
  const auto model = rig();
  const auto heavier = model->deviating({.leg_inertia_scale = Eigen::Vector3d(1.1, 1.0, 1.0)});
  const JointVector moments = Eigen::Vector3d(1.0, 1.0, 1.0);
  Kinematics at;
  model->kinematics(Eigen::Vector3d::Zero(), Eigen::Vector3d(0.5, 0.2, 1.0), at);
  BaseForces p, more, unused;
  leg_bases(model, moments, *model)->momentum(at, JointVector::Zero(3), p, unused);
  leg_bases(heavier, moments, *model)->momentum(at, JointVector::Zero(3), more, unused);
  EXPECT_LT((more.head<2>() - 1.1 * p.head<2>()).norm(), 1e-12);
  EXPECT_LT((more.tail<4>() - p.tail<4>()).norm(), 1e-14);
}

TEST(LegBases, AreRefusedWhereNobodyKnowsThem) {
  const auto model = rig();
  const auto spatial =
      std::make_shared<const Hexapod>(hexapod_robot(HexapodPayload::none, HexapodFriction::none));
  const JointVector three = JointVector::Constant(3, 1.0);
  EXPECT_THROW(leg_bases(spatial, three, *spatial), SetupError);
  EXPECT_THROW(leg_bases(model, JointVector::Constant(2, 1.0), *model), SetupError);
  EXPECT_THROW(leg_bases(model, JointVector::Constant(3, -1.0), *model), SetupError);
}

}  // namespace
}  // namespace flinch
