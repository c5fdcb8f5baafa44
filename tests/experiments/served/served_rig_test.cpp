#include "experiments/served/served_rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/recorded/recorded_signals.h"
#include "experiments/report/report_samples.h"
#include "experiments/simulated/simulated_scenario.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/recorder.h"
#include "systems/framework/simulator.h"
#include "systems/robot/quantity_units.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;

/// The rig of the square, told a wish and no torque.
class ServedSquare {
 public:
  ServedSquare()
      : rig_(build_served_rig(read_simulated_scenario(test::shipped("scenarios/square.yaml")), 5ms)),
        context_(rig_.diagram->make_context()) {}

  StationStatus after(Time duration, const RequestedDriveState& wish) {
    context_.set(rig_.station.wish, wish);
    Simulator simulator(*rig_.diagram, std::make_unique<SundialsIntegrator>());
    for (const Time end = context_.time() + duration; context_.time() < end;) {
      context_.set(rig_.station.torque_command,
                   {.computed = context_.time(), .valid = true, .torque = JointVector::Zero(3)});
      context_.set(rig_.station.brake, {.engage = false});
      simulator.step(context_);
    }
    return context_.get(rig_.station.status);
  }

 private:
  ServedRig rig_;
  Context context_;
};

TEST(ServedRig, StandsBehindClosedBrakesUntilItsDrivesAreSwitchedOn) {
  ServedSquare square;
  const StationStatus before = square.after(50ms, {});
  EXPECT_TRUE(before.valid && before.braked);
  EXPECT_FALSE(before.enabled);
  const StationStatus enabled =
      square.after(500ms, {.state = RequestedDriveState::State::operation_enabled, .engage_brake = false});
  EXPECT_TRUE(enabled.enabled);
  EXPECT_FALSE(enabled.braked);
  EXPECT_FALSE(square.after(500ms, {}).enabled);
}

/// A rig at work, as who watches it sees it.
Recording watched(const SimulatedScenario& scenario, const Diagram& diagram, const Station& station) {
  Recorder recorder(diagram, recorded_paths(diagram), 50, quantity_units(*scenario.robot.robot));
  Simulator simulator(diagram, std::make_unique<SundialsIntegrator>());
  simulator.record(recorder);
  Context context = diagram.make_context();
  for (int tick = 0; tick < 50; ++tick) {
    context.set(station.torque_command,
                {.computed = context.time(), .valid = true, .torque = JointVector::Constant(3, 5.0)});
    context.set(station.brake, {.engage = false});
    simulator.step(context);
  }
  return recorder.recording({{rig_alone, ""}});
}

TEST(ServedRig, ShowsRobotContactDrivesAndBrakesAndNothingOfAController) {
  const SimulatedScenario scenario =
      read_simulated_scenario(test::shipped("scenarios/platform_collision.yaml"));
  const WaitingRig rig = build_waiting_rig(scenario, true);
  const Recording recording = watched(scenario, *rig.diagram, rig.station);
  Report report;
  add_samples(*scenario.robot.robot, recording, report, 1);
  std::vector<std::string> lanes;
  for (const ReportLane& lane : report.lanes) lanes.push_back(lane.name);
  EXPECT_THAT(lanes, ElementsAre("contact", "drives", "brakes"));
  const std::vector<double>& x = report.columns.at("pose_x");
  EXPECT_NE(x.front(), x.back()) << "it moves";
  EXPECT_EQ(report.columns.at("torque_commanded_1").back(), 5.0);
  EXPECT_TRUE(std::isnan(report.columns.at("estimated_force_x").back()));
}

}  // namespace
}  // namespace flinch
