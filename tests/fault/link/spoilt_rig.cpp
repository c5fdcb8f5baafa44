#include "tests/fault/link/spoilt_rig.h"

#include <limits>

#include "apps/flinch/bus/bus_start.h"
#include "drivers/dds_server.h"
#include "drivers/wire_header.h"
#include "experiments/simulated/simulated_scenario.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/realtime_runner.h"
#include "tests/fault/link/link_trial.h"

namespace flinch::test {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// Between a station's sensors and the bus.
class Spoiler final : public System {
 public:
  explicit Spoiler(const Spoilt& spoilt) : spoilt_(spoilt) {}

  InputPort<JointReading> true_joints = input<JointReading>("true_joints");
  InputPort<DriveReading> true_drives = input<DriveReading>("true_drives");
  InputPort<ImuReading> true_imu = input<ImuReading>("true_imu");
  OutputPort<JointReading> joints = output<&Spoiler::encode>("joints", true_joints);
  OutputPort<DriveReading> drives = output<&Spoiler::measure>("drives", true_drives);
  OutputPort<ImuReading> imu = output<&Spoiler::turn>("imu", true_imu);

 private:
  JointReading encode(const JointReading& healthy) const {
    JointReading reading = healthy;
    if (spoilt_.joints && reading.active.size() > 0) reading.active[0] = no_number;
    return reading;
  }
  DriveReading measure(const DriveReading& healthy) const {
    DriveReading reading = healthy;
    if (spoilt_.currents && reading.current.size() > 0) reading.current[0] = no_number;
    return reading;
  }
  ImuReading turn(const ImuReading& healthy) const {
    ImuReading reading = healthy;
    reading.valid = reading.valid && !spoilt_.imu;
    return reading;
  }

  const Spoilt& spoilt_;
};

}  // namespace

void serve_spoilt_rig(std::uint32_t domain, const Spoilt& spoilt) {
  const SimulatedScenario scenario = read_simulated_scenario(shipped_file("scenarios/square.yaml"));
  DdsServerSettings settings{.robot = robot_hash(scenario.robot_text)};
  SimulatedStationSettings rig = scenario.station;
  rig.drives.longest_silence = settings.longest_silence;

  DiagramBuilder builder("bench");
  PoweredStation station = add_powered_station(builder, add_simulated_station(builder, rig));
  station.torque_command = builder.export_input("torque_command", station.torque_command);
  station.brake = builder.export_input("brake", station.brake);
  station.wish = builder.export_input("wish", station.wish);
  auto& spoiler = builder.add<Spoiler>("spoiler", spoilt);
  builder.connect(station.joints, spoiler.true_joints);
  builder.connect(station.drives, spoiler.true_drives);
  builder.connect(station.imu, spoiler.true_imu);
  station.joints = spoiler.joints;
  station.drives = spoiler.drives;
  station.imu = spoiler.imu;
  const auto diagram = builder.build();

  BusOptions options;
  options.domain = domain;
  const BusSettings bus_is = bus_settings(options, true);
  settings.realtime_priority = bus_is.realtime_priority;
  const DdsBus bus(bus_is);
  DdsServer server(bus, *diagram, station, settings);
  ClockTicks ticks;
  RealtimeRunner runner(*diagram, ticks, server, std::make_unique<SundialsIntegrator>());
  Context context = diagram->make_context();
  const RealtimeThread thread(loop_settings(options));
  runner.run(context);
}

}  // namespace flinch::test
