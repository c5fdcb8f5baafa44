// A robot that waits for its controller, both in this program, each on a thread of its own.
#include "drivers/lockstep_server.h"

#include <drivers/idl/flinch.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "drivers/lockstep_ticks.h"
#include "drivers/robot_pace.h"
#include "drivers/step_sender.h"
#include "systems/framework/realtime_runner.h"
#include "tests/drivers/link_ends.h"
#include "tests/support/free_domain.h"

namespace flinch {
namespace {

using test::FarRobot;
using test::link_robot;
using test::NearController;

/// Has the robot, which waits, on a thread of its own while it lives.
class WaitingEnd {
 public:
  explicit WaitingEnd(const DdsBus& bus, Time patience = 10s)
      : diagram_(build()),
        server_(bus, *diagram_, station_, {.robot = link_robot, .patience = patience}),
        thread_([this] { server_.run([this] { return ending_.load(); }); }) {}
  ~WaitingEnd() {
    ending_ = true;
    thread_.join();
  }

  /// Whether the state becomes so within some seconds.
  bool becomes(const std::function<bool(const LockstepState&)>& so) {
    for (int i = 0; i < 1000; ++i) {
      if (so(server_.state())) return true;
      MonotonicClock::sleep_until(MonotonicClock::now() + 10ms);
    }
    return false;
  }
  LockstepServer& server() { return server_; }

 private:
  std::unique_ptr<Diagram> build() {
    DiagramBuilder builder("far");
    auto& robot = builder.add<FarRobot>("robot");
    station_.torque_command = builder.export_input("torque_command", robot.torque_command);
    station_.brake = builder.export_input("brake", robot.brake);
    station_.joints = robot.joints;
    station_.drives = robot.drives;
    station_.imu = robot.imu;
    station_.status = robot.status;
    return builder.build();
  }

  Station station_;
  std::unique_ptr<Diagram> diagram_;
  LockstepServer server_;
  std::atomic<bool> ending_ = false;
  std::thread thread_;
};

/// Commands it.
class SteppingEnd {
 public:
  explicit SteppingEnd(const DdsBus& bus, Time patience = 10s, bool force_torque = true)
      : diagram_(build(force_torque)),
        dds_(bus, *diagram_, station_, {.robot = link_robot, .pace = Pace::lockstep}),
        ticks_(dds_, patience, [] { return false; }) {}

  bool begin() {
    for (int i = 0; i < 2000 && dds_.take_robot() == 0; ++i)
      MonotonicClock::sleep_until(MonotonicClock::now() + 10ms);
    return ticks_.begin();
  }
  /// Runs until `end`; `each_tick` sees the outputs of each.
  void run(
      Time end, const std::function<void()>& each_tick = [] {}) {
    context_ = std::make_unique<Context>(diagram_->make_context());
    RealtimeRunner runner(*diagram_, ticks_, dds_);
    runner.run(*context_, end, [&] {
      each_tick();
      return false;
    });
  }
  LockstepTicks& ticks() { return ticks_; }
  DdsStation& dds() { return dds_; }
  template <class Port>
  const auto& get(Port port) const {
    return context_->get(port);
  }
  const ExternalStation& station() const { return station_; }
  Time time() const { return context_->time(); }

 private:
  std::unique_ptr<Diagram> build(bool force_torque) {
    DiagramBuilder builder("near");
    const auto robot = std::make_shared<PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::none));
    station_ = add_external_station(builder, robot, {.force_torque = force_torque, .lockstep = true});
    auto& controller = builder.add<NearController>("controller");
    builder.connect(station_.joints, controller.joints);
    builder.connect(station_.status, controller.status);
    builder.connect(controller.torque_command, station_.torque_command);
    builder.connect(controller.brake, station_.brake);
    return builder.build();
  }

  ExternalStation station_;
  std::unique_ptr<Diagram> diagram_;
  std::unique_ptr<Context> context_;
  DdsStation dds_;
  LockstepTicks ticks_;
};

