#include "plant/perturbed_robot.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "systems/framework/random.h"

namespace flinch {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;

/// Draws quantities by their names; nothing of one whose size is zero.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : seed_(seed) {}

  JointVector between(std::string_view quantity, double low, double high, int count) const {
    RandomGenerator generator(derive_seed(seed_, quantity));
    JointVector drawn(count);
    for (int i = 0; i < count; ++i) drawn[i] = generator.uniform(low, high);
    return drawn;
  }
  /// From a twentieth of `size` to it, as likely in each octave.
  JointVector within_twenty(std::string_view quantity, double size, int count) const {
    if (!(size > 0.0)) return {};
    return size * between(quantity, -std::log(20.0), 0.0, count).array().exp();
  }
  JointVector either_way(std::string_view quantity, double size, int count) const {
    return size > 0.0 ? between(quantity, -size, size, count) : JointVector();
  }
  JointVector up_to(std::string_view quantity, double size, int count) const {
    return size > 0.0 ? between(quantity, 0.0, size, count) : JointVector();
  }
  /// Factors about 1.
  JointVector scale(std::string_view quantity, double size, int count) const {
    JointVector drawn = either_way(quantity, size, count);
    drawn.array() += 1.0;
    return drawn;
  }
  std::vector<PositionHarmonic> waves(const std::string& quantity, double size, double rate,
                                      int count) const {
    std::vector<PositionHarmonic> drawn;
    if (!(size > 0.0)) return drawn;
    const JointVector amplitude = up_to(quantity, size, count);
    const JointVector phase = between(quantity + " phase", 0.0, turn, count);
    for (int i = 0; i < count; ++i) drawn.push_back({amplitude[i], rate, phase[i]});
    return drawn;
  }

 private:
  std::uint64_t seed_;
};

RobotDeviation draw_mechanics(const Realism& realism, const ParallelRobot& robot, const Draw& draw) {
  RobotDeviation drawn;
  drawn.drive_friction_scale = draw.scale("drive friction", realism.friction, robot.drives());
  drawn.passive_friction_scale = draw.scale("passive friction", realism.friction, robot.legs());
  drawn.leg_inertia_scale = draw.scale("leg inertia", realism.leg_inertia, robot.legs());
  if (realism.platform_inertia > 0.0) {
    drawn.platform_inertia_scale = draw.scale("platform inertia", realism.platform_inertia, 1)[0];
  }
  if (realism.payload > 0.0) drawn.payload = draw.up_to("payload", realism.payload, 1)[0];
  return drawn;
}

ElasticDrivesSettings draw_elastic(const Realism& realism, int drives, const Draw& draw) {
  if (!(realism.drive_stiffness > 0.0)) return {};
  ElasticDrivesSettings drawn{
      .stiffness = realism.drive_stiffness * draw.between("drive stiffness", 1.0, 2.0, drives),
      .backlash = draw.up_to("backlash", realism.backlash, drives),
      .damping_ratio = realism.drive_damping};
  if (realism.rotor_inertia > 0.0) drawn.rotor_inertia.setConstant(drives, realism.rotor_inertia);
  return drawn;
}

std::vector<TorqueRipple> draw_torque(const Realism& realism, double largest_torque, double rate, int drives,
                                      const Draw& draw) {
  const auto ripple =
      draw.waves("torque ripple", realism.torque_ripple, rate * realism.torque_ripple_periods, drives);
  if (!(realism.cogging > 0.0) && ripple.empty()) return {};
  std::vector<TorqueRipple> drawn(static_cast<std::size_t>(drives));
  for (int k = 1; k <= realism.cogging_harmonics; ++k) {
    const auto harmonic =
        draw.waves(k == 1 ? "cogging" : "cogging " + std::to_string(k), realism.cogging * largest_torque / k,
                   rate * k * realism.cogging_periods, drives);
    for (std::size_t i = 0; i < harmonic.size(); ++i) drawn[i].cogging.push_back(harmonic[i]);
  }
  for (std::size_t i = 0; i < ripple.size(); ++i) drawn[i].ripple = ripple[i];
  return drawn;
}

std::vector<double> list(const JointVector& values) { return {values.begin(), values.end()}; }

using Values = std::vector<std::pair<std::string, std::vector<double>>>;

/// Collects what is not empty.
class Told {
 public:
  void add(const std::string& key, const std::vector<double>& values) {
    if (!values.empty()) values_.emplace_back(key, values);
  }
  void add(const std::string& key, const std::string& unit, const std::vector<PositionHarmonic>& waves) {
    std::vector<double> amplitudes, phases;
    bool any = false;
    for (const PositionHarmonic& wave : waves) {
      amplitudes.push_back(wave.amplitude);
      phases.push_back(wave.phase);
      any = any || wave.amplitude != 0.0;
    }
    if (!any) return;
    add(key + unit, amplitudes);
    add(key + "_phase_rad", phases);
  }
  Values take() { return std::move(values_); }

 private:
  Values values_;
};

std::vector<PositionHarmonic> ripple_of(const std::vector<TorqueRipple>& torques) {
  std::vector<PositionHarmonic> waves;
  for (const TorqueRipple& torque : torques) waves.push_back(torque.ripple);
  return waves;
}

