#include "experiments/report/station_lanes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "systems/framework/constant.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/recorder.h"
#include "systems/framework/simulator.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;

/// A recording of one sample.
Recording recording_of(const StationStatus& status) {
  DiagramBuilder builder("bench");
  builder.export_output("status", builder.add<Constant<StationStatus>>("station", status).value);
  const auto diagram = builder.build();
  Recorder recorder(*diagram, {"status"}, 1);
  Simulator simulator(*diagram);
  simulator.record(recorder);
  Context context = diagram->make_context();
  simulator.step(context);
  return recorder.recording({});
}

/// The states of both lanes, by their names; "" for no data.
std::vector<std::string> states_of(const StationStatus& status) {
  const Recording recording = recording_of(status);
  PageSamples page(1);
  StationLanes lanes(recording, page);
  page.begin();
  lanes.show(0);
  Report report;
  page.finish(report);
  std::vector<std::string> names;
  for (const ReportLane& lane : report.lanes) {
    const int state = lane.state.at(0);
    names.push_back(lane.name + " " + (state < 0 ? "" : lane.states.at(static_cast<std::size_t>(state))));
  }
  return names;
}

TEST(StationLanes, SayWhetherDrivesAreOnAndBrakesClosed) {
  EXPECT_THAT(states_of({.valid = true, .enabled = true}), ElementsAre("drives on", "brakes open"));
  EXPECT_THAT(states_of({.valid = true, .braked = true}), ElementsAre("drives off", "brakes closed"));
  EXPECT_THAT(states_of({.valid = true, .enabled = true, .fault = true}),
              ElementsAre("drives fault", "brakes open"));
}

TEST(StationLanes, SayNothingOfAStatusThatIsNotValid) {
  EXPECT_THAT(states_of({.enabled = true}), ElementsAre("drives ", "brakes "));
}

}  // namespace
}  // namespace flinch
