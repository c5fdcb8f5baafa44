#include "diagrams/operator_ports.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/diagrams/contact_bench.h"
#include "tests/support/allocations.h"

namespace flinch {
namespace {

using enum ReactionMode;
using test::Bench;
using test::BenchExperiment;
using test::encoder_noise;
using ::testing::Contains;
using ::testing::Not;
using After = OperatorEvent::After;

const Eigen::Vector3d far_out(-0.361, 0.0, 0.0);  // 11 mm beyond the limit, and only beyond that one
const Eigen::Vector3d inside(-0.3, 0.0, 0.0);

OperatorEvent press(After after, Time wait, const OperatorCommand& buttons) {
  return {.after = after, .wait = wait, .buttons = buttons, .target = {}};
}
OperatorEvent go_to(After after, Time wait, const Eigen::Vector3d& pose) {
  OperatorEvent event{.after = after, .wait = wait, .buttons = {}, .target = {}};
  event.target.kind = TargetCommand::Kind::pose;
  event.target.pose = pose;
  return event;
}

/// A robot that stands at `pose` when the run begins, and an operator.
BenchExperiment standing_at(const Eigen::Vector3d& pose, std::vector<OperatorEvent> events) {
  BenchExperiment experiment;
  experiment.friction = BenchFriction::test_bench;
  experiment.station.encoder_noise = encoder_noise;
  experiment.station.pose = pose;
  experiment.script.events = std::move(events);
  return experiment;
}

std::vector<std::string> inputs_of(const Bench& bench) {
  std::vector<std::string> names;
  for (const System::Input& input : bench.diagram->inputs()) names.push_back(input.name);
  return names;
}

TEST(OperatorPorts, AreInputsOfTheDiagramUnderNamesThatSayWhoActs) {
  const Bench by_hand(standing_at(inside, {}));
  EXPECT_THAT(inputs_of(by_hand), Contains("operator"));
  EXPECT_THAT(inputs_of(by_hand), Contains("target"));
  const Bench scripted(standing_at(inside, {press(After::time, 1s, {.stop = true})}));
  EXPECT_THAT(inputs_of(scripted), Contains("panel"));
  EXPECT_THAT(inputs_of(scripted), Contains("panel_target"));
  EXPECT_THAT(inputs_of(scripted), Not(Contains("operator")));
}

TEST(AScript, BringsARobotBackThatStandsOutsideWithoutAllocating) {
  Bench bench(standing_at(
      far_out, {press(After::time, 400ms, {.reset = true}), go_to(After::recovering, 100ms, inside)}));
  bench.run(300ms);
  const test::AllocationCounter counter;
  bench.run(150ms);
  EXPECT_EQ(bench.state().mode, recover);
  EXPECT_LT((bench.pose() - far_out).norm(), 1e-3);
  bench.run(4s);
  EXPECT_EQ(counter.count(), 0);
  EXPECT_EQ(bench.state().mode, nominal);
  EXPECT_LT((bench.pose() - inside).norm(), 1e-3);
}

TEST(AScript, GoesOnFromAStopOfItsOwn) {
  Bench bench(standing_at(
      inside, {press(After::time, 400ms, {.stop = true}), press(After::ended, 100ms, {.reset = true})}));
  bench.run(450ms);
  EXPECT_EQ(bench.gate().phase, GatePhase::closed);
  EXPECT_EQ(bench.gate().fault, GateFault::operator_stop);
  bench.run(100ms);
  EXPECT_EQ(bench.state().mode, nominal);
}

TEST(AScript, DoesNotResetWhatThePanelHasStopped) {
  Bench bench(standing_at(inside, {press(After::ended, 100ms, {.reset = true})}));
  bench.run(400ms);
  bench.press({.stop = true});
  bench.tick();
  bench.press({});
  bench.run(1s);
  EXPECT_EQ(bench.gate().phase, GatePhase::closed);
  bench.reset();
  bench.run(10ms);
  EXPECT_EQ(bench.state().mode, nominal) << "the panel does";
}

}  // namespace
}  // namespace flinch
