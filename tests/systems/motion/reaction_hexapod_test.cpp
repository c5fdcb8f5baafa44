// How a robot whose drives slide gives way to what touches its legs.
#include <gtest/gtest.h>

#include <cmath>

#include "systems/framework/diagram_builder.h"
#include "systems/motion/reaction_task.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "systems/robot/link_segments.h"
#include "tests/support/ticking.h"

namespace flinch::test {
namespace {

/// A hexapod at home that something touches at a share of the first link of a leg.
class TouchedHexapod {
 public:
  /// `wrench` follows from the force by virtual work.
  TouchedHexapod(int leg, double fraction, const Eigen::Vector3d& force, bool is_placed) : leg_(leg) {
    robot_->kinematics(robot_->home_pose(), PlatformVector::Zero(6), at_);
    robot_->dynamics(at_, model_);
    const BodyId cylinder = BodyId::link1(leg);
    point_ = robot_->axis_point(cylinder, fraction);
    const ContactJacobian contact = robot_->contact_jacobian(at_, cylinder, point_);
    WrenchEstimate felt;
    felt.valid = true;
    felt.wrench_in_base = contact.translation.transpose() * force;
    felt.drive_torque = at_.J_x_qa.transpose() * felt.wrench_in_base;
    ContactClassification told;
    told.valid = told.accepted = true;
    told.most_likely = cylinder.index();
    ContactLocation place;
    place.valid = is_placed;
    place.body = cylinder.index();
    place.fraction = fraction;
    place.force_in_base = force;
    ticking_.set(kinematics_, at_);
    ticking_.set(dynamics_, model_);
    ticking_.set(estimate_, felt);
    ticking_.set(classification_, told);
    ticking_.set(location_, place);
    ticking_.set(reaction_, ReactionState{ReactionMode::react, ReactionMode::nominal, ticking_.now()});
    ticking_.tick();
  }

  FollowedTask followed() { return ticking_.get(block_.followed_task); }

  /// Where the task leads in the end: the least motion of the platform that has its displacement.
  PlatformVector way() {
    PlatformVector error;
    Task task;
    for (Time t{}; t < 2s && ticking_.get(block_.goals).count == 1; t += 1ms) {
      const TaskGoal& goal = ticking_.get(block_.goals).goals[0];
      if (error.size() == 0 || goal.reference.error.norm() >= error.norm()) {
        error = goal.reference.error;
        task = goal.task;
      }
      ticking_.tick();
    }
    const PlatformMatrix square = task.J * task.J.transpose();
    return task.J.transpose() * square.ldlt().solve(error);
  }

  /// By how much the leg lengthens, and how the touched point moves, to first order.
  double lengthening(const PlatformVector& way) const { return at_.J_qa_x.row(leg_).dot(way); }
  Eigen::Vector3d touched_point(const PlatformVector& way) const {
    return robot_->contact_jacobian(at_, BodyId::link1(leg_), point_).translation * way;
  }
  double leg_length() const { return at_.joints.active[leg_]; }
  Eigen::Vector3d axis() const {
    const Segment link = link_segment(at_, BodyId::link1(leg_));
    return (link.end - link.begin).normalized();
  }

 private:
  int leg_;
  std::shared_ptr<const Hexapod> robot_ = std::make_shared<const Hexapod>(hexapod_robot());
  Kinematics at_;
  Dynamics model_;
  CartesianVector point_;
  DiagramBuilder builder_{"test", 1ms};
  ReactionTask& block_ = builder_.add<ReactionTask>("reaction", robot_, ReactionTaskSettings());
  InputPort<ReactionState> reaction_ = builder_.export_input("reaction", block_.reaction);
  InputPort<Kinematics> kinematics_ = builder_.export_input("kinematics", block_.kinematics);
  InputPort<Dynamics> dynamics_ = builder_.export_input("dynamics", block_.dynamics);
  InputPort<WrenchEstimate> estimate_ = builder_.export_input("estimate", block_.estimate);
  InputPort<ContactClassification> classification_ =
      builder_.export_input("classification", block_.classification);
  InputPort<ContactLocation> location_ = builder_.export_input("location", block_.location);
  Ticking ticking_{builder_};
};

TEST(ReactionOfAHexapod, LeadsATouchedFirstLinkAwayAndLeavesItsLegAsLongAsItIs) {
  for (int leg = 0; leg < 6; ++leg) {
    for (const double fraction : {0.2, 0.5, 0.9}) {
      for (const bool is_placed : {true, false}) {
        const Eigen::Vector3d force(60.0, -80.0, 30.0);
        TouchedHexapod robot(leg, fraction, force, is_placed);
        const PlatformVector way = robot.way();
        const Eigen::Vector3d axis = robot.axis();
        const Eigen::Vector3d across = (force - axis.dot(force) * axis).normalized();
        const Eigen::Vector3d moved = robot.touched_point(way);
        SCOPED_TRACE(testing::Message() << "leg " << leg << " at " << fraction << ", placed " << is_placed);
        EXPECT_EQ(robot.followed().kind, ReactionKind::second_link);
        EXPECT_EQ(robot.followed().leg, leg);
        EXPECT_NEAR(robot.lengthening(way), 0.0, 1e-9);
        EXPECT_NEAR(moved.normalized().dot(across), 1.0, is_placed ? 1e-9 : 0.05);
        const double share = fraction * 0.44 / robot.leg_length();  // of how far the end of the leg goes
        EXPECT_NEAR(moved.norm(), 0.1 * share, 1e-3);
      }
    }
  }
}

TEST(ReactionOfAHexapod, IsBrakedWhereTheForceActsAlongTheLegOnly) {
  const Eigen::Vector3d along = 80.0 * TouchedHexapod(1, 0.5, {60.0, 0.0, 0.0}, true).axis();
  EXPECT_EQ(TouchedHexapod(1, 0.5, along, true).followed().kind, ReactionKind::brake);
}

}  // namespace
}  // namespace flinch::test