TEST(Lockstep, GivesEachTickItsReadingsAndEachReadingItsCommand) {
  const DdsBus bus({.domain = test::free_domain()});
  WaitingEnd robot(bus);
  SteppingEnd controller(bus);
  ASSERT_TRUE(controller.begin());
  Time tick = 0ms;
  controller.run(500ms, [&] {
    const JointReading& joints = controller.get(controller.station().joints);
    const DriveReading& drives = controller.get(controller.station().drives);
    // What is told of a tick is of that tick; the torques are those of the tick before, a tenth of which is
    // measured: the angles then.
    ASSERT_EQ(joints.acquired, tick);
    ASSERT_EQ(controller.get(controller.station().imu).acquired, tick);
    ASSERT_EQ(joints.active[0], to_seconds(tick));
    const double before = tick == Time::zero() ? 0.0 : to_seconds(tick - 1ms);
    ASSERT_EQ(drives.current[0], before / 10.0);
    ASSERT_FALSE(controller.get(*controller.station().force_torque).valid) << "the robot has none";
    tick += 1ms;
  });
  EXPECT_EQ(tick, 500ms);
  controller.ticks().let_go();
  EXPECT_TRUE(robot.becomes([](const LockstepState& now) {
    return now.controller == 0 && now.time == Time::zero() && now.ticks == 500 && now.runs == 1;
  }));
}

TEST(Lockstep, BeginsEveryRunAtTheStart) {
  const DdsBus bus({.domain = test::free_domain()});
  const WaitingEnd robot(bus);
  for (int run = 0; run < 3; ++run) {
    SteppingEnd controller(bus);
    ASSERT_TRUE(controller.begin());
    Time first = 1h;
    controller.run(20ms,
                   [&] { first = std::min(first, controller.get(controller.station().joints).acquired); });
    EXPECT_EQ(first, Time::zero());
    EXPECT_EQ(controller.time(), 20ms);
    controller.ticks().let_go();
  }
}

TEST(Lockstep, WaitsForAControllerThatTakesItsTime) {
  const DdsBus bus({.domain = test::free_domain()});
  const WaitingEnd robot(bus);
  SteppingEnd controller(bus);
  ASSERT_TRUE(controller.begin());
  controller.run(10ms, [] { MonotonicClock::sleep_until(MonotonicClock::now() + 70ms); });
  EXPECT_EQ(controller.time(), 10ms);
  EXPECT_EQ(controller.ticks().end(), LockstepTicks::End::none);
}

TEST(Lockstep, GivesUpAControllerThatIsSilentAndHearsTheNext) {
  const DdsBus bus({.domain = test::free_domain()});
  WaitingEnd robot(bus, 200ms);
  {
    SteppingEnd controller(bus);
    ASSERT_TRUE(controller.begin());
    controller.run(10ms);
    EXPECT_TRUE(robot.becomes([](const LockstepState& now) { return now.abandoned == 1; }));
    controller.run(30ms);  // its session is over: the robot does not go on for it
    EXPECT_EQ(controller.ticks().end(), LockstepTicks::End::gone);
  }
  SteppingEnd next(bus);
  ASSERT_TRUE(next.begin());
  next.run(10ms);
  EXPECT_EQ(next.time(), 10ms);
}

TEST(Lockstep, EndsWhereTheRobotIsSilent) {
  const DdsBus bus({.domain = test::free_domain()});
  auto robot = std::make_unique<WaitingEnd>(bus);
  SteppingEnd controller(bus, 200ms);
  ASSERT_TRUE(controller.begin());
  controller.run(1s, [&] {
    if (controller.time() == 20ms) robot.reset();
  });
  EXPECT_EQ(controller.ticks().end(), LockstepTicks::End::silent);
  EXPECT_LE(controller.time(), 22ms);
}

TEST(Lockstep, HearsOneControllerAtATime) {
  const DdsBus bus({.domain = test::free_domain()});
  WaitingEnd robot(bus);
  SteppingEnd first(bus);
  ASSERT_TRUE(first.begin());
  SteppingEnd second(bus, 200ms);
  EXPECT_FALSE(second.begin());
  EXPECT_EQ(second.ticks().end(), LockstepTicks::End::silent);
  first.run(20ms);
  EXPECT_EQ(first.time(), 20ms);
  EXPECT_TRUE(robot.becomes([](const LockstepState& now) { return now.refused > 0; }));
}

/// Sends commands of its own making, for the robot `id`.
class Forger {
 public:
  Forger(const DdsBus& bus, std::uint64_t id)
      : sender_(bus, torque_command_topic, {.session = draw_session(), .robot = link_robot, .robot_id = id}) {
  }

