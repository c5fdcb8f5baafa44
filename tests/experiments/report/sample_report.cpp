#include "tests/experiments/report/sample_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/experiments/report/sample_robot.h"

namespace flinch {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double period = 1e-3;
constexpr int samples = 2601;
constexpr double platform_radius = 0.137;
constexpr double pylon_radius = 0.04;
const Vector2d pylon(0.03, 0.29);
const Vector3d mass(3.9, 3.9, 0.0511);
const Vector3d stiffness(2000.0, 2000.0, 85.0);

/// Point to point in the given time, with rest at the end: quintic, position and velocity along it.
struct Motion {
  Vector3d from, to, velocity_from = Vector3d::Zero();
  double start, duration;

  Vector3d at(double t) const {
    const double s = std::clamp((t - start) / duration, 0.0, 1.0), r = 1.0 - s;
    const double blend = s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
    const double carry = s * r * r * r * (1.0 + 3.0 * s);
    return from + (to - from) * blend + velocity_from * (duration * carry);
  }
  Vector3d velocity(double t) const { return (at(t + step) - at(t)) / step; }
  Vector3d acceleration(double t) const { return (velocity(t + step) - velocity(t)) / step; }
  static constexpr double step = 1e-4;
};

/// One-sided spring and damper between the platform's hull and the pylon: force on the platform.
Vector2d contact_force(const Vector3d& pose, const Vector3d& velocity) {
  const Vector2d away = pose.head<2>() - pylon;
  const double depth = platform_radius + pylon_radius - away.norm();
  if (depth <= 0.0) return Vector2d::Zero();
  const Vector2d n = away.normalized();
  return n * std::max(0.0, 6000.0 * depth * (1.0 - 0.35 * n.dot(velocity.head<2>())));
}

/// The fabricated experiment, one tick after the other.
class SampleExperiment {
 public:
  SampleExperiment() {
    report_.lanes = {{"contact (true)", {"none", "platform"}, {}},
                     {"detector", {"quiet", "contact"}, {}},
                     {"mode", {"nominal", "reaction", "hold"}, {}},
                     {"constraint", {"none", "σκ", "σsc"}, {}},
                     {"reaction", {"none", "goes back the way it came"}, {}}};
  }

  Report run() {
    for (int k = 0; k < samples; ++k) {
      const double t = period * k;
      plan(t);
      record(t);
      for (int i = 0; i < 10; ++i) advance(t + period * i / 10.0, period / 10.0);
    }
    return report_;
  }

  double touched = nan, detected = nan, removed = nan, speed = nan, peak = 0.0, peak_time = nan;

 private:
  void plan(double t) {
    const Vector2d force = contact_force(pose_, velocity_);
    if (force.norm() > 1.0 && std::isnan(touched)) touched = t, speed = velocity_.head<2>().norm();
    if (force.norm() > peak) peak = force.norm(), peak_time = t;
    if (!std::isnan(touched) && std::isnan(removed) && force.norm() < 1.0) removed = t;
    if (std::isnan(detected) && estimate_.head<2>().cwiseAbs().maxCoeff() >= 10.0) detect(t);
    if (k_ == approach_) motion_ = {{-0.05, -0.15, -0.12}, {0.09, 0.39, 0.1}, Vector3d::Zero(), t, 1.09};
    ++k_;
  }

  void detect(double t) {
    detected = t;
    Vector3d back = pose_;
    back.head<2>() += 0.10 * estimate_.head<2>().normalized();
    motion_ = {pose_, back, velocity_, t, 0.32};
  }

  Vector3d control(double t) const {
    const Vector3d damping = 2.0 * (mass.array() * stiffness.array()).sqrt();
    return mass.cwiseProduct(motion_.acceleration(t)) + stiffness.cwiseProduct(motion_.at(t) - pose_) +
           damping.cwiseProduct(motion_.velocity(t) - velocity_);
  }

  Vector3d external() const {
    const Vector2d force = contact_force(pose_, velocity_);
    const Vector2d arm = -platform_radius * (pose_.head<2>() - pylon).normalized();
    return {force.x(), force.y(), arm.x() * force.y() - arm.y() * force.x()};
  }

  void advance(double t, double dt) {
    const Vector3d model_error(0.9 * std::sin(7.0 * t), 0.7 * std::cos(5.0 * t), 0.03 * std::sin(9.0 * t));
    velocity_ += dt * (control(t) + external() + model_error).cwiseQuotient(mass);
    pose_ += dt * velocity_;
    estimate_ += dt * Vector3d(20.0, 20.0, 10.0).cwiseProduct(external() + model_error - estimate_);
  }

