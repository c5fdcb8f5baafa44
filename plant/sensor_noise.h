#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include "systems/framework/random.h"
#include "systems/framework/time.h"

namespace flinch {

/// Independent normal numbers, mean 0, standard deviation 1, with the generator that draws the next ones: a
/// State.
template <int size>
class NormalNumbers {
 public:
  using Values = Eigen::Matrix<double, size, 1>;

  explicit NormalNumbers(std::uint64_t seed = 0) : generator_(seed) { draw(); }

  const Values& values() const { return values_; }

  void draw() {
    for (int i = 0; i < size; ++i) values_[i] = generator_.normal();
  }

 private:
  RandomGenerator generator_;
  Values values_;
};

/// Standard deviation of white noise of a one-sided `density` [unit/sqrt(Hz)] that is sampled every `period`.
inline double noise_deviation(double density, Time period) {
  return density * std::sqrt(0.5 / to_seconds(period));
}

/// Three draws from the normal distribution with mean 0.
inline Eigen::Vector3d normal_vector(RandomGenerator& generator, double deviation) {
  Eigen::Vector3d drawn;
  for (int i = 0; i < 3; ++i) drawn[i] = deviation * generator.normal();
  return drawn;
}

/// Three draws from the uniform distribution on [-limit, limit).
inline Eigen::Vector3d uniform_vector(RandomGenerator& generator, double limit) {
  Eigen::Vector3d drawn;
  for (int i = 0; i < 3; ++i) drawn[i] = generator.uniform(-limit, limit);
  return drawn;
}

}  // namespace flinch
