#include "plant/simulated_instrument.h"

#include <cstddef>
#include <utility>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/rotation.h"

namespace flinch {
namespace {

Eigen::Vector3d in_space(const CartesianVector& v) {
  Eigen::Vector3d full = Eigen::Vector3d::Zero();
  full.head(v.size()) = v;
  return full;
}

/// A robot in a plane has its instrument turned about the normal only.
Eigen::Vector3d draw_turn(RandomGenerator& random, double limit, const Mechanism& robot) {
  const Eigen::Vector3d turn = uniform_vector(random, limit);
  if (robot.space_dimension() == 3) return turn;
  return Eigen::Vector3d(0.0, 0.0, turn.z());
}

Eigen::Vector3d draw_offset(double limit, std::uint64_t seed) {
  RandomGenerator random(seed);
  return uniform_vector(random, limit);
}

}  // namespace

std::vector<std::string> problems(const SimulatedInstrumentSettings& settings, const Mechanism& robot) {
  Findings found("instrument.");
  found.not_negative("force_noise", settings.force_noise, "N");
  found.not_negative("moment_noise", settings.moment_noise, "Nm");
  found.not_negative("misalignment", settings.misalignment, "rad");
  found.not_negative("zero_offset", settings.zero_offset, "N");
  for (std::size_t i = 0; i < settings.mountings.size(); ++i) {
    const InstrumentMounting& mounting = settings.mountings[i];
    found.require(mounting.body >= 0 && mounting.body < robot.body_count(),
                  "mountings[" + std::to_string(i) + "].body is none of the robot");
    found.require(i == 0 || settings.mountings[i - 1].start <= mounting.start,
                  "mountings[" + std::to_string(i) + "] begins before the one in front of it");
  }
  return found.take();
}

SimulatedInstrument::SimulatedInstrument(const SimulatedInstrumentSettings& settings,
                                         std::vector<RopePull> pulls, std::shared_ptr<const Mechanism> robot,
                                         std::uint64_t seed)
    : settings_(settings),
      pulls_(std::move(pulls)),
      robot_(std::move(robot)),
      zero_offset_(draw_offset(settings.zero_offset, derive_seed(seed, "zero offset"))),
      noise_(state<NormalNumbers<6>>("noise", NormalNumbers<6>(6, derive_seed(seed, "noise")))) {
  throw_if_any(problems(settings_, *robot_));
  RandomGenerator random(derive_seed(seed, "misalignment"));
  for (std::size_t i = 0; i < settings_.mountings.size(); ++i) {
    misalignments_.push_back(draw_turn(random, settings_.misalignment, *robot_));
  }
}

Eigen::Matrix3d SimulatedInstrument::axes_of(int body, const PlantTruth& robot) const {
  Kinematics kinematics;
  robot_->kinematics(robot.pose, robot.velocity, kinematics);
  const BodyId id = BodyId::from_index(body);
  const int directions = robot_->space_dimension();
  const auto place = [&](const Eigen::Vector3d& point) {
    return in_space(robot_->point_on_body(kinematics, id, point.head(directions)));
  };
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  const Eigen::Vector3d origin = place(Eigen::Vector3d::Zero());
  for (int i = 0; i < directions; ++i) axes.col(i) = place(Eigen::Vector3d::Unit(i)) - origin;
  return axes;
}

void SimulatedInstrument::measure(Time now, const PlantTruth& robot, const NormalNumbers<6>& noise,
                                  ForceTorqueReading& reading) const {
  reading = ForceTorqueReading();
  reading.acquired = now;
  std::size_t mounted = settings_.mountings.size();  // none
  for (std::size_t i = 0; i < settings_.mountings.size(); ++i) {
    if (settings_.mountings[i].start <= now) mounted = i;
  }
  reading.valid = robot.valid && mounted < settings_.mountings.size();
  if (!reading.valid) return;
  const int body = settings_.mountings[mounted].body;
  for (const RopePull& pull : pulls_) {
    if (pull.body == body) reading.force_in_base += pull.at(to_seconds(now));
  }
  if (settings_.ideal) return;

  const Eigen::Matrix3d axes = axes_of(body, robot);
  const Eigen::Matrix3d turned = rotation_matrix(quaternion_exp(misalignments_[mounted]));
  const Eigen::Vector3d measured = turned.transpose() * axes.transpose() * reading.force_in_base +
                                   zero_offset_ + settings_.force_noise * noise.values().head<3>();
  reading.force_in_base = axes * measured;
  reading.moment_in_base = axes * (settings_.moment_noise * noise.values().tail<3>());
}

}  // namespace flinch
