// flinch run --station dds --attended: what an operator types reaches the robot.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "systems/framework/monotonic_clock.h"
#include "systems/framework/recording.h"
#include "tests/apps/flinch/bus/rig_on_the_bus.h"
#if FLINCH_HAS_LIVE_VIEW
#include "tests/experiments/live_view/loopback_connection.h"
#endif

namespace flinch {
namespace {

using test::RigOnTheBus;
using Input = test::OtherProgram::Start::Input;

test::OtherProgram::Start attended(const RigOnTheBus& rig, Input input,
                                   const std::vector<std::string>& more) {
  std::vector<std::string> arguments = rig.run_arguments();
  arguments.insert(arguments.end(), {"--attended"});
  arguments.insert(arguments.end(), more.begin(), more.end());
  test::OtherProgram::Start start = test::flinch_program(arguments);
  start.input = input;
  return start;
}

/// Somebody who types and sees what follows.
class AttendedRun : public testing::Test {
 protected:
  void begin(const std::string& scenario, Input input = Input::pipe,
             const std::vector<std::string>& more = {}) {
    run.reset();
    rig.emplace(scenario);
    seen_ = 0;
    run.emplace(attended(*rig, input, more));
  }
  void type(const std::string& text) { run->type(text); }
  /// Whether `text` is told, behind all that was seen before.
  bool sees(const std::string& text, Time patience = 20s) {
    const Time deadline = MonotonicClock::now() + patience;
    std::size_t found = std::string::npos;
    while ((found = run->output().find(text, seen_)) == std::string::npos &&
           MonotonicClock::now() < deadline && run->is_running()) {
      std::this_thread::sleep_for(10ms);
    }
    if (found != std::string::npos) seen_ = found + text.size();
    return found != std::string::npos;
  }
  /// What has gone wrong where something was not seen: the machine, or the program.
  void complain_of(const std::string& what) {
    if (test::machine_stall() >= test::noticeable_stall) GTEST_SKIP() << test::not_measured() << ": " << what;
    FAIL() << what << "\n" << run->output();
  }
  std::optional<RigOnTheBus> rig;
  std::optional<test::OtherProgram> run;

