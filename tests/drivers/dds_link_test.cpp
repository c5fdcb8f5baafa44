#include <drivers/idl/flinch.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "drivers/sample_sender.h"
#include "tests/drivers/link_ends.h"
#include "tests/support/allocations.h"
#include "tests/support/free_domain.h"

namespace flinch {
namespace {

using test::FarEnd;
using test::FarThread;
using test::NearEnd;

/// Generous: nothing is learnt from a busy machine.
bool too_long(const NearEnd& near) { return near.time() > 30s; }

/// Whether the station's values are those of one instant of the far robot each.
void expect_true_values(const NearEnd& near) {
  const JointReading& joints = near.get(near.station().joints);
  if (joints.valid) {
    EXPECT_NEAR(joints.active[1], 2.0 * joints.active[0], 1e-12);
    EXPECT_NEAR(joints.active[2], 3.0 * joints.active[0], 1e-12);
    EXPECT_NEAR(joints.passive[2], 6.0 * joints.active[0], 1e-12);
    EXPECT_LE(joints.acquired, near.time());
  }
  const ImuReading& imu = near.get(near.station().imu);
  EXPECT_TRUE(!imu.valid || imu.specific_force[2] == 9.81);
  const DriveReading& drives = near.get(near.station().drives);
  if (drives.valid) {
    EXPECT_NEAR(drives.current[1], 2.0 * drives.current[0], 1e-12);
  }
}

TEST(DdsLink, BringsReadingsOneWayAndTorquesTheOther) {
  const DdsBus bus({.domain = test::free_domain()});
  FarEnd far(bus);
  NearEnd near(bus);
  const FarThread running(far);
  int obeyed = 0;
  near.run([&] {
    expect_true_values(near);
    const DriveReading& drives = near.get(near.station().drives);
    const bool own_torque_is_back = drives.valid && drives.current[0] > 0.0;
    if (own_torque_is_back && !near.get(near.station().status).braked) ++obeyed;
    return obeyed == 500 || too_long(near);
  });
  EXPECT_EQ(obeyed, 500);
  EXPECT_TRUE(near.dds().link().commands_obeyed);
  EXPECT_EQ(near.dds().link().other_description, 0u);
  EXPECT_EQ(near.dds().link().other_robot, 0u);
  EXPECT_EQ(near.dds().link().robot_id, far.server().robot_id());
  EXPECT_EQ(near.dds().link().other_version, 0u);
}

TEST(DdsLink, KeepsTheSpacingOfTheReadingsWhateverTheJitterOfArrival) {
  const DdsBus bus({.domain = test::free_domain()});
  FarEnd far(bus);
  NearEnd near(bus);
  const FarThread running(far);
  std::vector<double> errors;  // of the slope of the angle t, over one tick [s]
  JointReading last;
  near.run([&] {
    const JointReading& joints = near.get(near.station().joints);
    if (joints.valid && last.valid && near.time() > 500ms && joints.active[0] != last.active[0]) {
      errors.push_back(to_seconds(joints.acquired - last.acquired) - (joints.active[0] - last.active[0]));
    }
    last = joints;
    return errors.size() == 1000 || too_long(near);
  });
  ASSERT_EQ(errors.size(), 1000u);
  for (double& error : errors) error = std::abs(error);
  std::sort(errors.begin(), errors.end());
  RecordProperty("median_spacing_error_ns", static_cast<int>(1e9 * errors[500]));
  RecordProperty("p99_spacing_error_ns", static_cast<int>(1e9 * errors[990]));
  EXPECT_LT(errors[500], 11e-6) << "after lost periods the clock catches up by a hundredth of a tick";
}

TEST(DdsLink, AsksTheHeapForNothingInTheLoop) {
  const DdsBus bus({.domain = test::free_domain()});
  FarEnd far(bus);
  NearEnd near(bus);
  std::int64_t most = 0;
  std::atomic<std::int64_t> far_most = 0;
  std::int64_t far_before = -1;
  const FarThread running(far, [&] {
    const std::int64_t now = test::allocations();
    if (far_before >= 0) far_most = std::max(far_most.load(), now - far_before);
    far_before = now;
  });
  std::int64_t before = -1;
  int ticks = 0;
  near.run([&] {
    const std::int64_t now = test::allocations();
    if (before >= 0) most = std::max(most, now - before);
    before = now;
    return ++ticks == 300;
  });
  EXPECT_EQ(most, 0);
  EXPECT_EQ(far_most, 0);
}

TEST(DdsLink, RefusesAControllerWithAnotherRobotDescription) {
  const DdsBus bus({.domain = test::free_domain()});
  FarEnd far(bus);
  NearEnd near(bus, test::link_robot + 1);
  bool brakes_held = true;
  {
    const FarThread running(far, [&] { brakes_held = brakes_held && far.brake(); });
    near.run([&] {
      EXPECT_FALSE(near.get(near.station().joints).valid);
      return near.dds().link().other_description > 100 || too_long(near);
    });
  }
  EXPECT_GT(near.dds().link().other_description, 100u);
  EXPECT_EQ(near.dds().link().received, 0u);
  EXPECT_TRUE(brakes_held);
  EXPECT_EQ(far.server().commander().received, 0u);
}

/// Sends torque commands as a program of another version, or one that would like to take over, might.
class Intruder {
 public:
  /// Names the robot `robot_id` in its commands.
  Intruder(const DdsBus& bus, std::uint64_t robot_id)
      : robot_id_(robot_id), writer_(bus, torque_command_topic) {}

