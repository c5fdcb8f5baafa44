#include "plant/simulated_drives.h"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/foundation/setup_error.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "tests/plant/rig_scene.h"
#include "tests/plant/sensor_rig.h"

namespace flinch {
namespace {

const Eigen::Vector3d constants(6.021, 6.6116, 6.7315);

SimulatedDrivesSettings rig_constants() { return {.torque_constant = constants}; }

/// Drives whose commands the test sets; what they do after a tick is seen at the next one.
class Drives {
 public:
  explicit Drives(const SimulatedDrivesSettings& settings = rig_constants(), Time tick = 1ms)
      : builder_("test", tick), ticking_(wire(settings, tick)) {
    ticking_.set(truth_, test::truth_at_rest());
    ticking_.set(brake_, {.engage = false});
  }

  Time now() const { return ticking_.now(); }
  TorqueCommand fresh(double first, double second, double third) const {
    return {.computed = now(), .valid = true, .torque = Eigen::Vector3d(first, second, third)};
  }
  void brake(bool engage) { ticking_.set(brake_, {.engage = engage}); }
  void come_apart() { ticking_.set(truth_, PlantTruth()); }

  /// Obeys `command` for a tick and says what acted until the next one.
  DriveAction after(const TorqueCommand& command) {
    ticking_.set(command_, command);
    ticking_.tick();
    ticking_.set(command_, {});
    ticking_.tick();
    return ticking_.get(acting_);
  }
  /// Obeys `command` for a tick, and says what the command before it has done.
  DriveAction then(const TorqueCommand& command) {
    ticking_.set(command_, command);
    ticking_.tick();
    return ticking_.get(acting_);
  }
  const StationStatus& status() const { return ticking_.get(status_); }

 private:
  DiagramBuilder& wire(const SimulatedDrivesSettings& settings, Time tick) {
    auto& drives = builder_.add<SimulatedDrives>("drives", settings, *test::individual_rig(), tick);
    command_ = builder_.export_input("command", drives.torque_command);
    brake_ = builder_.export_input("brake", drives.brake);
    truth_ = builder_.export_input("truth", drives.truth);
    acting_ = drives.acting;
    status_ = drives.status;
    return builder_;
  }

