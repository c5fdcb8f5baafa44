#include "diagrams/recorded_station.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "systems/framework/random.h"
#include "systems/framework/recorder.h"
#include "systems/framework/simulator.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "systems/robot/quantity_units.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int ticks = 200;

/// Readings of a station, new ones at each tick; now and then one is missing.
class RandomReadings final : public System {
  State<RandomGenerator> random_ = state<RandomGenerator>("random", RandomGenerator(5));

 public:
  OutputPort<JointReading> joints = output<&RandomReadings::encode>("joints", clock, random_);
  OutputPort<DriveReading> drives = output<&RandomReadings::measure>("drives", clock, random_);
  OutputPort<ImuReading> imu = output<&RandomReadings::feel>("imu", clock, random_);
  OutputPort<StationStatus> status = output<&RandomReadings::report>("status", clock, random_);
  OutputPort<ForceTorqueReading> force_torque =
      output<&RandomReadings::weigh>("force_torque", clock, random_);

 private:
  Update draw_ = update<&RandomReadings::draw>(random_, random_);

  static JointVector three(RandomGenerator& random) {
    return Eigen::Vector3d(random.normal(), random.normal(), random.normal());
  }
  RandomGenerator draw(RandomGenerator random) const {
    random();
    return random;
  }
  JointReading encode(Time now, RandomGenerator random) const {
    if (random.uniform(0, 1) > 0.9) return {};
    return {now, true, random.uniform(0, 1) > 0.5, three(random), three(random)};
  }
  DriveReading measure(Time now, RandomGenerator random) const { return {now, true, three(random)}; }
  ImuReading feel(Time now, RandomGenerator random) const {
    return {now, true, three(random), three(random)};
  }
  StationStatus report(Time now, RandomGenerator random) const {
    return {now, true, true, random.uniform(0, 1) > 0.5, random.uniform(0, 1) > 0.5};
  }
  ForceTorqueReading weigh(Time now, RandomGenerator random) const {
    return {now, true, three(random), three(random)};
  }
};

/// All outputs of `diagram`, recorded.
Recording record(const Diagram& diagram) {
  std::vector<std::string> paths;
  for (const System::Output& output : diagram.outputs()) paths.push_back(output.name);
  const PlanarRrr robot(rig_robot(RigGeometry::individual, RigFriction::none));
  Recorder recorder(diagram, paths, ticks, quantity_units(robot));
  Simulator simulator(diagram);
  simulator.record(recorder);
  Context context = diagram.make_context();
  for (int tick = 0; tick < ticks; ++tick) simulator.step(context);
  return recorder.recording();
}

enum class Instrument { mounted, missing };

Recording original(Instrument instrument, const std::string& prefix = "") {
  DiagramBuilder builder("original");
  const auto& station = builder.add<RandomReadings>("readings");
  builder.export_output(prefix + "joints", station.joints);
  builder.export_output(prefix + "drives", station.drives);
  builder.export_output(prefix + "imu", station.imu);
  builder.export_output(prefix + "status", station.status);
  if (instrument == Instrument::mounted) {
    builder.export_output(prefix + "force_torque", station.force_torque);
  }
  return record(*builder.build());
}

/// A recorded station alone; its commands are never computed.
struct Replay {
  explicit Replay(const Recording& recording, const std::string& prefix = "") {
    DiagramBuilder builder("replay");
    station = add_recorded_station(builder, recording, prefix);
    builder.export_input("torque_command", station.torque_command);
    builder.export_input("brake", station.brake);
    builder.export_output(prefix + "joints", station.joints);
    builder.export_output(prefix + "drives", station.drives);
    builder.export_output(prefix + "imu", station.imu);
    builder.export_output(prefix + "status", station.status);
    if (station.force_torque) builder.export_output(prefix + "force_torque", *station.force_torque);
    diagram = builder.build();
  }

  Station station;
  std::unique_ptr<Diagram> diagram;
};

void expect_same_bits(const Recording& a, const Recording& b) {
  ASSERT_EQ(a.signals.size(), b.signals.size());
  EXPECT_EQ(a.time_ns, b.time_ns);
  for (const Signal& signal : a.signals) {
    const Signal& other = b.signal(signal.path);
    ASSERT_EQ(signal.rows.size(), other.rows.size()) << signal.path;
    EXPECT_EQ(std::memcmp(signal.rows.data(), other.rows.data(), 8 * signal.rows.size()), 0) << signal.path;
  }
}

std::vector<std::string> problems_of(const Recording& recording) {
  return test::problems_of([&] {
    DiagramBuilder builder("replay");
    add_recorded_station(builder, recording);
  });
}

TEST(RecordedStation, PlaysEveryReadingBitForBit) {
  const Recording recording = original(Instrument::mounted);
  expect_same_bits(record(*Replay(recording).diagram), recording);
}

TEST(RecordedStation, HasAForceTorqueSensorWhereOneWasRecorded) {
  EXPECT_TRUE(Replay(original(Instrument::mounted)).station.force_torque.has_value());
  EXPECT_FALSE(Replay(original(Instrument::missing)).station.force_torque.has_value());
}

TEST(RecordedStation, FindsReadingsUnderTheirPrefix) {
  const Recording recording = original(Instrument::mounted, "bench/");
  expect_same_bits(record(*Replay(recording, "bench/").diagram), recording);
}

TEST(RecordedStation, TellsNothingAfterTheEndOfTheRecording) {
  const Replay replay(original(Instrument::mounted));
  Context context = replay.diagram->make_context();
  context.set_time(ticks * Time(1ms));
  replay.diagram->evaluate(context);
  EXPECT_FALSE(context.get(replay.station.joints).valid);
  EXPECT_FALSE(context.get(replay.station.drives).valid);
  EXPECT_FALSE(context.get(replay.station.imu).valid);
  EXPECT_FALSE(context.get(replay.station.status).valid);
  EXPECT_FALSE(context.get(*replay.station.force_torque).valid);
}

TEST(RecordedStation, NeedsEveryReadingOfTheContract) {
  Recording recording = original(Instrument::missing);
  std::erase_if(recording.signals, [](const Signal& signal) { return signal.path == "drives"; });
  EXPECT_THAT(problems_of(recording), ElementsAre(HasSubstr("'drives'")));
}

TEST(RecordedStation, RefusesReadingsWithOtherFields) {
  Recording recording = original(Instrument::missing);
  for (Signal& signal : recording.signals) {
    if (signal.path == "imu") signal.layout.fields.front().name = "measured";
  }
  EXPECT_THAT(problems_of(recording),
              ElementsAre(HasSubstr("'imu' was recorded without the field 'acquired'")));
}

}  // namespace
}  // namespace flinch
