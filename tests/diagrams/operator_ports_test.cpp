#include "diagrams/operator_ports.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/diagrams/contact_rig.h"
#include "tests/support/allocations.h"

namespace flinch {
namespace {

using enum ReactionMode;
using test::Bench;
using test::encoder_noise;
using test::RigExperiment;
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
RigExperiment standing_at(const Eigen::Vector3d& pose, std::vector<OperatorEvent> events) {
  RigExperiment experiment;
  experiment.friction = RigFriction::test_rig;
  experiment.station.encoder_noise = encoder_noise;
  experiment.station.pose = pose;
  experiment.script.events = std::move(events);
  return experiment;
}

std::vector<std::string> inputs_of(const Bench& rig) {
  std::vector<std::string> names;
  for (const System::Input& input : rig.diagram->inputs()) names.push_back(input.name);
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
  Bench rig(standing_at(
      far_out, {press(After::time, 400ms, {.reset = true}), go_to(After::recovering, 100ms, inside)}));
  rig.run(300ms);
  const test::AllocationCounter counter;
  rig.run(150ms);
  EXPECT_EQ(rig.state().mode, recover);
  EXPECT_LT((rig.pose() - far_out).norm(), 1e-3);
  rig.run(4s);
  EXPECT_EQ(counter.count(), 0);
  EXPECT_EQ(rig.state().mode, nominal);
  EXPECT_LT((rig.pose() - inside).norm(), 1e-3);
}

TEST(AScript, GoesOnFromAStopOfItsOwn) {
  Bench rig(standing_at(
      inside, {press(After::time, 400ms, {.stop = true}), press(After::ended, 100ms, {.reset = true})}));
  rig.run(450ms);
  EXPECT_EQ(rig.gate().phase, GatePhase::closed);
  EXPECT_EQ(rig.gate().fault, GateFault::operator_stop);
  rig.run(100ms);
  EXPECT_EQ(rig.state().mode, nominal);
}

TEST(AScript, DoesNotResetWhatThePanelHasStopped) {
  Bench rig(standing_at(inside, {press(After::ended, 100ms, {.reset = true})}));
  rig.run(400ms);
  rig.press({.stop = true});
  rig.tick();
  rig.press({});
  rig.run(1s);
  EXPECT_EQ(rig.gate().phase, GatePhase::closed);
  rig.reset();
  rig.run(10ms);
  EXPECT_EQ(rig.state().mode, nominal) << "the panel does";
}

}  // namespace
}  // namespace flinch
