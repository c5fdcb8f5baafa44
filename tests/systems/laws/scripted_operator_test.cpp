#include "systems/laws/scripted_operator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram_builder.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

using enum ReactionMode;
using After = OperatorEvent::After;

OperatorEvent press_reset(After after, Time wait) {
  return {.after = after, .wait = wait, .buttons = {.reset = true}, .target = {}};
}
OperatorEvent press_start(After after, Time wait) {
  return {.after = after, .wait = wait, .buttons = {.start = true}, .target = {}};
}
OperatorEvent go_to(After after, Time wait, double x) {
  OperatorEvent event{.after = after, .wait = wait, .buttons = {}, .target = {}};
  event.target.kind = TargetCommand::Kind::pose;
  event.target.pose = Eigen::Vector3d(x, 0.0, 0.0);
  return event;
}

/// A block that is told by hand what the robot does.
struct Desk {
  explicit Desk(std::vector<OperatorEvent> events)
      : block(builder.add<ScriptedOperator>("operator", OperatorScript{.events = std::move(events)})),
        panel(builder.export_input("panel", block.panel)),
        panel_target(builder.export_input("panel_target", block.panel_target)),
        joints(builder.export_input("joints", block.joints)),
        reaction(builder.export_input("reaction", block.reaction)),
        gate(builder.export_input("gate", block.gate)),
        reference(builder.export_input("reference", block.reference)) {
    drives_turn(true, 0.0);
    robot_is(nominal, GatePhase::open, true);
  }

  void robot_is(ReactionMode mode, GatePhase phase, bool finished) {
    ticking.set(reaction, ReactionState{.mode = mode});
    ticking.set(gate, GateStatus{.phase = phase});
    PlatformReference wanted;
    wanted.valid = true;
    wanted.finished = finished;
    ticking.set(reference, wanted);
  }

  void drives_turn(bool valid, double speed) {
    JointMotion motion;
    motion.valid = valid;
    motion.velocity = Eigen::Vector3d(0.0, speed, 0.0);
    ticking.set(joints, motion);
  }

  /// The next tick in words: "reset", "to 0.1", ...; "" where nothing is done.
  std::string tick() {
    ticking.tick();
    const OperatorCommand& pressed = ticking.get(block.buttons);
    const TargetCommand& target = ticking.get(block.target);
    std::string done;
    if (pressed.start) done += "start";
    if (pressed.reset) done += "reset";
    if (pressed.stop) done += "stop";
    if (target.number != number) done += "to " + std::to_string(target.pose[0]).substr(0, 3);
    number = target.number;
    return done;
  }
  std::vector<std::string> tick(int times) {
    std::vector<std::string> done;
    for (int k = 0; k < times; ++k) done.push_back(tick());
    return done;
  }

  DiagramBuilder builder;
  ScriptedOperator& block;
  InputPort<OperatorCommand> panel;
  InputPort<TargetCommand> panel_target;
  InputPort<JointMotion> joints;
  InputPort<ReactionState> reaction;
  InputPort<GateStatus> gate;
  InputPort<PlatformReference> reference;
  test::Ticking ticking{builder};
  std::uint32_t number = 0;
};

using Done = std::vector<std::string>;

TEST(ScriptedOperator, ActsAtTheTimesOfItsScriptForOneTickEach) {
  Desk desk({press_reset(After::time, 2ms), go_to(After::time, 4ms, 0.1), press_start(After::time, 6ms)});
  EXPECT_EQ(desk.tick(8), (Done{"", "", "reset", "", "to 0.1", "", "start", ""}));
}

TEST(ScriptedOperator, LetsAButtonUpBetweenTwoEventsWhereTimesLieCloser) {
  Desk desk({press_reset(After::time, 1100us), press_reset(After::time, 1200us)});
  EXPECT_EQ(desk.tick(6), (Done{"", "", "reset", "", "reset", ""}));
}

