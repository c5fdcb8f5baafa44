#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include "systems/framework/never_allocates.h"
#include "systems/framework/random.h"
#include "systems/framework/time.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Independent normal numbers, mean 0, standard deviation 1, with the generator that draws the next ones: a
/// State. At most `capacity` at a time.
template <int capacity>
class NormalNumbers {
 public:
  using Values = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, capacity, 1>;

  explicit NormalNumbers(int count = capacity, std::uint64_t seed = 0) : generator_(seed), values_(count) {
    draw();
  }

  const Values& values() const { return values_; }

  void draw() {
    for (int i = 0; i < values_.size(); ++i) values_[i] = generator_.normal();
  }

 private:
  RandomGenerator generator_;
  Values values_;
};

template <int size>
inline constexpr bool never_allocates<NormalNumbers<size>> = true;

/// Standard deviation of white noise of a one-sided `density` [unit/sqrt(Hz)] that is sampled every `period`.
inline double noise_deviation(double density, Time period) {
  return density * std::sqrt(0.5 / to_seconds(period));
}

/// Draws from the normal distribution with mean 0.
inline JointVector normal_vector(RandomGenerator& generator, int count, double deviation) {
  JointVector drawn(count);
  for (int i = 0; i < count; ++i) drawn[i] = deviation * generator.normal();
  return drawn;
}

/// Three draws from the uniform distribution on [-limit, limit).
inline Eigen::Vector3d uniform_vector(RandomGenerator& generator, double limit) {
  Eigen::Vector3d drawn;
  for (int i = 0; i < 3; ++i) drawn[i] = generator.uniform(-limit, limit);
  return drawn;
}

}  // namespace flinch
