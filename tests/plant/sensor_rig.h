#pragma once

#include "plant/plant_truth.h"
#include "systems/framework/diagram_builder.h"
#include "tests/support/ticking.h"

namespace flinch::test {

/// A truth that is valid and at rest.
inline PlantTruth truth_at_rest() {
  PlantTruth truth;
  truth.valid = true;
  truth.pose = PlatformVector::Zero(3);
  truth.velocity = PlatformVector::Zero(3);
  truth.acceleration = PlatformVector::Zero(3);
  truth.active = Eigen::Vector3d(0.4, -0.3, 1.2);
  truth.passive = Eigen::Vector3d(2.1, 2.0, 1.9);
  truth.coupling = Eigen::Vector3d(-1.0, -2.0, 0.5);
  return truth;
}

/// Mean and standard deviation of numbers seen so far.
class Statistics {
 public:
  void add(double value) {
    ++count_;
    sum_ += value;
    sum_of_squares_ += value * value;
  }
  double mean() const { return sum_ / count_; }
  double deviation() const { return std::sqrt(sum_of_squares_ / count_ - mean() * mean()); }

 private:
  double count_ = 0.0;
  double sum_ = 0.0;
  double sum_of_squares_ = 0.0;
};

}  // namespace flinch::test