  void put(const std::string& name, double value) { report_.columns[name].push_back(value); }

  double noise(double deviation) { return std::normal_distribution<>(0.0, deviation)(random_); }

  void record(double t) {
    const sample::Configuration now = sample::configuration(pose_);
    put("pose_x", pose_.x()), put("pose_y", pose_.y()), put("pose_phi", pose_.z());
    put("speed", velocity_.head<2>().norm());
    record_forces();
    record_torques(t, now);
    put("position_error", (motion_.at(t) - pose_).head<2>().norm());
    put("orientation_error", std::abs((motion_.at(t) - pose_).z()));
    put("sigma_kappa", sample::sigma_kappa(now));
    put("sigma_sc", sample::sigma_sc(now));
    record_lanes(t, sample::sigma_kappa(now));
  }

  void record_forces() {
    const Vector3d force = external();
    const bool contact = force.head<2>().norm() > 0.0;
    const Vector2d point = pose_.head<2>() + platform_radius * (pylon - pose_.head<2>()).normalized();
    put("contact_force", force.head<2>().norm());
    put("contact_1_x", contact ? point.x() : nan), put("contact_1_y", contact ? point.y() : nan);
    put("contact_1_force_x", force.x()), put("contact_1_force_y", force.y());
    put("external_force_x", force.x()), put("external_force_y", force.y());
    put("external_moment", force.z());
    put("estimated_force_x", estimate_.x() + noise(0.12)),
        put("estimated_force_y", estimate_.y() + noise(0.12));
    put("estimated_moment", estimate_.z() + noise(0.01));
    const bool isolated = !std::isnan(detected) && estimate_.head<2>().norm() > 10.0;
    const Vector2d guess = pose_.head<2>() - platform_radius * estimate_.head<2>().normalized();
    put("isolated_x", isolated ? guess.x() : nan), put("isolated_y", isolated ? guess.y() : nan);
  }

  void record_torques(double t, const sample::Configuration& now) {
    const Vector3d torque = now.J_x_qa.transpose() * control(t);
    for (int i = 0; i < 3; ++i) {
      const std::string leg = std::to_string(i + 1);
      put("elbow_" + leg + "_x", now.elbow[static_cast<size_t>(i)].x());
      put("elbow_" + leg + "_y", now.elbow[static_cast<size_t>(i)].y());
      put("torque_commanded_" + leg, torque[i]);
      put("torque_applied_" + leg, last_torque_[i] + noise(0.15));
    }
    last_torque_ = torque;
  }

  void record_lanes(double t, double kappa) {
    const bool contact = external().head<2>().norm() > 1.0;
    report_.lanes[0].state.push_back(contact ? 1 : 0);
    report_.lanes[1].state.push_back(estimate_.head<2>().cwiseAbs().maxCoeff() >= 10.0 ? 1 : 0);
    report_.lanes[2].state.push_back(std::isnan(detected) ? 0 : t < detected + 0.32 ? 1 : 2);
    report_.lanes[3].state.push_back(!std::isnan(detected) && kappa > 8.4 && t < detected + 0.4 ? 1 : 0);
    report_.lanes[4].state.push_back(std::isnan(detected) ? 0 : 1);
  }

