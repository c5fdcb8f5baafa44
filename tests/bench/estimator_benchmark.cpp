// What each wrench estimator costs in a tick, with all blocks that it brings, and as a multiple of the
// momentum observer.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "diagrams/acceleration_stages.h"
#include "diagrams/contact_control_settings.h"
#include "diagrams/estimator_stages.h"
#include "diagrams/shared_parts.h"
#include "systems/framework/constant.h"
#include "systems/robot/imu_output.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/support/smooth_trajectory.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

std::shared_ptr<const PlanarRrr> bench() {
  static const auto robot =
      std::make_shared<PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::test_rig));
  return robot;
}

/// What estimators read of one instant.
struct Instant {
  JointReading joints;
  DriveReading drives;
  DriveTorque torque;
  PlatformMotion platform;
  ImuReading imu;
};

/// Ten seconds of the smooth trajectory, which then repeat.
const std::vector<Instant>& instants() {
  static const std::vector<Instant> all = [] {
    std::vector<Instant> made(10'000);
    for (std::size_t k = 0; k < made.size(); ++k) {
      const test::SmoothTrajectory truth(1e-3 * static_cast<double>(k));
      Kinematics kinematics;
      Dynamics dynamics;
      bench()->kinematics(truth.pose, truth.velocity, kinematics);
      bench()->dynamics(kinematics, dynamics);
      const PlatformVector acceleration = truth.acceleration;
      const JointVector torque = drive_torques(kinematics, dynamics.M_x * acceleration);
      const auto imu = imu_output(bench()->space(), ImuMount{}, bench()->gravity(), truth.pose,
                                  truth.velocity, acceleration)
                           .value;
      made[k] = {{{}, true, true, kinematics.joints.active, kinematics.joints.passive},
                 {{}, true, torque},
                 {{}, true, torque},
                 {{}, PlatformMotion::Status::valid, truth.pose, truth.velocity},
                 {{}, true, imu.head<3>(), imu.tail<3>()}};
    }
    return made;
  }();
  return all;
}

const Instant& instant(Time now) { return instants()[static_cast<std::size_t>(now / 1ms) % 10'000]; }

template <class T>
T acquired(T value, Time now) {
  value.acquired = now;
  return value;
}

/// What the blocks before an estimator make of the readings.
class Sources final : public System {
 public:
  OutputPort<DriveTorque> torque = output<&Sources::read_torque>("torque", clock);
  OutputPort<PlatformMotion> platform = output<&Sources::read_platform>("platform", clock);
  OutputPort<ImuReading> imu = output<&Sources::read_imu>("imu", clock);

 private:
  DriveTorque read_torque(Time now) const { return acquired(instant(now).torque, now); }
  PlatformMotion read_platform(Time now) const { return acquired(instant(now).platform, now); }
  ImuReading read_imu(Time now) const { return acquired(instant(now).imu, now); }
};

/// One estimator and what feeds it; without a name what feeds it alone.
class EstimatorRig {
 public:
  explicit EstimatorRig(const std::string& name) : ticking_(wire(name)) {}

  void tick() {
    const Time now = ticking_.now();
    ticking_.set(joints_, acquired(instant(now).joints, now));
    ticking_.set(drives_, acquired(instant(now).drives, now));
    ticking_.tick();
  }
  /// The best of several runs [ns].
  double time_of_a_tick() {
    double best = 1e9;
    for (int run = 0; run < 20; ++run) {
      const auto begin = std::chrono::steady_clock::now();
      for (int k = 0; k < 2000; ++k) tick();
      const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - begin;
      best = std::min(best, took.count() / 2000);
    }
    return best;
  }

 private:
  DiagramBuilder& wire(const std::string& name) {
    Kinematics kinematics;
    Dynamics dynamics;
    bench()->kinematics(PlatformVector::Zero(3), PlatformVector::Zero(3), kinematics);
    bench()->dynamics(kinematics, dynamics);
    auto& sources = builder_.add<Sources>("sources");
    AcceleratedPorts given;
    given.joints = joints_;
    given.drives = drives_;
    given.imu = sources.imu;
    given.status = builder_.optional_input<StationStatus>("status");
    given.platform = sources.platform;
    given.drive_torque = sources.torque;
    given.kinematics = builder_.add<Constant<Kinematics>>("kinematics", kinematics).value;
    given.dynamics = builder_.add<Constant<Dynamics>>("dynamics", dynamics).value;
    for (const AccelerationSource& source : acceleration_stages()) {
      if (name != "direct_method" || source.name != "extended_imu_ekf") continue;
      given.acceleration = source.add({builder_, source.name, bench(), settings_, shared_}, given);
      given.accelerations.push_back({source.name, given.acceleration});
    }
    for (const WrenchEstimator& estimator : estimator_stages()) {
      if (estimator.name == name) estimator.add({builder_, name, bench(), settings_, shared_}, given);
    }
    return builder_;
  }

  DiagramBuilder builder_{"bench", 1ms};
  ContactControlSettings settings_;
  SharedParts shared_;
  InputPort<JointReading> joints_ = builder_.input<JointReading>("joints");
  InputPort<DriveReading> drives_ = builder_.input<DriveReading>("drives");
  test::Ticking ticking_;
};

void EstimatorTick(benchmark::State& state, const std::string& name) {
  EstimatorRig tested(name), observer("momentum_observer"), sources("");
  for (auto unused : state) tested.tick();
  const double nothing = sources.time_of_a_tick();
  state.counters["times_the_momentum_observer"] =
      (tested.time_of_a_tick() - nothing) / (observer.time_of_a_tick() - nothing);
}

const bool registered = [] {
  for (const WrenchEstimator& estimator : estimator_stages()) {
    benchmark::RegisterBenchmark(("EstimatorTick/" + estimator.name).c_str(), EstimatorTick, estimator.name);
  }
  return true;
}();

}  // namespace
}  // namespace flinch
