#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>

#include "systems/framework/diagram_builder.h"
#include "systems/framework/random.h"
#include "systems/framework/system.h"

namespace flinch::test {

enum class Mood : std::uint8_t { calm, alarmed };

using Bounded = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

/// One of everything that can be recorded.
struct Sample {
  Time when{};
  bool good = false;
  Mood mood = Mood::calm;
  int count = 0;
  double real = 0.0;
  Eigen::Vector3d fixed{0.0, 0.0, 0.0};
  Bounded bounded;
  std::array<double, 2> pair{};

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("when", "ns", self.when);
    visit("good", "", self.good);
    visit("mood", "", self.mood);
    visit("count", "", self.count);
    visit("real", "N", self.real);
    visit("fixed", "m", self.fixed, "base");
    visit("bounded", "rad", self.bounded);
    visit("pair", "A", self.pair);
  }
};

/// Draws a new sample each tick; sizes, infinities and NaN included.
class Source final : public System {
  State<RandomGenerator> generator_ = state<RandomGenerator>("generator", RandomGenerator(3));

 public:
  OutputPort<Sample> sample = output<&Source::draw>("sample", clock, generator_);

 private:
  Update advance_ = update<&Source::advance>(generator_, generator_);
  RandomGenerator advance(RandomGenerator generator) const {
    generator();
    return generator;
  }
  void draw(Time now, RandomGenerator generator, Sample& drawn) const {
    drawn.when = now;
    drawn.good = generator.uniform(0, 1) > 0.5;
    drawn.mood = generator.uniform(0, 1) > 0.5 ? Mood::alarmed : Mood::calm;
    drawn.count = static_cast<int>(generator.uniform(-1000, 1000));
    drawn.real =
        generator.uniform(0, 1) > 0.9 ? std::numeric_limits<double>::quiet_NaN() : generator.normal();
    drawn.fixed = Eigen::Vector3d(generator.normal(), -0.0, std::numeric_limits<double>::infinity());
    drawn.bounded = Bounded::Constant(static_cast<int>(generator.uniform(0, 6.99)), generator.normal());
    drawn.pair = {generator.normal(), generator.normal()};
  }
};

/// A diagram with nothing but a Source.
inline std::unique_ptr<Diagram> random_source() {
  DiagramBuilder builder("original");
  builder.add<Source>("source");
  return builder.build();
}

}  // namespace flinch::test