  /// For half a second, so that some arrive.
  void send(std::uint8_t flags, Time tick) {
    flinch_TorqueSample sample{};
    sample.header.flags = flags;
    sample.header.count = 3;
    for (int i = 0; i < 50; ++i) {
      sender_.send(sample, tick);
      MonotonicClock::sleep_until(MonotonicClock::now() + 10ms);
    }
  }

 private:
  StepSender<flinch_TorqueSample> sender_;
};

TEST(Lockstep, MovesForNoCommandThatIsNotItsTurn) {
  const DdsBus bus({.domain = test::free_domain()});
  WaitingEnd robot(bus);
  Forger forger(bus, robot.server().robot_id());
  const auto moved = [&robot] { return robot.server().state().ticks; };
  forger.send(flag_valid, 0ms);  // without a begin
  forger.send(flag_engage_brake, 0ms);
  EXPECT_EQ(moved(), 0);
  forger.send(flag_begin | flag_engage_brake, Time(-1));
  EXPECT_TRUE(robot.becomes([](const LockstepState& now) { return now.runs == 1; }));
  forger.send(flag_valid, 1ms);  // of the tick after the next
  forger.send(flag_valid, Time(-1));
  EXPECT_EQ(moved(), 0);
  forger.send(flag_valid, 0ms);  // again and again
  EXPECT_EQ(moved(), 1);
}

TEST(Lockstep, BeginsForNobodyWhoWantsTorqueAtOnce) {
  const DdsBus bus({.domain = test::free_domain()});
  WaitingEnd robot(bus);
  Forger(bus, robot.server().robot_id()).send(flag_begin | flag_valid, Time(-1));
  Forger(bus, robot.server().robot_id() + 1).send(flag_begin | flag_engage_brake, Time(-1));
  EXPECT_TRUE(robot.becomes([](const LockstepState& now) { return now.refused > 10; }));
  EXPECT_EQ(robot.server().state().runs, 0);
}

TEST(Lockstep, IsRefusedByARobotThatGoesByTheClock) {
  const DdsBus bus({.domain = test::free_domain()});
  test::FarEnd far(bus);
  {
    const test::FarThread running(far);
    SteppingEnd controller(bus, 300ms);
    EXPECT_FALSE(controller.begin());
    EXPECT_GT(controller.dds().link().other_pace, 0U);
    EXPECT_EQ(controller.dds().link().received, 0U);
    Forger forger(bus, far.server().robot_id());
    forger.send(flag_engage_brake, 0ms);
    forger.send(flag_valid, 1ms);
  }
  EXPECT_EQ(far.server().commander().received, 0U);
  EXPECT_GT(far.server().commander().in_lockstep, 0U);
  EXPECT_TRUE(far.brake());
  EXPECT_FALSE(far.torque().valid);
}

TEST(Lockstep, RefusesAControllerThatGoesByTheClock) {
  const DdsBus bus({.domain = test::free_domain()});
  WaitingEnd robot(bus);
  test::NearEnd near(bus);
  near.run([&near] { return near.time() > 800ms; });
  EXPECT_GT(near.dds().link().other_pace, 0U);
  EXPECT_FALSE(near.get(near.station().joints).valid);
  EXPECT_TRUE(robot.becomes([](const LockstepState& now) { return now.in_real_time > 0; }));
  EXPECT_EQ(robot.server().state().runs, 0);
}

TEST(Pace, IsThatWhichTheRobotTells) {
  const std::function<bool()> patient = [] { return false; };
  {
    const DdsBus bus({.domain = test::free_domain()});
    EXPECT_EQ(find_pace(bus, link_robot, "", 100ms, patient), std::nullopt);
    const WaitingEnd robot(bus);
    EXPECT_EQ(find_pace(bus, link_robot, "", 20s, patient), Pace::lockstep);
    EXPECT_EQ(find_pace(bus, link_robot, "", 20s, [] { return true; }), std::nullopt);
    EXPECT_EQ(find_pace(bus, link_robot + 1, "", 20s, patient), std::nullopt) << "of another description";
  }
  const DdsBus bus({.domain = test::free_domain()});
  test::FarEnd far(bus);
  const test::FarThread running(far);
  EXPECT_EQ(find_pace(bus, link_robot, "", 20s, patient), Pace::real_time);
}

}  // namespace
}  // namespace flinch
