#pragma once

#include <algorithm>
#include <functional>

#include "plant/bench_dynamics.h"
#include "systems/framework/integrator.h"

namespace flinch::test {

/// The bench as a differential equation without a diagram around it, with the work done by contacts, applied
/// wrench and drives, and the work lost to friction, as four more states.
class BenchEquation final : public DifferentialEquation {
 public:
  explicit BenchEquation(const BenchDynamics& bench)
      : bench_(bench), size_(static_cast<std::size_t>(bench.initial_state().size())) {}

  /// Drives, applied wrench, contacts, friction; after the bench's states.
  static constexpr std::size_t works = 4;
  std::size_t size() const { return size_ + works; }

  DriveAction drives;
  Eigen::Vector3d applied_wrench{0.0, 0.0, 0.0};

  void rates(double, std::span<const double> y, std::span<double> rates) override {
    const BenchState state = Eigen::Map<const Eigen::VectorXd>(y.data(), static_cast<Eigen::Index>(size_));
    BenchState rate(state.size());
    bench_.rates(state, drives, applied_wrench, ContactCandidates::all(), rate);
    std::copy_n(rate.data(), size_, rates.begin());

    BenchSnapshot now;
    bench_.snapshot(state, drives, applied_wrench, now);
    const Eigen::Vector3d velocity = now.motion.velocity;
    const std::span<double> work = rates.subspan(size_);
    work[0] = 0.0;
    for (int leg = 0; leg < 3; ++leg) {
      work[0] += drives.torque[leg] * now.motion.legs[static_cast<std::size_t>(leg)].qa_rate;
    }
    work[1] = applied_wrench.dot(velocity);
    work[2] = (now.contacts.pylon_wrench + now.contacts.self_wrench).dot(velocity);
    work[3] = bench_.robot().friction_power(now.motion);
  }

 private:
  const BenchDynamics& bench_;
  std::size_t size_;
};

}  // namespace flinch::test
