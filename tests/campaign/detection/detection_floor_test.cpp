// How early a contact can be detected at all with the sensors of the rig. FLINCH_CONTACTS in the
// environment says of how many contacts of each sort; docs/observers.md cites 200.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "experiments/campaign/campaign_run.h"
#include "plant/sensor_noise.h"
#include "tests/campaign/detection/shipped_runs.h"
#include "tests/fault/scenario_loop.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

constexpr Time watched = 100ms;  // after an onset
constexpr double never = 1e3;    // [ms]

/// What half of all runs exceed when a matched filter says "contact": one of the 3.6e6 ticks of an hour has
/// half a false alarm, so 5.13 deviations of a normal distribution.
constexpr double needed = 5.13;

/// Truth of a run, tick by tick.
struct Trace {
  std::vector<JointVector> angle;  // of the drives
  std::vector<PlatformVector> velocity, acceleration;
  std::optional<double> onset, detected;  // [ms], of a force above 1 N, by the fused detector (latched)
};

/// As far as `watched` after the onset, or `most` ticks.
Trace follow(const SimulatedScenario& scenario, std::size_t most) {
  test::ScenarioLoop loop(scenario);
  const auto& detections = loop.control.others.detections;
  const auto fused = std::find_if(detections.begin(), detections.end(),
                                  [](const auto& each) { return each.name == "detection_fused_detector"; });
  if (fused == detections.end()) throw std::runtime_error("there is no fused detector");
  Trace trace;
  double before = 0.0;
  for (std::size_t k = 0; k < most; ++k) {
    loop.tick();
    const Context& context = loop.context;
    const PlantTruth& truth = context.get(loop.station.plant_truth);
    trace.angle.push_back(truth.active);
    trace.velocity.push_back(truth.velocity);
    trace.acceleration.push_back(truth.acceleration);
    const auto tick = static_cast<double>(k);
    const double force = std::max(context.get(loop.station.contact_truth).strongest.strength(), 0.0);
    if (!trace.onset && force > 1.0) trace.onset = tick - (force - 1.0) / (force - before);
    before = force;
    const bool says = context.get(fused->port).level != ContactLevel::none;
    if (says && !trace.detected) trace.detected = tick;
    if (trace.onset && tick > *trace.onset + static_cast<double>(watched / 1ms)) break;
  }
  return trace;
}

/// When the likelihood ratio of "this contact" against "none" can be sure, of someone who knows how the robot
/// would move without the contact and how it moves with it, and lacks only the noise of the drives' encoders
/// and the IMU. No detector that goes by these is earlier. [ms after the onset]
double floor_of(const Trace& touched, const Trace& free, const SimulatedStationSettings& station) {
  const double pushing = noise_deviation(station.imu.accelerometer_density, station.imu.clock.period);
  const double turning = noise_deviation(station.imu.gyroscope_density, station.imu.clock.period);
  const auto delay = static_cast<std::size_t>(std::ceil(to_seconds(station.imu.delay) / 1e-3));
  double squares = 0.0;
  for (std::size_t k = 0; k < touched.angle.size(); ++k) {
    squares += (touched.angle[k] - free.angle[k]).squaredNorm() / std::pow(station.encoders.active.noise, 2);
    if (k >= delay) {
      const PlatformVector pushed = touched.acceleration[k - delay] - free.acceleration[k - delay];
      const PlatformVector turned = touched.velocity[k - delay] - free.velocity[k - delay];
      squares += (pushed.head(2) / pushing).squaredNorm() + std::pow(turned[2] / turning, 2);
    }
    const double after = static_cast<double>(k) - *touched.onset;
    if (after >= 0.0 && std::sqrt(squares) >= needed) return after;
  }
  return never;
}

SimulatedScenario without_obstacles(SimulatedScenario scenario) {
  scenario.station.rig.obstacles.clear();
  scenario.station.force_torque.reset();
  return scenario;
}

double share(std::vector<double> times, double part) {
  std::sort(times.begin(), times.end());
  return times[static_cast<std::size_t>(part * static_cast<double>(times.size()))];
}

TEST(TheFusedDetector, NoticesContactsShortlyAfterTheFirstInstantAtWhichItsSensorsCouldTell) {
  const auto contacts = test::wanted<std::size_t>("FLINCH_CONTACTS", 50);
  const Campaign campaign = test::shipped("detection_roc", contacts);
  std::printf("[ms], median / nine tenths of %zu\n", contacts);
  for (std::size_t sort = 0; sort < campaign.contact->bodies.size(); ++sort) {
    std::vector<double> floor, fused;
    for (std::size_t i = 0; i < contacts; ++i) {
      const SimulatedScenario scenario = draw_run(campaign, sort * contacts + i).scenario;
      const Trace touched = follow(scenario, static_cast<std::size_t>(scenario.duration / 1ms));
      if (!touched.onset || (touched.detected && *touched.detected < *touched.onset)) continue;
      const Trace free = follow(without_obstacles(scenario), touched.angle.size());
      floor.push_back(floor_of(touched, free, scenario.station));
      fused.push_back(touched.detected ? *touched.detected - *touched.onset : never);
    }
    ASSERT_GE(floor.size(), contacts * 9 / 10);
    const std::string& body = campaign.contact->bodies[sort];
    std::printf("  %-9s floor %4.1f / %4.1f, fused detector %4.1f / %4.1f\n", body.c_str(), share(floor, 0.5),
                share(floor, 0.9), share(fused, 0.5), share(fused, 0.9));
    EXPECT_GE(share(fused, 0.5), share(floor, 0.5)) << body << ": sooner than possible";
    EXPECT_LE(share(fused, 0.5), share(floor, 0.5) + 2.5) << body;
  }
}

}  // namespace
}  // namespace flinch
