#include "tests/stations/contract_ends.h"

#include "tests/stations/mock_station.h"
#include "tests/stations/reading_injector.h"

namespace flinch::test {
namespace {

/// Lets the pipeline command, or the test.
class Chooser final : public System {
 public:
  InputPort<Order> order = input<Order>("order");
  InputPort<TorqueCommand> laws = input<TorqueCommand>("laws");
  InputPort<BrakeCommand> gate = input<BrakeCommand>("gate");
  OutputPort<TorqueCommand> torque_command = output<&Chooser::choose>("torque_command", clock, order, laws);
  OutputPort<BrakeCommand> brake = output<&Chooser::brakes>("brake", order, gate);

 private:
  TorqueCommand choose(Time now, const Order& test, const TorqueCommand& pipeline) const {
    if (!test.by_test) return pipeline;
    TorqueCommand command = test.torque;
    command.computed = now - test.age;
    return command;
  }
  BrakeCommand brakes(const Order& test, const BrakeCommand& pipeline) const {
    return test.by_test ? test.brake : pipeline;
  }
};

template <class Reading, Source source>
OutputPort<Reading> inject(DiagramBuilder& builder, const std::string& name, OutputPort<Reading> sensor,
                           std::optional<InputPort<Damage>>& damage) {
  auto& injector = builder.add<ReadingInjector<Reading, source>>(name + "_injector");
  builder.connect(sensor, injector.in);
  if (damage) {
    builder.connect(*damage, injector.damage);
  } else {
    damage = builder.export_input("damage", injector.damage);
  }
  return injector.out;
}

Station add_simulated(DiagramBuilder& builder) {
  SimulatedStationSettings settings;
  settings.rig.robot =
      std::make_shared<const PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::none));
  settings.drives.torque_constant.setConstant(3, contract_torque_constant);
  settings.drives.longest_silence = longest_age;
  return add_simulated_station(builder, settings);
}

/// Settles within 25 ms, waits for late samples, and does nothing about contacts.
ContactControlSettings patient() {
  ContactControlSettings settings;
  settings.momentum_observer.gain = PlatformVector::Constant(3, 200.0);
  settings.drive_torque.torque_constant = JointVector::Constant(3, contract_torque_constant);
  settings.contact_detector.reaction = {1e6, 1e6};
  settings.contact_detector.hard = {1e6, 1e6};
  settings.faults.longest_gap = settings.faults.max_age = longest_age;
  for (Sampling* sampling : {&settings.velocity_filter.sampling, &settings.forward_kinematics.sampling,
                             &settings.momentum_observer.sampling, &settings.drive_torque.sampling}) {
    sampling->longest_hold = longest_age;
  }
  return settings;
}

}  // namespace

std::shared_ptr<const PlanarRrr> contract_robot() {
  static const auto robot =
      std::make_shared<PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::none));
  return robot;
}

RobotEnd add_robot_end(DiagramBuilder& builder, RobotKind kind) {
  Station station = kind == RobotKind::simulated
                        ? add_simulated(builder)
                        : add_mock_station(builder, contract_robot(),
                                           JointVector::Constant(3, contract_torque_constant), longest_age);
  std::optional<InputPort<Damage>> damage;
  station.joints = inject<JointReading, Source::joints>(builder, "joints", station.joints, damage);
  station.drives = inject<DriveReading, Source::drives>(builder, "drives", station.drives, damage);
  station.imu = inject<ImuReading, Source::imu>(builder, "imu", station.imu, damage);
  station.status = inject<StationStatus, Source::status>(builder, "status", station.status, damage);
  return {station, *damage};
}

ControlEnd add_control_end(DiagramBuilder& builder, const Station& station) {
  const ContactControl control = add_contact_control(builder, contract_robot(), patient());
  builder.export_input("operator", control.operator_command);
  builder.export_input("tick_timing", control.tick_timing);
  auto& chooser = builder.add<Chooser>("chooser");
  builder.connect(station.joints, control.joints);
  builder.connect(station.drives, control.drives);
  builder.connect(station.status, control.status);
  builder.connect(control.torque_command, chooser.laws);
  builder.connect(control.brake, chooser.gate);
  builder.connect(chooser.torque_command, station.torque_command);
  builder.connect(chooser.brake, station.brake);
  return {station, control, builder.export_input("order", chooser.order)};
}

Moment ControlEnd::see(const Context& context, Time now) const {
  return {.now = now,
          .joints = context.get(station.joints),
          .drives = context.get(station.drives),
          .imu = context.get(station.imu),
          .status = context.get(station.status),
          .faults = context.get(control.faults).present,
          .gate = context.get(control.gate)};
}

}  // namespace flinch::test
