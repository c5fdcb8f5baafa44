#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "experiments/campaign/drawn_contact.h"
#include "experiments/simulated/simulated_scenario.h"
#include "plant/contact_truth.h"
#include "plant/obstacle.h"
#include "systems/framework/random.h"

/// Robots that two posts touch at once.
namespace flinch::test {

/// One body that an obstacle touches.
struct Touching {
  int obstacle, body;
  friend auto operator<=>(const Touching&, const Touching&) = default;
};

inline std::set<Touching> touching(const ContactTruth& truth) {
  std::set<Touching> found;
  constexpr double counts_as_touch = 1.0;  // [N]
  const auto add = [&](const TouchTruth& touch) {
    if (touch.strength() > counts_as_touch) found.insert({touch.obstacle, touch.body});
  };
  add(truth.strongest);
  add(truth.second);
  for (const TouchTruth& touch : truth.further) add(touch);
  return found;
}

/// A post that another body runs into at the same time as that of the scenario.
inline std::optional<DrawnContact> add_post(SimulatedScenario& scenario, const std::string& touched,
                                            RandomGenerator& random) {
  const std::array<std::string, 3> kinds{"platform", "link1", "link2"};
  for (int attempt = 0; attempt < 50; ++attempt) {
    ObstacleForm post;
    post.name = "second post";
    post.shape = Sphere{.radius = random.uniform(0.015, 0.06)};
    post.material.stiffness = std::exp(random.uniform(std::log(2e3), std::log(1e5)));
    post.material.friction = random.uniform(0.0, 0.3);
    const auto place = draw_contact(scenario, kinds[random() % kinds.size()], post.shape, random);
    if (!place || place->body == touched) continue;
    post.position_in_base = place->position_in_base;
    scenario.station.rig.obstacles.push_back(std::make_shared<const FixedObstacle>(post));
    return place;
  }
  return std::nullopt;
}

}  // namespace flinch::test
