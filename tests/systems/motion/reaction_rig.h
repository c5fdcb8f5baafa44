#pragma once

#include <optional>

#include "systems/framework/diagram_builder.h"
#include "systems/motion/reaction_task.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch::test {

/// A ReactionTask, and what it is told.
struct Reaction {
  explicit Reaction(const ReactionTaskSettings& settings = {}, const PoseGoalSettings& held = {})
      : block(builder.add<ReactionTask>("reaction", robot, settings, held)) {}

  /// What the robot knows at the next tick. `touched`: a number in `classes`; -1: nobody knows.
  void know(int touched, const Eigen::Vector3d& wrench, const Eigen::Vector3d& pose = {0.02, 0.01, 0.05},
            const Eigen::Vector3d& velocity = {0, 0, 0}) {
    posture.emplace(*robot, pose, velocity);
    ticking.set(kinematics, posture->kinematics);
    ticking.set(dynamics, posture->dynamics);
    WrenchEstimate felt;
    felt.valid = true;
    felt.wrench_in_base = wrench;
    felt.drive_torque = posture->kinematics.J_x_qa.transpose() * wrench;
    ticking.set(estimate, felt);
    ContactClassification told;
    told.valid = told.accepted = touched >= 0;
    told.most_likely = touched;
    ticking.set(classification, told);
    ticking.set(location, place);
  }
  const TaskList& begin() {
    ticking.set(reaction, ReactionState{ReactionMode::react, ReactionMode::nominal, ticking.now()});
    ticking.tick();
    return ticking.get(block.goals);
  }
  const TaskList& go_on(Time for_time = 1ms) {
    for (Time t{}; t < for_time; t += 1ms) ticking.tick();
    return ticking.get(block.goals);
  }
  /// Goes on until the motion is over and says where it leads: as it would be followed if the mode were
  /// another, in which nothing is decided.
  TaskGoal goal() {
    Ticking followed = ticking;
    for (Time t{}; t < 10s && ticking.get(block.goals).count == 1; t += 1ms) {
      followed = ticking;
      ticking.tick();
    }
    followed.set(reaction, ReactionState{ReactionMode::nominal, ReactionMode::hold, followed.now()});
    followed.tick();
    followed.tick();
    return followed.get(block.goals).goals[0];
  }
  bool holds_a_place() const { return ticking.get(block.goals).count == 2; }
  /// Of the place that is held, from where the robot is: position, then orientation.
  Eigen::Vector3d way_back() const {
    const TaskList& list = ticking.get(block.goals);
    Eigen::Vector3d way;
    way << list.goals[0].reference.error, list.goals[1].reference.error;
    return way;
  }
  bool finished() const { return ticking.get(block.reference).finished; }

  std::shared_ptr<const PlanarRrr> robot = planar_rig();
  ContactClasses classes{7, 3};
  ContactLocation place;
  std::optional<Posture> posture;
  DiagramBuilder builder{"test", 1ms};
  ReactionTask& block;
  InputPort<ReactionState> reaction = builder.export_input("reaction", block.reaction);
  InputPort<Kinematics> kinematics = builder.export_input("kinematics", block.kinematics);
  InputPort<Dynamics> dynamics = builder.export_input("dynamics", block.dynamics);
  InputPort<WrenchEstimate> estimate = builder.export_input("estimate", block.estimate);
  InputPort<ContactClassification> classification =
      builder.export_input("classification", block.classification);
  InputPort<ContactLocation> location = builder.export_input("location", block.location);
  Ticking ticking{builder};
};

inline constexpr int platform = 0;
inline constexpr int leg2_link1 = 3;
inline constexpr int leg2_link2 = 4;
inline constexpr int leg2_clamping = 8;
inline const Eigen::Vector3d pushing_apart(-20, -5, 0);  // the links of the second leg

}  // namespace flinch::test