  void send(std::uint16_t version, bool neutral) {
    flinch_TorqueSample sample{};
    sample.header.acquired_ns = MonotonicClock::now().count();
    sample.header.count = 3;
    sample.header.flags = neutral ? flag_engage_brake : flag_valid;
    std::fill_n(sample.torque, 3, torque);
    stamp(sample.header, {.session = session_, .robot = test::link_robot, .robot_id = robot_id_}, ++number_);
    sample.header.version = version;
    writer_.write(&sample);
  }

  static constexpr double torque = -77.0;

 private:
  std::uint64_t robot_id_;
  std::uint32_t session_ = draw_session();
  std::uint32_t number_ = 0;
  DdsWriter writer_;
};

TEST(DdsLink, RefusesASecondCommanderAndObeysTheFirst) {
  const DdsBus bus({.domain = test::free_domain()});
  FarEnd far(bus);
  NearEnd near(bus);
  Intruder intruder(bus, far.server().robot_id());
  std::atomic<bool> intruder_obeyed = false;
  std::atomic<int> obeyed_beside_intruder = 0;
  {
    const FarThread running(far, [&] {
      const TorqueCommand& torque = far.torque();
      if (torque.valid && torque.torque[0] == Intruder::torque) intruder_obeyed = true;
      if (torque.valid && torque.torque[0] > 0.0) ++obeyed_beside_intruder;
    });
    near.run([&] {
      if (near.dds().link().commands_obeyed) intruder.send(protocol_version, false);
      return obeyed_beside_intruder >= 300 || too_long(near);
    });
  }
  EXPECT_FALSE(intruder_obeyed);
  EXPECT_GE(obeyed_beside_intruder, 300);
  EXPECT_GT(far.server().commander().refused, 100u);
}

/// A far end whose drives must be switched on.
struct PoweredFarEnd {
  explicit PoweredFarEnd(const DdsBus& bus)
      : ticking(build()), server(bus, ticking.diagram(), station, {.robot = test::link_robot}) {}

  std::unique_ptr<Diagram> build() {
    DiagramBuilder builder("far");
    auto& robot = builder.add<test::FarRobot>("robot");
    const Station bare{.torque_command = robot.torque_command,
                       .brake = robot.brake,
                       .joints = robot.joints,
                       .drives = robot.drives,
                       .imu = robot.imu,
                       .status = robot.status,
                       .force_torque = std::nullopt};
    station = add_powered_station(builder, bare);
    station.torque_command = builder.export_input("torque_command", station.torque_command);
    station.brake = builder.export_input("brake", station.brake);
    station.wish = builder.export_input("wish", station.wish);
    return builder.build();
  }

