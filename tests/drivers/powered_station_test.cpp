#include "drivers/powered_station.h"

#include <gtest/gtest.h>

#include <vector>

#include "diagrams/external_station.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch {
namespace {

using enum DriveState;

constexpr RequestedDriveState operation{.state = RequestedDriveState::State::operation_enabled,
                                        .engage_brake = false};
constexpr RequestedDriveState quick_stop{.state = RequestedDriveState::State::quick_stop,
                                         .engage_brake = false};

/// A powered station whose bare one says what the test wants, commanded 1, 2, 3 Nm without brakes.
class PoweredRig {
 public:
  PoweredRig() : diagram_(build()), context_(diagram_->make_context()) {}

  /// One tick; returns the state that the drives tell in it.
  DriveState tick(const RequestedDriveState& wish) {
    const Time now = context_.time();
    ++number_;
    angle_ += speed * 1e-3;
    if (status.valid) {
      status.acquired = now;
      context_.set(bare_.arriving_status, {.reading = status, .source = 1, .number = number_});
    }
    const JointReading joints{.acquired = now,
                              .valid = true,
                              .passive_valid = false,
                              .active = JointVector::Constant(3, angle_),
                              .passive = JointVector()};
    context_.set(bare_.arriving_joints, {.reading = joints, .source = 1, .number = number_});
    context_.set(wish_, wish);
    context_.set(torque_, {.computed = now, .valid = true, .torque = Eigen::Vector3d(1, 2, 3)});
    context_.set(brake_, {.engage = false});
    diagram_->evaluate(context_);
    moves = context_.get(bare_.torque_command).valid && !context_.get(bare_.brake).engage;
    is_held = !context_.get(bare_.torque_command).valid && context_.get(bare_.brake).engage;
    told = context_.get(station_.status);
    const DriveState state = context_.get(station_.statusword).state();
    diagram_->update(context_);
    context_.set_time(now + 1ms);
    return state;
  }

  std::vector<DriveState> tick(const RequestedDriveState& wish, int ticks) {
    std::vector<DriveState> states;
    for (int i = 0; i < ticks; ++i) states.push_back(tick(wish));
    return states;
  }

  StationStatus status{.acquired = {}, .valid = true, .enabled = true, .braked = false, .fault = false};
  double speed = 0.0;  // of the drives [rad/s]

  bool moves = false;  // what reaches the bare station
  bool is_held = false;
  StationStatus told;

 private:
  std::unique_ptr<Diagram> build() {
    DiagramBuilder builder;
    const auto robot = std::make_shared<PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::none));
    bare_ = add_external_station(builder, robot);
    station_ = add_powered_station(builder, bare_);
    wish_ = builder.export_input("wish", station_.wish);
    torque_ = builder.export_input("torque_command", station_.torque_command);
    brake_ = builder.export_input("brake", station_.brake);
    return builder.build();
  }

  double angle_ = 0.0;
  std::uint32_t number_ = 0;
  ExternalStation bare_;
  PoweredStation station_;
  InputPort<RequestedDriveState> wish_;
  InputPort<TorqueCommand> torque_;
  InputPort<BrakeCommand> brake_;
  std::unique_ptr<Diagram> diagram_;
  Context context_;
};

TEST(PoweredStation, IsSwitchedOnStepByStepAndPassesTorqueInOperationOnly) {
  PoweredRig rig;
  const DriveState expected[] = {not_ready_to_switch_on, switch_on_disabled, ready_to_switch_on, switched_on,
                                 operation_enabled,      operation_enabled};
  for (const DriveState state : expected) {
    EXPECT_EQ(rig.tick(operation), state);
    EXPECT_EQ(rig.moves, state == operation_enabled);
    EXPECT_EQ(rig.is_held, state != operation_enabled);
    EXPECT_EQ(rig.told.enabled, state == operation_enabled);
  }
}

TEST(PoweredStation, StaysWithoutVoltageWhereNobodyWishesAnything) {
  PoweredRig rig;
  for (const DriveState state : rig.tick(RequestedDriveState(), 20)) {
    EXPECT_TRUE(state == not_ready_to_switch_on || state == switch_on_disabled);
  }
  EXPECT_TRUE(rig.is_held);
}

TEST(PoweredStation, IsNotReadyBeforeItsStationSaysAnything) {
  PoweredRig rig;
  rig.status.valid = false;
  for (const DriveState state : rig.tick(operation, 20)) EXPECT_EQ(state, not_ready_to_switch_on);
}

TEST(PoweredStation, DropsOutOfOperationAtAFaultAndIsResetByANewRequestOnly) {
  PoweredRig rig;
  rig.tick(operation, 10);
  ASSERT_TRUE(rig.moves);
  rig.status.fault = true;
  rig.tick(operation, 2);
  EXPECT_TRUE(rig.is_held);
  EXPECT_TRUE(rig.told.fault);

  RequestedDriveState reset = operation;
  reset.fault_resets = 1;  // while the fault is still there
  EXPECT_EQ(rig.tick(reset, 10).back(), fault);
  rig.status.fault = false;
  EXPECT_EQ(rig.tick(reset, 10).back(), fault);  // the same request does not count twice
  EXPECT_TRUE(rig.told.fault);
  reset.fault_resets = 2;
  EXPECT_EQ(rig.tick(reset, 10).back(), operation_enabled);
  EXPECT_TRUE(rig.moves);
  EXPECT_FALSE(rig.told.fault);
}

TEST(PoweredStation, ReactsToAFaultUntilItStandsStill) {
  PoweredRig rig;
  rig.tick(operation, 10);
  rig.status.fault = true;
  rig.speed = 1.0;
  EXPECT_EQ(rig.tick(operation, 20).back(), fault_reaction_active);
  EXPECT_TRUE(rig.is_held);
  rig.speed = 0.0;
  EXPECT_EQ(rig.tick(operation, 3).back(), fault);
}

TEST(PoweredStation, LosesTorqueWithAQuickStopAndItsVoltageAtStandstill) {
  PoweredRig rig;
  rig.tick(operation, 10);
  rig.speed = 1.0;
  rig.tick(quick_stop);
  for (const DriveState state : rig.tick(quick_stop, 20)) EXPECT_EQ(state, quick_stop_active);
  EXPECT_TRUE(rig.is_held);
  rig.speed = 0.0;
  EXPECT_EQ(rig.tick(quick_stop, 3).back(), switch_on_disabled);
}

TEST(PoweredStation, IsBrakedWithinTwoTicksWhereTheWishFallsBackToNothing) {
  PoweredRig rig;
  rig.tick(operation, 10);
  ASSERT_TRUE(rig.moves);
  rig.tick(RequestedDriveState(), 2);  // as DdsServer wishes when who commands falls silent
  EXPECT_TRUE(rig.is_held);
  EXPECT_EQ(rig.tick(RequestedDriveState()), switch_on_disabled);
}

}  // namespace
}  // namespace flinch
