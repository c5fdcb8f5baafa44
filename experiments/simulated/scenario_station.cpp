#include "experiments/simulated/scenario_station.h"

#include <span>
#include <string>

#include "experiments/scenario/scenario.h"
#include "plant/simulated_station.h"
#include "systems/config/config_reader.h"
#include "systems/robot/planar_rrr.h"

namespace flinch {
namespace {

std::span<double> entries(Eigen::Vector3d& vector) { return {vector.data(), 3}; }

void read_material(ConfigReader& reader, ContactMaterial& material) {
  reader.number("stiffness", unit::N_per_m, material.stiffness, positive);
  reader.number("restitution", unit::none, material.restitution,
                {.low = 0.0, .high = 1.0, .low_included = false});
  reader.number("restitution_speed", unit::m_per_s, material.restitution_speed, positive);
  reader.number("friction", unit::none, material.friction, not_negative);
}

/// What only a simulation needs to know of the pylon: how it gives way.
Pylon read_pylon(ConfigReader reader, const ScenarioObstacle& obstacle) {
  Pylon pylon;
  pylon.position_in_base = obstacle.position_in_base;
  pylon.radius = obstacle.radius;
  read_material(reader, pylon.material);
  reader.choice("mounting", pylon.mounting,
                {{"fixed", Pylon::Mounting::fixed}, {"compliant", Pylon::Mounting::compliant}});
  reader.number("mass", unit::kg, pylon.mass, positive);
  reader.number("mount_stiffness", unit::N_per_m, pylon.mount_stiffness, positive);
  reader.number("mount_damping", unit::Ns_per_m, pylon.mount_damping, not_negative);
  return pylon;
}

enum class PlantFriction { as_robot_file, none };

/// What is true of the robot, where that differs from what the controller believes.
void read_plant(ConfigReader plant, SimulatedStationSettings& station) {
  PlantFriction friction = PlantFriction::as_robot_file;
  double mass_scale = 1.0, payload = 0.0;
  plant.choice("friction", friction,
               {{"as_robot_file", PlantFriction::as_robot_file}, {"none", PlantFriction::none}});
  plant.number("leg_inertia_scale", unit::none, mass_scale, positive);
  plant.number("payload", unit::kg, payload, not_negative);
  plant.numbers("torque_constant", unit::Nm_per_A, entries(station.drives.torque_constant), positive);
  plant.numbers("driver_torque_constant", unit::Nm_per_A, entries(station.drives.driver_torque_constant),
                positive);

  PlanarRrrParameters& robot = station.bench.robot;
  robot.platform_mass += payload;
  for (PlanarRrrLeg& leg : robot.legs) {
    leg.inertia = {leg.inertia.p1 * mass_scale, leg.inertia.p2 * mass_scale, leg.inertia.p3 * mass_scale};
    if (friction == PlantFriction::none) leg.active_friction = leg.passive_friction = {};
  }
  if (plant.has("initial_pose")) {
    Eigen::Vector3d pose = Eigen::Vector3d::Zero();
    ConfigReader initial = plant.section("initial_pose");
    initial.number("x", unit::m, pose[0]);
    initial.number("y", unit::m, pose[1]);
    initial.number("phi", unit::rad, pose[2]);
    station.bench.initial_pose = pose;
  }
}

void read_encoder(ConfigReader reader, EncoderErrors& errors) {
  reader.number("accuracy", unit::rad, errors.accuracy, not_negative);
  reader.number("noise", unit::rad, errors.noise, not_negative);
  reader.number("resolution", unit::rad, errors.resolution, not_negative);
}

void read_imu(ConfigReader reader, SimulatedImuSettings& imu) {
  reader.flag("ideal", imu.ideal);
  reader.numbers("position", unit::m, entries(imu.position_in_platform));
  reader.numbers("angles", unit::rad, entries(imu.angles));
  reader.number("accelerometer_density", unit::m_per_s2_per_sqrt_Hz, imu.accelerometer_density, not_negative);
  reader.number("gyroscope_density", unit::rad_per_s_per_sqrt_Hz, imu.gyroscope_density, not_negative);
  reader.number("accelerometer_bias", unit::m_per_s2, imu.accelerometer_bias, not_negative);
  reader.number("gyroscope_bias", unit::rad_per_s, imu.gyroscope_bias, not_negative);
  reader.duration("delay", imu.delay, not_negative);
}

void read_force_torque(ConfigReader reader, SimulatedForceTorqueSettings& sensor) {
  reader.flag("ideal", sensor.ideal);
  reader.number("force_noise", unit::N, sensor.force_noise, not_negative);
  reader.number("moment_noise", unit::Nm, sensor.moment_noise, not_negative);
  reader.duration("delay", sensor.delay, not_negative);
}

void read_sensors(ConfigReader sensors, SimulatedStationSettings& station) {
  bool ideal = false;
  sensors.flag("ideal", ideal);
  if (ideal) station = with_ideal_sensors(std::move(station));

  ConfigReader encoders = sensors.section("encoders");
  encoders.flag("ideal", station.encoders.ideal);
  encoders.flag("passive_mounted", station.encoders.passive_mounted);
  read_encoder(encoders.section("active"), station.encoders.active);
  read_encoder(encoders.section("passive"), station.encoders.passive);

  ConfigReader currents = sensors.section("currents");
  currents.flag("ideal", station.currents.ideal);
  currents.number("noise", unit::A, station.currents.noise, not_negative);
  currents.number("resolution", unit::A, station.currents.resolution, not_negative);

  read_imu(sensors.section("imu"), station.imu);
  read_force_torque(sensors.section("force_torque"), *station.force_torque);
}

WrenchRamp read_ramp(ConfigReader reader) {
  WrenchRamp ramp;
  reader.number("force_x", unit::N, ramp.peak_in_base[0]);
  reader.number("force_y", unit::N, ramp.peak_in_base[1]);
  reader.number("moment", unit::Nm, ramp.peak_in_base[2]);
  reader.duration("start", ramp.start, not_negative);
  reader.duration("rise", ramp.rise, not_negative);
  reader.duration("hold", ramp.hold, not_negative);
  reader.duration("fall", ramp.fall, not_negative);
  return ramp;
}

}  // namespace

void read_station(ConfigReader& file, const Scenario& scenario, SimulatedStationSettings& station) {
  const auto* const robot = dynamic_cast<const PlanarRrr*>(scenario.robot.robot.get());
  if (robot == nullptr) {
    leave_simulation_unread(file, scenario);
    file.problem("robot", "is of a kind that cannot be simulated; only planar_3rrr can");
    return;
  }
  station.seed = scenario.seed;
  station.bench.robot = robot->parameters();
  const std::optional<PlatformPath>& path = scenario.control.trajectory.path;
  if (path) station.bench.initial_pose = path->start();
  for (const ScenarioObstacle& obstacle : scenario.obstacles)
    station.bench.pylon = read_pylon(file.section(obstacle.name), obstacle);
  read_plant(file.section("plant"), station);
  for (ConfigReader& ramp : file.sections("applied_wrench"))
    station.applied_wrench.push_back(read_ramp(ramp));
  read_sensors(file.section("sensors"), station);
  for (const std::string& complaint : problems(station.bench)) file.add_problems({"plant: " + complaint});
  for (const std::string& complaint : problems(station.imu)) file.add_problems({"sensors.imu: " + complaint});
}

}  // namespace flinch
