#include "drivers/amplifier_station.h"

#include <gtest/gtest.h>

#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch {
namespace {

using enum DriveState;

constexpr RequestedDriveState operation{.state = RequestedDriveState::State::operation_enabled,
                                        .engage_brake = false};

/// Three amplifiers that answer at once, and a bus that commands 1, 2, 3 Nm without brakes.
class CommandedAmplifiers {
 public:
  CommandedAmplifiers() : diagram_(build()), context_(diagram_->make_context()) {
    status_.reading = {.valid = true, .enabled = true, .braked = false, .fault = false};
    status_.source = 1;
  }

  void tick(const RequestedDriveState& wish) {
    Statuswords told{.count = answer ? std::uint8_t{3} : std::uint8_t{0}};
    for (std::size_t i = 0; i < 3; ++i) told.bits[i] = statusword_of(drives[i].state);
    status_.reading.acquired = context_.time();
    ++status_.number;
    context_.set(station_.statuswords, told);
    context_.set(fieldbus_.arriving_status, status_);
    context_.set(station_.wish, wish);
    context_.set(station_.torque_command,
                 {.computed = context_.time(), .valid = true, .torque = Eigen::Vector3d(1, 2, 3)});
    context_.set(station_.brake, {.engage = false});
    diagram_->evaluate(context_);
    for (std::size_t i = 0; i < 3; ++i) {
      const DriveCondition condition{.started = true, .fault = broken[i], .standstill = true};
      drives[i] = DriveStateMachine::next(drives[i], context_.get(station_.controlword), condition);
    }
    torque = context_.get(fieldbus_.torque_command);
    brake = context_.get(fieldbus_.brake);
    told_status = context_.get(station_.status);
    told_state = context_.get(station_.statusword).state();
    diagram_->update(context_);
    context_.set_time(context_.time() + 1ms);
  }

  bool moves() const { return torque.valid && !brake.engage; }
  bool is_held() const { return !torque.valid && brake.engage; }

  std::array<DriveStateMachine::Memory, 3> drives;
  std::array<bool, 3> broken{};
  bool answer = true;

  TorqueCommand torque;  // what reaches the fieldbus
  BrakeCommand brake;
  StationStatus told_status;  // what the bus hears
  DriveState told_state{};

 private:
  std::unique_ptr<Diagram> build() {
    DiagramBuilder builder;
    const auto robot = std::make_shared<PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::none));
    fieldbus_ = add_external_station(builder, robot);
    station_ = add_amplifier_station(builder, fieldbus_);
    return builder.build();
  }

  Arrival<StationStatus> status_;
  ExternalStation fieldbus_;
  AmplifierStation station_;
  std::unique_ptr<Diagram> diagram_;
  Context context_;
};

CommandedAmplifiers enabled_amplifiers() {
  CommandedAmplifiers amplifiers;
  for (auto& drive : amplifiers.drives) drive.state = operation_enabled;
  amplifiers.tick(operation);
  return amplifiers;
}

TEST(AmplifierStation, PassesTorqueInOperationOnly) {
  CommandedAmplifiers amplifiers;
  for (int i = 0; i < 10; ++i) {
    amplifiers.tick(operation);
    const bool enabled = amplifiers.told_state == operation_enabled;
    EXPECT_EQ(enabled, i >= 4);
    EXPECT_EQ(amplifiers.told_status.enabled, enabled);
    EXPECT_TRUE(enabled ? amplifiers.moves() : amplifiers.is_held());
  }
  EXPECT_EQ(amplifiers.torque.torque, Eigen::Vector3d(1, 2, 3));
}

TEST(AmplifierStation, HoldsAllWhereOneIsNotInOperation) {
  for (std::size_t one = 0; one < 3; ++one) {
    for (int state = 0; state < drive_state_count; ++state) {
      CommandedAmplifiers amplifiers = enabled_amplifiers();
      ASSERT_TRUE(amplifiers.moves());
      amplifiers.drives[one].state = static_cast<DriveState>(state);
      amplifiers.tick(operation);
      EXPECT_EQ(amplifiers.moves(), static_cast<DriveState>(state) == operation_enabled);
      EXPECT_EQ(amplifiers.is_held(), !amplifiers.moves());
    }
  }
}

TEST(AmplifierStation, ReportsTheFaultOfOneAndNeedsAResetBeforeItMovesAgain) {
  CommandedAmplifiers amplifiers = enabled_amplifiers();
  amplifiers.broken[1] = true;
  amplifiers.tick(operation);
  amplifiers.broken[1] = false;
  for (int i = 0; i < 10; ++i) {
    amplifiers.tick(operation);
    EXPECT_TRUE(amplifiers.told_status.fault);
    EXPECT_TRUE(amplifiers.is_held());
  }
  RequestedDriveState reset = operation;
  reset.fault_resets = 1;
  for (int i = 0; i < 6; ++i) amplifiers.tick(reset);
  EXPECT_FALSE(amplifiers.told_status.fault);
  EXPECT_TRUE(amplifiers.moves());
}

TEST(AmplifierStation, IsHeldFromTheTickOnAtWhichTheAmplifiersDoNotAnswer) {
  CommandedAmplifiers amplifiers = enabled_amplifiers();
  amplifiers.answer = false;
  amplifiers.tick(operation);
  EXPECT_TRUE(amplifiers.is_held());
  EXPECT_FALSE(amplifiers.told_status.enabled);
  EXPECT_EQ(amplifiers.told_state, not_ready_to_switch_on);
}

TEST(AmplifierStation, HasNoTorqueFromTheTickOnAtWhichAQuickStopIsUnderWay) {
  CommandedAmplifiers amplifiers = enabled_amplifiers();
  amplifiers.tick({.state = RequestedDriveState::State::quick_stop});
  amplifiers.tick({.state = RequestedDriveState::State::quick_stop});
  EXPECT_EQ(amplifiers.told_state, quick_stop_active);
  EXPECT_TRUE(amplifiers.is_held());
}

}  // namespace
}  // namespace flinch