  static constexpr int approach_ = 900;
  int k_ = 0;
  Vector3d pose_{0.02, 0.05, 0.05}, velocity_ = Vector3d::Zero(), estimate_ = Vector3d::Zero();
  Vector3d last_torque_ = Vector3d::Zero();
  Motion motion_{{0.02, 0.05, 0.05}, {-0.05, -0.15, -0.12}, Vector3d::Zero(), 0.1, 0.7};
  std::mt19937 random_{1};
  Report report_;
};

ReportRobot drawn_robot() {
  ReportRobot robot{{}, 0.03, {{0.0, 0.0, 0.0}}, platform_radius};
  for (const sample::Leg& leg : sample::legs) {
    const Vector2d base = leg.base_joint(), coupling = leg.coupling_in_platform();
    robot.legs.push_back({{base.x(), base.y(), 0.0}, {coupling.x(), coupling.y(), 0.0}});
  }
  return robot;
}

void add_verdict(const SampleExperiment& experiment, Report& report) {
  ReportContact contact;
  contact.body = contact.isolated_body = "platform";
  contact.object = "pylon";
  contact.start = experiment.touched;
  contact.detected = experiment.detected;
  contact.removed = experiment.removed;
  contact.speed = experiment.speed;
  contact.peak_force = experiment.peak;
  contact.peak_time = experiment.peak_time;
  contact.force_limit = 280.0;
  contact.limit_name = "ISO/TS 15066, transient, hand";
  contact.within_limit = experiment.peak <= 280.0;
  report.good = contact.within_limit;
  report.contacts = {contact};
  report.measures = {
      {"False detections", 0.0, "", 0.0, true, "before the first contact"},
      {"Observer error, force", 1.34, "N", 5.0, true, "largest, contact-free"},
      {"Observer error, moment", 0.0412, "Nm", 0.3, true, "largest, contact-free"},
      {"Tracking error, position", 0.00081, "m", 0.01, true, "largest, contact-free"},
      {"Tracking error, orientation", 0.00062, "rad", {}, {}, "largest, contact-free"},
      {"Loop closure", 3.1e-13, "m", 1e-9, true, "largest gap of the simulated legs"},
      {"Simulated time", 2.6, "s", {}, {}, "in 0.21 s of wall time"},
      {"Seed", 1.0, "", {}, {}, ""},
  };
}

void add_background(Report& report) {
  report.bounds = {{"contact_force", "limit", 280.0},      {"force", "reaction threshold", 10.0},
                   {"force", "reaction threshold", -10.0}, {"force", "zero-g threshold", 60.0},
                   {"force", "zero-g threshold", -60.0},   {"moment", "reaction threshold", 1.0},
                   {"moment", "reaction threshold", -1.0}, {"sigma_kappa", "activation", 12.0},
                   {"sigma_kappa", "safety limit", 15.0},  {"sigma_sc", "activation", 0.178},
                   {"sigma_sc", "safety limit", 0.17},     {"torque", "torque limit", 100.0},
                   {"torque", "torque limit", -100.0}};
  report.parameters = {{"observer", "gain", "20, 20, 10", "1/s", "momentum observer"},
                       {"observer", "remark",
                        "a value can be as long as a sentence, or longer than any table "
                        "is wide, like the names of files in folders in folders: far/down/in/some/archive/of/"
                        "experiments/of/last/year/and/the/year/before/robot.yaml",
                        "", ""},
                       {"observer", "start", "steady", "", ""},
                       {"detector", "reaction threshold, force", "10", "N", "each component"},
                       {"detector", "reaction threshold, moment", "1", "Nm", ""},
                       {"detector", "zero-g threshold, force", "60", "N", "each component"},
                       {"detector", "zero-g threshold, moment", "3", "Nm", ""},
                       {"impedance", "stiffness", "2000, 2000, 85", "N/m, N/m, Nm/rad", ""},
                       {"impedance", "damping ratio", "1", "", "critical"},
                       {"reaction", "retraction", "0.10", "m", "along the estimated force"},
                       {"reaction", "blend", "10", "ms", ""},
                       {"pylon", "stiffness", "6000", "N/m", "fabricated"},
                       {"pylon", "radius", "0.04", "m", ""},
                       {"seed", "sensors", "1", "", "white noise of encoders and currents"}};
  report.provenance = {{"", "flinch", "test data, no version", "", ""},
                       {"", "command", "flinch run scenarios/platform_contact.yaml --seed 1", "", ""},
                       {"", "scenario", "scenarios/platform_contact.yaml", "", ""},
                       {"", "robot", "robots/planar_3rrr.yaml", "", ""},
                       {"", "seed", "1", "", ""},
                       {"", "simulated time", "2.6", "s", ""},
                       {"", "wall time", "0.21", "s", "12.4 times faster than real time"}};
  report.texts = {{"Scenario",
                   "# test data\nname: platform contact\nrobot: planar_3rrr.yaml\nseed: 1\n"
                   "object:\n  kind: pylon\n  centre: [0.03, 0.29]  # m\n  radius: 0.04        # m\n"},
                  {"Robot", "# test data\nname: planar 3-RRR\nlegs: 3\n"}};
}

}  // namespace

Report sample_report() {
  SampleExperiment experiment;
  Report report = experiment.run();
  report.title = "Platform runs into a pylon";
  report.subtitle = "Momentum observer from encoders and motor currents; the reaction is a retraction.";
  report.note = "Test data: this motion was fabricated to test the page. It is not a result of flinch.";
  report.period = period;
  report.robot = drawn_robot();
  report.obstacles = {{"pylon", {{pylon.x(), pylon.y(), 0.0}}, pylon_radius},
                      {"cart", {{-0.45, 0.4, 0.0}}, 0.05}};
  for (std::size_t k = 0; k < report.sample_count(); ++k) {
    const double t = period * static_cast<double>(k);
    report.columns["obstacle_2_x"].push_back(0.1 * t);
    report.columns["obstacle_2_y"].push_back(-0.02 * t);
  }
  add_verdict(experiment, report);
  add_background(report);
  return report;
}

}  // namespace flinch