TEST(ScriptedOperator, WaitsForWhatTheRobotDoesAndLearnsItATickLater) {
  Desk desk(
      {press_reset(After::ended, 2ms), go_to(After::recovering, 0ms, 0.2), press_start(After::arrived, 1ms)});
  EXPECT_EQ(desk.tick(3), (Done{"", "", ""})) << "in its nominal motion it has not ended";
  desk.robot_is(hold, GatePhase::open, true);
  EXPECT_EQ(desk.tick(4), (Done{"", "", "", "reset"}));
  desk.robot_is(recover, GatePhase::recovering, false);
  EXPECT_EQ(desk.tick(3), (Done{"", "to 0.2", ""}));
  desk.robot_is(nominal, GatePhase::open, true);
  EXPECT_EQ(desk.tick(4), (Done{"", "", "start", ""}));
}

TEST(ScriptedOperator, CountsAWaitAnewWhereItIsInterrupted) {
  Desk desk({press_reset(After::ended, 3ms)});
  desk.robot_is(hold, GatePhase::open, true);
  EXPECT_EQ(desk.tick(3), (Done{"", "", ""}));
  desk.robot_is(react, GatePhase::open, false);
  desk.tick();
  desk.robot_is(hold, GatePhase::open, true);
  EXPECT_EQ(desk.tick(5), (Done{"", "", "", "", "reset"}));
}

TEST(ScriptedOperator, KnowsEveryEndOfAReactionAndNoOther) {
  struct Case {
    ReactionMode mode;
    GatePhase phase;
    double speed;
    bool valid;
    bool has_ended;
  };
  for (const Case& each :
       {Case{hold, GatePhase::open, 0.0, true, true}, Case{zero_g, GatePhase::open, 0.0, true, true},
        Case{stopped, GatePhase::closed, 0.0, true, true}, Case{hold, GatePhase::open, 0.06, true, false},
        Case{hold, GatePhase::open, 0.0, false, false},
        Case{hold, GatePhase::open, std::nan(""), true, false},
        Case{stopped, GatePhase::closed, -0.06, true, false},
        Case{stopped, GatePhase::waiting, 0.0, true, false}, Case{react, GatePhase::open, 0.0, true, false},
        Case{nominal, GatePhase::open, 0.0, true, false},
        Case{recover, GatePhase::recovering, 0.0, true, false}}) {
    Desk desk({press_reset(After::ended, 0ms)});
    desk.robot_is(each.mode, each.phase, true);
    desk.drives_turn(each.valid, each.speed);
    EXPECT_EQ(desk.tick(2), (Done{"", each.has_ended ? "reset" : ""}))
        << static_cast<int>(each.mode) << " " << each.speed;
  }
}

TEST(ScriptedOperator, GoesOnWithTheFirstEventAfterAnEndWhereTheRobotEndsAgain) {
  Desk desk(
      {press_start(After::time, 0ms), press_reset(After::ended, 2ms), go_to(After::recovering, 0ms, 0.3)});
  EXPECT_EQ(desk.tick(), "start");
  desk.robot_is(stopped, GatePhase::closed, true);
  EXPECT_EQ(desk.tick(4), (Done{"", "", "", "reset"}));
  EXPECT_EQ(desk.tick(4), (Done{"", "", "", "reset"})) << "it had no effect";
  desk.robot_is(recover, GatePhase::recovering, false);
  EXPECT_EQ(desk.tick(3), (Done{"", "to 0.3", ""}));
  desk.robot_is(hold, GatePhase::open, true);
  EXPECT_EQ(desk.tick(4), (Done{"", "", "", "reset"}));
  desk.robot_is(recover, GatePhase::recovering, false);
  EXPECT_EQ(desk.tick(3), (Done{"", "to 0.3", ""}));
}

