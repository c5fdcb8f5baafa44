#include "experiments/simulated/scenario_station.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "experiments/scenario/scenario.h"
#include "experiments/scenario/scenario_pose.h"
#include "experiments/simulated/scenario_faults.h"
#include "experiments/simulated/scenario_realism.h"
#include "experiments/simulated/simulated_obstacles.h"
#include "plant/contacts_at_start.h"
#include "plant/delay_line.h"
#include "plant/perturbed_robot.h"
#include "plant/simulated_station.h"
#include "systems/config/config_reader.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/leg_bases.h"
#include "systems/robot/parallel_robot.h"
#include "systems/robot/robot_deviation.h"
#include "systems/signals/contact_classes.h"

namespace flinch {
namespace {

template <class Vector>
std::span<double> entries(Vector& vector) {
  return {vector.data(), static_cast<std::size_t>(vector.size())};
}

/// Times below `limit` that stay below it when they are rounded to nanoseconds.
Range shorter_than(Time limit) {
  return {.low = 0.0, .high = to_seconds(limit) - 0.5e-9, .high_included = false};
}

enum class PlantFriction { as_robot_file, none };

/// "controller", where it finds out by itself; "truth"; or the class that the experiment is made for.
void read_classification(ConfigReader& plant, const ParallelRobot& robot, std::string& told) {
  std::string by = "controller";
  plant.text("classification", by);
  std::vector<std::string> known = {"controller", "truth"};
  const ContactClasses classes(robot.body_count(), robot.legs());
  for (int i = 0; i < classes.count(); ++i) known.push_back(classes.name(i));
  if (std::find(known.begin(), known.end(), by) == known.end()) {
    plant.problem("classification", "is '" + by + "'; it must be controller, truth, or a class of contact" +
                                        did_you_mean(by, known));
  }
  told = by == "controller" ? "" : by;
}

/// Factors on the model, one for each drive or leg.
void read_scales(ConfigReader& plant, const char* name, int count, JointVector& scales) {
  scales.setOnes(count);
  plant.numbers(name, unit::none, entries(scales), not_negative);
}

/// Of motors that cog as the robot file says.
std::vector<TorqueRipple> torque_ripple(const Cogging& cogging) {
  std::vector<TorqueRipple> drives;
  for (const CoggingWave& wave : cogging.waves) {
    drives.resize(static_cast<std::size_t>(wave.sine.size()));
    for (Eigen::Index i = 0; i < wave.sine.size(); ++i) {
      drives[static_cast<std::size_t>(i)].cogging.push_back(
          {.amplitude = std::hypot(wave.sine[i], wave.cosine[i]),
           .rate = 2.0 * std::numbers::pi / wave.wavelength[i],
           .phase = std::atan2(wave.cosine[i], wave.sine[i])});
    }
  }
  return drives;
}

/// What is true of the robot, where that differs from what the controller believes; how far one that is drawn
/// may be off that.
Realism read_plant(ConfigReader plant, const Scenario& scenario, SimulatedStationSettings& station) {
  const RobotFile& built = scenario.robot_as_built;  // calibrations change what is believed, not what is true
  const int drives = built.robot->drives();
  PlantFriction friction = PlantFriction::as_robot_file;
  double mass_scale = 1.0;
  RobotDeviation deviation;
  station.rig.torque_ripple = torque_ripple(built.drives.cogging);
  station.drives.torque_delay = built.drives.torque_delay;
  station.drives.torque_constant = built.drives.torque_constant;
  station.drives.max_torque.setConstant(drives, built.drives.max_torque);
  station.drives.driver_torque_constant = scenario.robot.drives.torque_constant;
  plant.choice("friction", friction,
               {{"as_robot_file", PlantFriction::as_robot_file}, {"none", PlantFriction::none}});
  read_classification(plant, *built.robot, station.told_contact);
  read_scales(plant, "drive_friction_scale", drives, deviation.drive_friction_scale);
  read_scales(plant, "passive_friction_scale", built.robot->legs(), deviation.passive_friction_scale);
  plant.number("leg_inertia_scale", unit::none, mass_scale, positive);
  plant.number("payload", unit::kg, deviation.payload, not_negative);
  const Unit& per_ampere = built.robot->drive_kind(0) == DriveKind::revolute ? unit::Nm_per_A : unit::N_per_A;
  plant.numbers("torque_constant", per_ampere, entries(station.drives.torque_constant), positive);
  plant.numbers("driver_torque_constant", per_ampere, entries(station.drives.driver_torque_constant),
                positive);

  deviation.leg_inertia_scale.setConstant(built.robot->legs(), mass_scale);
  if (friction == PlantFriction::none) {
    deviation.drive_friction_scale.setZero();
    deviation.passive_friction_scale.setZero();
  }
  station.rig.robot = true_robot(built.robot, deviation);
  if (plant.has("initial_pose"))
    station.rig.initial_pose = read_pose_in_reach(plant, "initial_pose", *built.robot);
  return read_realism(plant, *built.robot);
}

void read_encoder(ConfigReader reader, const Unit& unit, EncoderErrors& errors) {
  reader.number("accuracy", unit, errors.accuracy, not_negative);
  reader.number("noise", unit, errors.noise, not_negative);
  reader.number("resolution", unit, errors.resolution, not_negative);
}

/// What a sensor that measures every `period` can still hold back.
template <class Reading>
Range deliverable(Time period) {
  return shorter_than(DelayLine<Reading>::longest_delay * period);
}

void read_clock(ConfigReader& reader, ImuClockSettings& clock) {
  double rate = 1.0 / to_seconds(clock.period);
  reader.number("rate", unit::Hz, rate, between(100.0, 4000.0));
  clock.period = from_seconds(1.0 / rate);
  reader.duration("before_tick", clock.before_tick, shorter_than(clock.period));
  reader.duration("jitter", clock.jitter, shorter_than(clock.period / 2));
  reader.duration("delay_jitter", clock.delay_jitter, between(0.0, 4e-3));
  reader.duration("stamp_jitter", clock.stamp_jitter, shorter_than(clock.period / 2 - clock.jitter));
}

void read_imu(ConfigReader reader, SimulatedImuSettings& imu) {
  reader.flag("ideal", imu.ideal);
  reader.numbers("position", unit::m, entries(imu.position_in_platform));
  reader.numbers("angles", unit::rad, entries(imu.angles));
  reader.number("accelerometer_density", unit::m_per_s2_per_sqrt_Hz, imu.accelerometer_density, not_negative);
  reader.number("gyroscope_density", unit::rad_per_s_per_sqrt_Hz, imu.gyroscope_density, not_negative);
  reader.number("accelerometer_bias", unit::m_per_s2, imu.accelerometer_bias, not_negative);
  reader.number("gyroscope_bias", unit::rad_per_s, imu.gyroscope_bias, not_negative);
  read_clock(reader, imu.clock);
  reader.duration("delay", imu.delay, deliverable<ImuReading>(imu.clock.period));
}

void read_force_torque(ConfigReader reader, SimulatedForceTorqueSettings& sensor) {
  reader.flag("ideal", sensor.ideal);
  reader.number("force_noise", unit::N, sensor.force_noise, not_negative);
  reader.number("moment_noise", unit::Nm, sensor.moment_noise, not_negative);
  reader.duration("delay", sensor.delay, deliverable<ForceTorqueReading>(sensor.period));
}

void read_instrument(ConfigReader reader, SimulatedInstrumentSettings& instrument) {
  reader.flag("ideal", instrument.ideal);
  reader.number("force_noise", unit::N, instrument.force_noise, not_negative);
  reader.number("moment_noise", unit::Nm, instrument.moment_noise, not_negative);
  reader.number("misalignment", unit::rad, instrument.misalignment, not_negative);
  reader.number("zero_offset", unit::N, instrument.zero_offset, not_negative);
}

/// The pulls at one mounting, one after the other once the rope is no longer slack.
void read_pulls(ConfigReader& reader, const InstrumentMounting& mounting, int directions,
                std::vector<RopePull>& pulls) {
  static constexpr std::array axes = {"force_x", "force_y", "force_z"};
  RopePull pull{.body = mounting.body, .point_in_body = mounting.position_in_body};
  reader.duration("rise", pull.rise, between(0.01, 60.0));
  reader.duration("hold", pull.hold, between(0.0, 60.0));
  reader.duration("fall", pull.fall, between(0.01, 60.0));
  std::vector<double> first;
  reader.required().numbers(axes[0], unit::N, first);
  std::vector<Eigen::Vector3d> peaks(first.size(), Eigen::Vector3d::Zero());
  for (int i = 0; i < directions; ++i) {
    std::vector<double> forces(first.size());
    reader.required().numbers(axes[static_cast<std::size_t>(i)], unit::N, std::span<double>(forces));
    for (std::size_t k = 0; k < forces.size(); ++k) peaks[k][i] = forces[k];
  }
  Time start = mounting.start + mounting.slack;
  for (const Eigen::Vector3d& peak : peaks) {
    pull.peak_in_base = peak;
    pull.start = start;
    pulls.push_back(pull);
    start += pull.rise + pull.hold + pull.fall;
  }
}

void read_sensors(ConfigReader sensors, const ParallelRobot& robot, SimulatedStationSettings& station) {
  bool ideal = false;
  sensors.flag("ideal", ideal);
  if (ideal) station = with_ideal_sensors(std::move(station));

  ConfigReader encoders = sensors.section("encoders");
  encoders.flag("ideal", station.encoders.ideal);
  encoders.flag("passive_mounted", station.encoders.passive_mounted);
  const bool slides = robot.drive_kind(0) == DriveKind::prismatic;
  if (slides) station.encoders.active = sliding_encoders();
  read_encoder(encoders.section("active"), slides ? unit::m : unit::rad, station.encoders.active);
  read_encoder(encoders.section("passive"), unit::rad, station.encoders.passive);

  ConfigReader currents = sensors.section("currents");
  currents.flag("ideal", station.currents.ideal);
  currents.number("noise", unit::A, station.currents.noise, not_negative);
  currents.number("resolution", unit::A, station.currents.resolution, not_negative);

  read_imu(sensors.section("imu"), station.imu);
  read_force_torque(sensors.section("force_torque"), *station.force_torque);
  read_instrument(sensors.section("instrument"), station.instrument);
  if (!station.base_forces) return;
  ConfigReader bases = sensors.section("base_forces");
  bases.flag("ideal", station.base_forces->ideal);
  bases.number("noise", unit::N, station.base_forces->noise, not_negative);
}

WrenchRamp read_ramp(ConfigReader reader, const ConfigurationSpace& space) {
  WrenchRamp ramp;
  ramp.peak_in_base.setZero(space.dimension());
  static constexpr std::array forces = {"force_x", "force_y", "force_z"};
  static constexpr std::array moments = {"moment_x", "moment_y", "moment_z"};
  const int directions = space.translations();
  for (int i = 0; i < directions; ++i) {
    reader.number(forces[static_cast<std::size_t>(i)], unit::N, ramp.peak_in_base[i]);
  }
  if (space.rotations() == 1) reader.number("moment", unit::Nm, ramp.peak_in_base[directions]);
  for (int i = 0; space.rotations() > 1 && i < space.rotations(); ++i) {
    reader.number(moments[static_cast<std::size_t>(i)], unit::Nm, ramp.peak_in_base[directions + i]);
  }
  reader.duration("start", ramp.start, not_negative);
  reader.duration("rise", ramp.rise, not_negative);
  reader.duration("hold", ramp.hold, not_negative);
  reader.duration("fall", ramp.fall, not_negative);
  return ramp;
}

/// Sensors below the base joints of the robot that stands there.
void add_bases(ConfigReader& file, const Scenario& scenario, const BaseForceSettings& settings,
               SimulatedStationSettings& station) {
  try {
    station.base_forces->bases = leg_bases(station.rig.robot, settings.first_moment, *scenario.robot.robot);
  } catch (const SetupError& error) {
    file.section("control")
        .section("isolation")
        .problem("base_forces", "does not fit: " + std::string(error.what()));
  }
}

}  // namespace

void read_station(ConfigReader& file, const Scenario& scenario, SimulatedStationSettings& station,
                  PerturbedRobot& perturbed_robot) {
  station.seed = scenario.seed;
  know_period(scenario.control_period, station);
  const std::optional<PlatformPath>& path = scenario.control.trajectory.path;
  if (path) station.rig.initial_pose = path->start();
  station.rig.obstacles = read_simulated_obstacles(file, scenario.obstacles);
  const Realism realism = read_plant(file.section("plant"), scenario, station);
  for (ConfigReader& ramp : file.sections("applied_wrench"))
    station.applied_wrench.push_back(read_ramp(ramp, station.rig.robot->space()));
  std::size_t mounting = 0;
  for (ConfigReader& pulls : file.sections("pulls")) {
    read_pulls(pulls, scenario.mountings[mounting++], scenario.robot.robot->space_dimension(),
               station.rig.pulls);
  }
  station.instrument.mountings = scenario.mountings;
  const std::optional<BaseForceSettings>& base_forces = scenario.control.isolation.base_forces;
  if (base_forces) station.base_forces.emplace();
  read_sensors(file.section("sensors"), *scenario.robot.robot, station);
  station.faults = read_faults(file, *scenario.robot.robot);
  perturbed_robot = draw_perturbed_robot(realism, *scenario.robot.robot, scenario.robot.drives.max_torque,
                                         realism.seed.value_or(scenario.seed));
  station = with_perturbed_robot(std::move(station), perturbed_robot);
  if (base_forces) add_bases(file, scenario, *base_forces, station);
  if (file.good()) {
    for (const ContactAtStart& contact : contacts_at_start(station.rig))
      file.problem(scenario.obstacles[contact.obstacle].key, contact.complaint);
  }
}

}  // namespace flinch