/// The k-th wave of each drive; empty: no drive has so many.
std::vector<PositionHarmonic> cogging_of(const std::vector<TorqueRipple>& torques, std::size_t k) {
  std::vector<PositionHarmonic> waves;
  for (const TorqueRipple& torque : torques)
    if (k < torque.cogging.size()) waves.push_back(torque.cogging[k]);
  return waves;
}

}  // namespace

PerturbedRobot draw_perturbed_robot(const Realism& realism, const ParallelRobot& robot, double largest_torque,
                                    std::uint64_t seed) {
  const Draw draw(derive_seed(seed, "specimen"));
  const int drives = robot.drives();
  const double rate = robot.drive_kind(0) == DriveKind::revolute ? 1.0 : turn / realism.screw_lead;
  PerturbedRobot drawn;
  drawn.mechanics = draw_mechanics(realism, robot, draw);
  drawn.friction_stiffness = draw.within_twenty("friction stiffness", realism.friction_stiffness, drives);
  drawn.elastic = draw_elastic(realism, drives, draw);
  drawn.torque_constant_scale = draw.scale("torque constant", realism.torque_constant, drives);
  drawn.current_lag = draw.up_to("current lag", realism.current_lag, drives);
  drawn.torque_ripple = draw_torque(realism, largest_torque, rate, drives, draw);
  drawn.active_encoder_wave = draw.waves("active encoder", realism.active_encoder_wave, rate, drives);
  const int passive = robot.passive_joints();
  drawn.passive_encoder_wave = draw.waves("passive encoder", realism.passive_encoder_wave, 1.0, passive);
  drawn.passive_encoder_offset =
      draw.either_way("passive encoder offset", realism.passive_encoder_offset, passive);
  return drawn;
}

SimulatedStationSettings with_perturbed_robot(SimulatedStationSettings model,
                                              const PerturbedRobot& perturbed_robot) {
  SimulatedDrivesSettings& drives = model.drives;
  model.rig.robot = true_robot(model.rig.robot, perturbed_robot.mechanics);
  model.rig.sticking.stiffness = perturbed_robot.friction_stiffness;
  model.rig.elastic = perturbed_robot.elastic;
  const std::vector<TorqueRipple> known =
      std::exchange(model.rig.torque_ripple, perturbed_robot.torque_ripple);
  model.rig.torque_ripple.resize(std::max(known.size(), perturbed_robot.torque_ripple.size()));
  for (std::size_t i = 0; i < known.size(); ++i) model.rig.torque_ripple[i].cogging = known[i].cogging;
  if (drives.torque_delay.size() == 0) drives.current_lag = perturbed_robot.current_lag;
  if (perturbed_robot.torque_constant_scale.size() > 0) {
    drives = complete(drives, *model.rig.robot);
    drives.torque_constant = drives.torque_constant.cwiseProduct(perturbed_robot.torque_constant_scale);
  }
  model.encoders.active.wave = perturbed_robot.active_encoder_wave;
  model.encoders.passive.wave = perturbed_robot.passive_encoder_wave;
  if (perturbed_robot.passive_encoder_offset.size() > 0) {
    model.encoders.passive.accuracy = 0.0;
    model.encoders.passive.offset = perturbed_robot.passive_encoder_offset;
  }
  return model;
}

Values perturbed_robot_values(const PerturbedRobot& perturbed_robot, const Mechanism& robot) {
  const bool turns = robot.drive_kind(0) == DriveKind::revolute;
  const RobotDeviation& mechanics = perturbed_robot.mechanics;
  Told told;
  told.add("drive_friction_scale", list(mechanics.drive_friction_scale));
  told.add(turns ? "friction_stiffness_Nm_per_rad" : "friction_stiffness_N_per_m",
           list(perturbed_robot.friction_stiffness));
  told.add(turns ? "drive_stiffness_Nm_per_rad" : "drive_stiffness_N_per_m",
           list(perturbed_robot.elastic.stiffness));
  told.add(turns ? "backlash_rad" : "backlash_m", list(perturbed_robot.elastic.backlash));
  told.add("passive_friction_scale", list(mechanics.passive_friction_scale));
  told.add("leg_inertia_scale", list(mechanics.leg_inertia_scale));
  if (mechanics.platform_inertia_scale != 1.0)
    told.add("platform_inertia_scale", {mechanics.platform_inertia_scale});
  if (mechanics.payload > 0.0) told.add("payload_kg", {mechanics.payload});
  told.add(turns ? "torque_constant_scale" : "force_constant_scale",
           list(perturbed_robot.torque_constant_scale));
  for (std::size_t k = 0; !cogging_of(perturbed_robot.torque_ripple, k).empty(); ++k) {
    told.add(k == 0 ? "cogging" : "cogging" + std::to_string(k + 1), turns ? "_Nm" : "_N",
             cogging_of(perturbed_robot.torque_ripple, k));
  }
  told.add("torque_ripple", "", ripple_of(perturbed_robot.torque_ripple));
  told.add("current_lag_s", list(perturbed_robot.current_lag));
  told.add("active_encoder_wave", turns ? "_rad" : "_m", perturbed_robot.active_encoder_wave);
  told.add("passive_encoder_wave", "_rad", perturbed_robot.passive_encoder_wave);
  told.add("passive_encoder_offset_rad", list(perturbed_robot.passive_encoder_offset));
  return told.take();
}

}  // namespace flinch