 private:
  std::size_t seen_ = 0;
};

TEST_F(AttendedRun, IsBroughtBackFromBeyondTheWorkspaceToItsMotion) {
  const auto is_pushed_out = [this] { return sees("stopped; gate closed: the platform is too far out", 5s); };
  begin("brought_back");
  for (int again = 0; !is_pushed_out(); ++again) {  // a late machine closes the gate before that
    if (again == 3) return complain_of("it was not pushed out");
    begin("brought_back");
  }
  std::this_thread::sleep_for(1s);  // it comes to rest
  type("reset\n");
  if (!sees("recover; gate recovering")) return complain_of("it does not recover");
  type("go x_mm: -260, y_mm: 0\n");
  if (!sees("nominal; gate open")) return complain_of("it does not come back inside");
  std::this_thread::sleep_for(3s);  // it arrives
  type("start\n");
  std::this_thread::sleep_for(1s);
  type("end\n");
  EXPECT_TRUE(sees("where the gate had closed: the platform is too far out")) << run->output();
  if (!sees("  nominal motion   at ")) complain_of("the motion did not begin again");
}

TEST_F(AttendedRun, SwitchesDrivesOnAgainThatHaveGivenItUp) {
  begin("square");
  if (!sees("nominal; gate open")) return complain_of("it does not begin");
  run->stop();  // for longer than drives wait for a command
  std::this_thread::sleep_for(300ms);
  run->resume();
  if (!sees("drives: switch-on disabled")) return complain_of("the drives stay on");
  type("reset\n");
  if (!sees("drives: operation enabled")) return complain_of("they stay off");
  for (int attempt = 0; attempt < 5; ++attempt) {
    type("reset\n");
    if (sees("nominal; gate open", 2s)) break;
    ASSERT_LT(attempt, 4) << "it does not go on\n" << run->output();
  }
  type("end\n");
  EXPECT_TRUE(sees("verdict: bad")) << "the gate had closed\n" << run->output();
}

TEST_F(AttendedRun, OutlastsItsScenarioAndEndsWithItsInput) {
  begin("platform_collision");  // of less than 2 s
  if (!sees("nominal; gate open")) return complain_of("it does not begin");
  std::this_thread::sleep_for(4s);
  EXPECT_TRUE(run->is_running()) << run->output();
  run->end_input();
  EXPECT_TRUE(run->wait(20s)) << run->output();
  const Recording recording = read_recording(rig->place / "live/run.h5");
  EXPECT_GT(to_seconds(Time(recording.time_ns.back())), 3.5);
}

TEST_F(AttendedRun, DoesNotBeginWhatWasStoppedBeforeItCould) {
  begin("square");
  type("stop\n");
  ASSERT_TRUE(sees("ordered:   stop")) << run->output();
  std::this_thread::sleep_for(1500ms);
  EXPECT_THAT(run->output(), testing::Not(testing::HasSubstr("gate open"))) << run->output();
  type("reset\n");
  if (!sees("nominal; gate open")) return complain_of("it does not begin after the reset");
}

TEST_F(AttendedRun, RefusesWhatWouldLetAFastRobotRunOut) {
  begin("square");
  if (!sees("nominal; gate open")) return complain_of("it does not begin");
  std::this_thread::sleep_for(1500ms);  // it moves with 1.5 m/s
  type("go\n");
  if (!sees("error: go and step have no effect while the robot moves so fast")) return complain_of("it goes");
  type("start\n");
  if (!sees("error: start has no effect before the robot is at rest")) return complain_of("it starts");
  type("stop\n");
  std::this_thread::sleep_for(10ms);  // it still moves
  type("reset\n");
  if (!sees("error: reset has no effect while the robot moves")) return complain_of("it was reset");
  type("step x_mm: 5\n");
  if (!sees("error: start, go and step have no effect in this mode; reset first"))
    return complain_of("it steps");
  std::this_thread::sleep_for(1s);
  type("reset\n");
  if (!sees("nominal; gate open")) return complain_of("it was not reset at rest");
  std::this_thread::sleep_for(500ms);  // its reference rests, too
  type("step x_mm: 900\n");
  if (!sees("error: step has no effect: it leads out of the reach of the legs")) complain_of("it was taken");
}

TEST_F(AttendedRun, TakesWhatIsTypedOnATerminal) {
  begin("square", Input::terminal);
  if (!sees("nominal; gate open")) return complain_of("it does not begin");
  EXPECT_FALSE(run->echoes()) << "the line of state shows it";
  type("hel");
  EXPECT_TRUE(sees("> hel ")) << run->output();
  type("\x15");
  type(
      "helo\x7f\x7f"
      "lp\x1b[A\x1b[3~\x1bOA\r");
  EXPECT_TRUE(sees("end      end the run")) << run->output();
  type(
      "step x_mm: \xe2\x88\x92"
      "5\r");  // a minus that is none
  EXPECT_TRUE(sees("error: 'step x_mm: ' is followed by a letter that no order has")) << run->output();
  type(
      "\x13\x1a\x1c"
      "\x15"
      "hello\r");  // keys that would stop, suspend or kill another program
  EXPECT_TRUE(sees("error: 'hello' is no order; did you mean 'help'?")) << run->output();
  type(std::string(300, 'x') + "\r");
  EXPECT_TRUE(sees("error: an order has at most 200 letters")) << run->output();
  type("\x1bstop\r");  // Esc, in alarm
  EXPECT_TRUE(sees("ordered:   stop")) << run->output();
  EXPECT_TRUE(sees("gate closed: ")) << run->output();
  type("\x04");
  EXPECT_TRUE(sees("ended:     the end of the input")) << run->output();
  EXPECT_TRUE(run->wait(20s)) << run->output();
  EXPECT_TRUE(run->echoes()) << "the terminal is left as it was";
}

#if FLINCH_HAS_LIVE_VIEW

/// The first line of the answer to an order from a page.
std::string answer_to_order(const LiveAddress& page, const std::string& order) {
  LoopbackConnection connection(page.port);
  connection.send("POST " + page.root + "order HTTP/1.1\r\nHost: " + page.host +
                  "\r\nConnection: close\r\nContent-Length: " + std::to_string(order.size()) + "\r\n\r\n" +
                  order);
  return connection.read_until("\r\n");
}

TEST_F(AttendedRun, FollowsOrdersOfItsPage) {
  begin("square", Input::pipe, {"--live", "--live-wait", "0"});
  if (!sees("nominal; gate open")) return complain_of("it does not begin");
  const std::string output = run->output();
  const std::size_t at = output.find("http://127");
  ASSERT_NE(at, std::string::npos) << output;
  const LiveAddress page(output.substr(at, output.find('\n', at) - at));
  EXPECT_THAT(answer_to_order(page, "hello"), testing::HasSubstr("400"));
  EXPECT_TRUE(sees("error: 'hello' is no order")) << run->output();
  EXPECT_THAT(answer_to_order(page, "\x1b[2J"), testing::HasSubstr("400"));
  EXPECT_TRUE(sees("error: an order has a letter that none has")) << run->output();
  EXPECT_THAT(answer_to_order(page, "stop"), testing::HasSubstr("204"));
  EXPECT_TRUE(sees("ordered:   stop")) << run->output();
  EXPECT_TRUE(sees("gate closed: ")) << run->output();
  EXPECT_THAT(answer_to_order(page, "end"), testing::HasSubstr("204"));
  EXPECT_TRUE(run->wait(20s)) << run->output();
}

#endif

TEST_F(AttendedRun, EndsInOrderByCtrlC) {
  begin("square", Input::terminal);
  if (!sees("nominal; gate open")) return complain_of("it does not begin");
  type("\x03");
  EXPECT_EQ(run->wait(20s), 3) << run->output();
  EXPECT_TRUE(run->echoes());
}

TEST_F(AttendedRun, DoesWhatItCanWithWhatIsNoOrder) {
  begin("square");
  std::string garbage;
  for (int i = 0; i < 2000; ++i) garbage += static_cast<char>(i * 37 % 256);
  type(garbage + "\n\n\r\n");
  for (int i = 0; i < 100; ++i) type("reset\n");
  if (!sees("nominal; gate open")) return complain_of("it does not begin");
  type("stop\n");
  EXPECT_TRUE(sees("gate closed: ")) << run->output();
  type("end\n");
  EXPECT_TRUE(run->wait(20s)) << run->output();
}

}  // namespace
}  // namespace flinch