  PoweredStation station;
  test::Ticking ticking;
  DdsServer server;
};

TEST(DdsLink, SwitchesTheDrivesOnAgainAfterASilenceOnlyWhenAskedAnew) {
  const DdsBus bus({.domain = test::free_domain()});
  PoweredFarEnd far(bus);
  NearEnd near(bus);
  std::atomic<bool> far_ends = false;
  std::thread serving([&] { far.ticking.run(far.server, [&] { return far_ends.load(); }); });
  const RequestedDriveState operation{.state = RequestedDriveState::State::operation_enabled,
                                      .engage_brake = false};
  const auto enabled = [&near] { return near.dds().link().drive_state == DriveState::operation_enabled; };

  near.dds().request(operation);
  near.run([&] { return enabled() || too_long(near); });
  EXPECT_TRUE(enabled());
  std::this_thread::sleep_for(50ms);  // the link is cut
  near.run([&] { return !enabled() || too_long(near); });
  EXPECT_FALSE(enabled());
  int ticks = 0;
  near.run([&] {
    EXPECT_FALSE(enabled());
    return ++ticks == 300;
  });
  EXPECT_TRUE(near.dds().link().commands_obeyed);
  near.dds().request(operation);
  near.run([&] { return enabled() || too_long(near); });
  EXPECT_TRUE(enabled());
  far_ends = true;
  serving.join();
}

TEST(DdsLink, TellsASecondControllerThatItsDrivesAreNotEnabled) {
  const DdsBus bus({.domain = test::free_domain()});
  FarEnd far(bus);
  NearEnd first(bus), second(bus);
  std::atomic<bool> first_obeyed = false, first_ends = false, first_ended = false;
  const FarThread running(far);
  std::thread commanding([&] {
    first.run([&] {
      first_obeyed = first_obeyed || first.dds().link().commands_obeyed;
      return first_ends || too_long(first);
    });
    first_ended = true;
  });
  while (!first_obeyed && !first_ended) std::this_thread::sleep_for(1ms);
  int enabled_for_the_other = 0;
  second.run([&] {
    const StationStatus& status = second.get(second.station().status);
    const DdsLink link = second.dds().link();
    if (link.enabled && !link.commands_obeyed) {
      ++enabled_for_the_other;
      EXPECT_FALSE(status.valid && status.enabled);
    }
    return enabled_for_the_other >= 100 || too_long(second);
  });
  first_ends = true;
  commanding.join();
  EXPECT_GE(enabled_for_the_other, 100);
}

TEST(DdsLink, ClosesTheBrakesOnRequestWhateverTheCommandsSay) {
  const DdsBus bus({.domain = test::free_domain()});
  FarEnd far(bus);
  NearEnd near(bus);
  std::atomic<bool> brake = true;
  const FarThread running(far, [&] { brake = far.brake(); });
  const auto run_until = [&](bool braked, RequestedDriveState wish) {
    int lasted = 0;
    near.dds().request(wish);
    near.run([&] {
      lasted = brake == braked ? lasted + 1 : 0;
      return lasted == 50 || too_long(near);
    });
    return lasted == 50;
  };
  const RequestedDriveState operate{.state = RequestedDriveState::State::operation_enabled,
                                    .engage_brake = false};
  const RequestedDriveState brakes{.state = RequestedDriveState::State::operation_enabled,
                                   .engage_brake = true};
  const RequestedDriveState stop{.state = RequestedDriveState::State::quick_stop, .engage_brake = false};
  EXPECT_TRUE(run_until(false, operate));
  EXPECT_TRUE(run_until(true, brakes));
  EXPECT_TRUE(run_until(false, operate));
  EXPECT_TRUE(run_until(true, stop));
}

TEST(DdsLink, RefusesCommandsOfAnotherProtocolVersion) {
  const DdsBus bus({.domain = test::free_domain()});
  FarEnd far(bus);
  Intruder other(bus, far.server().robot_id());
  bool brakes_held = true;
  far.run([&] {
    other.send(protocol_version + 1, true);
    brakes_held = brakes_held && far.brake();
    return far.server().commander().refused > 50;
  });
  EXPECT_TRUE(brakes_held);
  EXPECT_EQ(far.server().commander().received, 0u);
}

}  // namespace
}  // namespace flinch