  DiagramBuilder builder_;
  InputPort<TorqueCommand> command_;
  InputPort<BrakeCommand> brake_;
  InputPort<PlantTruth> truth_;
  OutputPort<DriveAction> acting_;
  OutputPort<StationStatus> status_;
  test::Ticking ticking_;
};

void expect_stopped(const DriveAction& action) {
  EXPECT_EQ(action.torque, Eigen::Vector3d::Zero());
  EXPECT_EQ(action.current, Eigen::Vector3d::Zero());
  EXPECT_TRUE(action.braked);
  EXPECT_FALSE(action.enabled);
}

TEST(SimulatedDrives, TurnCommandsIntoCurrentsAndTorques) {
  Drives drives;
  const DriveAction action = drives.after(drives.fresh(6.021, -13.2232, 0.0));
  EXPECT_TRUE(action.torque.isApprox(Eigen::Vector3d(6.021, -13.2232, 0.0)));
  EXPECT_TRUE(action.current.isApprox(Eigen::Vector3d(1.0, -2.0, 0.0)));
  EXPECT_TRUE(action.enabled);
  EXPECT_FALSE(action.braked);
  EXPECT_TRUE(drives.status().enabled);
  EXPECT_FALSE(drives.status().braked);
}

TEST(SimulatedDrives, MakeAnotherTorqueWhereTheDriverIsWrongAboutTheConstant) {
  Drives drives({.torque_constant = constants, .driver_torque_constant = Eigen::Vector3d::Constant(6.1)});
  const DriveAction action = drives.after(drives.fresh(6.1, 6.1, 6.1));
  EXPECT_TRUE(action.current.isApprox(Eigen::Vector3d::Ones()));
  EXPECT_TRUE(action.torque.isApprox(Eigen::Vector3d(6.021, 6.6116, 6.7315)));
}

// Against i' = (i_wanted - i) / lag in small steps: the torque is the mean of a tick, the current that of its
// end, and no tick begins anew.
TEST(SimulatedDrives, FollowTheirCommandsWithTheLagOfTheCurrent) {
  const Eigen::Vector3d lag(0.16e-3, 0.5e-3, 3e-3);
  Drives drives({.torque_constant = constants, .current_lag = lag});
  Eigen::Vector3d current = Eigen::Vector3d::Zero();
  Eigen::Vector3d wanted(1.0, 2.0, 3.0);
  const auto command = [&] {
    const Eigen::Vector3d torque = constants.cwiseProduct(wanted);
    return drives.fresh(torque[0], torque[1], torque[2]);
  };
  drives.then(command());
  for (const double factor : {-2.0, 0.1, 3.0}) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    constexpr int steps = 200000;
    for (int step = 0; step < steps; ++step) {
      const Eigen::Vector3d rate = (wanted - current).cwiseQuotient(lag) * (1e-3 / steps);
      sum += current + 0.5 * rate;
      current += rate;
    }
    wanted *= factor;
    const DriveAction action = drives.then(command());
    EXPECT_LT((action.current - current).norm(), 1e-4);
    EXPECT_LT((action.torque - constants.cwiseProduct(sum / steps)).norm(), 1e-3);
  }
  expect_stopped(drives.after(TorqueCommand()));
}

TEST(SimulatedDrives, MakeTorquesThatAreBehindTheirCurrents) {
  const Eigen::Vector3d delay(0.25e-3, -0.5e-3, 0.0);
  Drives drives({.torque_constant = constants, .torque_delay = delay});
  const auto command = [&](double amperes) {
    const Eigen::Vector3d torque = amperes * constants;
    return drives.fresh(torque[0], torque[1], torque[2]);
  };
  drives.then(command(1.0));
  drives.then(command(3.0));
  const DriveAction action = drives.then(command(3.0));
  EXPECT_TRUE(action.current.isApprox(Eigen::Vector3d::Constant(3.0)));
  EXPECT_TRUE(action.torque.cwiseQuotient(constants).isApprox(Eigen::Vector3d(2.5, 4.0, 3.0)))
      << action.torque.cwiseQuotient(constants).transpose();
}

// What the mapping makes of the currents is what acts, where it knows the delay that a lag makes.
TEST(SimulatedDrives, WithALagAreBehindByAShareOfTheStep) {
  constexpr double ticks = 0.3;  // of the lag
  const double left = std::exp(-1.0 / ticks);
  const double share = 1.0 - 1.0 / (1.0 - left) + ticks;
  Drives drives({.torque_constant = constants, .current_lag = Eigen::Vector3d::Constant(ticks * 1e-3)});
  DriveAction before = drives.then(drives.fresh(0.0, 0.0, 0.0));
  for (const double torque : {10.0, -4.0, 3.0, 3.0}) {
    const DriveAction action = drives.then(drives.fresh(torque, torque, torque));
    const Eigen::Vector3d acts = action.current - share * (action.current - before.current);
    EXPECT_TRUE(action.torque.isApprox(constants.cwiseProduct(acts), 1e-12));
    before = action;
  }
}

TEST(SimulatedDrives, WithoutLagObeyAtOnce) {
  Drives drives({.torque_constant = constants, .current_lag = Eigen::Vector3d::Zero()});
  const DriveAction action = drives.after(drives.fresh(6.021, -13.2232, 0.0));
  EXPECT_EQ(action.torque, Eigen::Vector3d(6.021, -13.2232, 0.0));
  EXPECT_TRUE(action.current.isApprox(Eigen::Vector3d(1.0, -2.0, 0.0)));
}

SimulatedDrivesSettings with_fault(RequestedFault fault) {
  SimulatedDrivesSettings settings = rig_constants();
  settings.faults = {fault};
  return settings;
}

TEST(SimulatedDrives, CanMakeAnotherTorqueOfACurrentThatIsAsItShouldBe) {
  Drives drives(
      with_fault({.signal = FaultSignal::drive, .index = 1, .kind = FaultKind::scaled, .size = 0.0}));
  const DriveAction action = drives.after(drives.fresh(6.021, 6.6116, 6.7315));
  EXPECT_TRUE(action.current.isApprox(Eigen::Vector3d::Ones()));
  EXPECT_TRUE(action.torque.isApprox(Eigen::Vector3d(6.021, 0.0, 6.7315)));
}

TEST(SimulatedDrives, HaveBrakesThatDoNotHoldOrDoNotOpen) {
  Drives loose(with_fault({.signal = FaultSignal::brake, .index = 0, .kind = FaultKind::off}));
  DriveAction action = loose.after(TorqueCommand());
  EXPECT_TRUE(action.braked);
  EXPECT_EQ(action.hold, Eigen::Vector3d(0.0, 1.0, 1.0));

  Drives shut(with_fault({.signal = FaultSignal::brake, .index = 0, .kind = FaultKind::stuck}));
  action = shut.after(shut.fresh(1.0, 1.0, 1.0));
  EXPECT_FALSE(action.braked);
  EXPECT_EQ(action.hold, Eigen::Vector3d(1.0, 0.0, 0.0));
}

TEST(SimulatedDrives, HaveBrakesThatTakeTheirTime) {
  Drives drives(with_fault({.signal = FaultSignal::brake, .kind = FaultKind::delayed, .size = 0.003}));
  for (int tick = 0; tick < 3; ++tick) drives.then(drives.fresh(1.0, 1.0, 1.0));
  drives.brake(true);
  drives.then(drives.fresh(1.0, 1.0, 1.0));
  for (int tick = 0; tick < 5; ++tick) {
    const DriveAction action = drives.then(drives.fresh(1.0, 1.0, 1.0));
    EXPECT_TRUE(action.braked);
    EXPECT_EQ(action.hold[0], tick < 3 ? 0.0 : 1.0) << tick;
  }
}

TEST(SimulatedDrives, CutCommandsToTheirLimit) {
  Drives drives({.max_torque = Eigen::Vector3d::Constant(50.0)});
  const DriveAction action = drives.after(drives.fresh(80.0, -1e9, 20.0));
  EXPECT_TRUE(action.torque.isApprox(Eigen::Vector3d(50.0, -50.0, 20.0)));
}

TEST(SimulatedDrives, BrakeUntilTheFirstCommandAndWithoutOne) {
  Drives drives;
  expect_stopped(drives.after(TorqueCommand()));
  EXPECT_TRUE(drives.status().valid);
  EXPECT_TRUE(drives.status().braked);
  EXPECT_TRUE(drives.status().enabled) << "they would obey";
}

TEST(SimulatedDrives, BrakeOnStaleCommandsAndObeyAgainOnFreshOnes) {
  Drives drives;
  for (int k = 0; k < 10; ++k) drives.after(TorqueCommand());
  TorqueCommand command = drives.fresh(1.0, 2.0, 3.0);
  command.computed = drives.now() - 3ms;
  EXPECT_TRUE(drives.after(command).enabled) << "just not too old";
  command.computed = drives.now() - 3ms - Time(1);
  expect_stopped(drives.after(command));
  command.computed = drives.now() + 1ms;
  expect_stopped(drives.after(command));
  EXPECT_TRUE(drives.after(drives.fresh(1.0, 2.0, 3.0)).enabled);
}

TEST(SimulatedDrives, BrakeOnUnusableCommands) {
  Drives drives;
  TorqueCommand invalid = drives.fresh(1.0, 2.0, 3.0);
  invalid.valid = false;
  expect_stopped(drives.after(invalid));
  expect_stopped(drives.after(drives.fresh(1.0, std::nan(""), 3.0)));
  expect_stopped(drives.after(drives.fresh(1.0, 2.0, HUGE_VAL)));
  TorqueCommand short_one = drives.fresh(1.0, 2.0, 3.0);
  short_one.torque = JointVector::Ones(2);
  expect_stopped(drives.after(short_one));
}

TEST(SimulatedDrives, GiveNoTorqueWhileBraking) {
  Drives drives;
  drives.brake(true);
  expect_stopped(drives.after(drives.fresh(1.0, 2.0, 3.0)));
  drives.brake(false);
  EXPECT_TRUE(drives.after(drives.fresh(1.0, 2.0, 3.0)).enabled);
}

TEST(SimulatedDrives, AreDisabledByAFaultWhenTheRobotCameApart) {
  Drives drives;
  drives.after(TorqueCommand());
  EXPECT_FALSE(drives.status().fault);
  drives.come_apart();
  drives.after(TorqueCommand());
  EXPECT_TRUE(drives.status().fault);
  EXPECT_FALSE(drives.status().enabled);
}

TEST(SimulatedDrives, HaveConstantsAndLimitsOfTheirKindUnlessTold) {
  const SimulatedDrivesSettings turning = complete({}, *test::individual_rig());
  const SimulatedDrivesSettings sliding = complete({}, Hexapod(hexapod_robot()));
  EXPECT_EQ(turning.torque_constant, JointVector::Constant(3, 6.1));
  EXPECT_EQ(turning.max_torque, JointVector::Constant(3, 100.0));
  EXPECT_EQ(sliding.torque_constant, JointVector::Constant(6, 100.0));
  EXPECT_EQ(sliding.driver_torque_constant, sliding.torque_constant);
  EXPECT_EQ(sliding.max_torque, JointVector::Constant(6, 500.0));
}

TEST(SimulatedDrives, RefuseConstantsAndLimitsThatAreNotPositive) {
  SimulatedDrivesSettings settings = rig_constants();
  settings.torque_constant[1] = 0.0;
  settings.max_torque = Eigen::Vector3d(100.0, -1.0, 100.0);
  const auto robot = test::individual_rig();
  EXPECT_EQ(problems(settings, *robot).size(), 2U);
  EXPECT_THROW(SimulatedDrives(settings, *robot), SetupError);
  EXPECT_EQ(problems({.torque_constant = JointVector::Ones(2)}, *robot).size(), 1U);
}

/// Of a command that rises evenly: the mean over a tick of what the current was a delay ago.
TEST(SimulatedDrives, DelayTheirTorquesByMoreThanATickWhereTicksAreShort) {
  constexpr double T = 0.25e-3;
  const Eigen::Vector3d delay(0.6e-3, 1e-3, 0.1e-3);
  Drives drives({.torque_constant = constants, .torque_delay = delay}, 250us);
  for (int k = 1; k <= 12; ++k) {
    const Eigen::Vector3d torque = static_cast<double>(k) * constants;
    const DriveAction action = drives.then(drives.fresh(torque[0], torque[1], torque[2]));
    if (k <= 5) continue;
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(action.torque[i] / constants[i], k - 1 - delay[i] / T, 1e-9) << k << ", drive " << i;
  }
}

}  // namespace
}  // namespace flinch