TEST(ScriptedOperator, LeavesTargetsOfARecoveryOutWhereThereIsNone) {
  Desk desk({press_reset(After::ended, 0ms), go_to(After::recovering, 0ms, 0.1),
             go_to(After::recovering, 1ms, 0.2), press_start(After::arrived, 0ms)});
  desk.robot_is(hold, GatePhase::open, true);
  EXPECT_EQ(desk.tick(2), (Done{"", "reset"}));
  desk.robot_is(nominal, GatePhase::open, false);
  EXPECT_EQ(desk.tick(3), (Done{"", "", ""}));
  desk.robot_is(nominal, GatePhase::open, true);
  EXPECT_EQ(desk.tick(2), (Done{"", "start"}));
}

TEST(ScriptedOperator, WaitsAnewForWhatComesAfterATargetThatIsLeftOut) {
  Desk desk({press_reset(After::ended, 0ms), go_to(After::recovering, 50ms, 0.1),
             press_start(After::arrived, 5ms)});
  desk.robot_is(hold, GatePhase::open, true);
  desk.tick(2);
  desk.robot_is(recover, GatePhase::recovering, true);
  EXPECT_EQ(desk.tick(20), Done(20)) << "it has not lasted long enough for the target";
  desk.robot_is(nominal, GatePhase::open, true);
  EXPECT_EQ(desk.tick(6), Done(6));
  EXPECT_EQ(desk.tick(1), (Done{"start"}));
}

TEST(ScriptedOperator, HandsOnWhatIsDoneAtThePanel) {
  Desk desk({press_reset(After::time, 1ms), go_to(After::time, 3ms, 0.4)});
  desk.ticking.set(desk.panel, OperatorCommand{.start = true});
  EXPECT_EQ(desk.tick(2), (Done{"start", "startreset"}));
  desk.ticking.set(desk.panel, OperatorCommand());
  EXPECT_EQ(desk.tick(), "");
  TargetCommand wanted;
  wanted.number = 7;
  wanted.kind = TargetCommand::Kind::pose;
  wanted.pose = Eigen::Vector3d(0.9, 0.0, 0.0);
  desk.ticking.set(desk.panel_target, wanted);
  EXPECT_EQ(desk.tick(), "to 0.9") << "of two targets that of the panel counts";
  EXPECT_EQ(desk.tick(), "");
}

TEST(ScriptedOperator, IsSilentOnceThePanelHasStoppedTheRobot) {
  Desk desk({press_start(After::time, 3ms), press_reset(After::ended, 0ms)});
  desk.ticking.set(desk.panel, OperatorCommand{.stop = true});
  EXPECT_EQ(desk.tick(), "stop");
  desk.ticking.set(desk.panel, OperatorCommand());
  desk.robot_is(stopped, GatePhase::closed, true);
  EXPECT_EQ(desk.tick(5), (Done{"", "", "", "", ""}));
  desk.ticking.set(desk.panel, OperatorCommand{.reset = true});
  EXPECT_EQ(desk.tick(), "reset") << "the panel goes on";
}

TEST(ScriptedOperator, AllocatesNothing) {
  Desk desk({press_reset(After::ended, 0ms), go_to(After::recovering, 0ms, 0.5)});
  desk.ticking.tick();
  const test::AllocationCounter counter;
  desk.robot_is(hold, GatePhase::open, true);
  for (int k = 0; k < 5; ++k) desk.ticking.tick();
  desk.robot_is(recover, GatePhase::recovering, true);
  for (int k = 0; k < 5; ++k) desk.ticking.tick();
  EXPECT_EQ(counter.count(), 0);
  EXPECT_EQ(desk.ticking.get(desk.block.target).number, 1U);
}

TEST(ScriptedOperator, RefusesARestSpeedThatIsNotPositive) {
  EXPECT_THROW(ScriptedOperator(OperatorScript{.events = {}, .rest_speed = 0.0}), SetupError);
  EXPECT_THROW(ScriptedOperator(OperatorScript{.events = {}, .rest_speed = std::nan("")}), SetupError);
}

}  // namespace
}  // namespace flinch
