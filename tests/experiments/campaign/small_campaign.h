#pragma once

#include "experiments/campaign/campaign.h"
#include "tests/support/workplace.h"

namespace flinch::test {

/// A campaign of two gains, two bodies and `draws` draws over the shipped platform collision, cut short.
inline Campaign small_campaign(const Workplace& place, int draws = 3) {
  place.replace("scenarios/platform_collision.yaml", "duration_s: 1.2", "duration_s: 0.7");
  place.write("campaigns/small.yaml",
              "scenario: ../scenarios/platform_collision.yaml\nruns: " + std::to_string(draws) +
                  "\n"
                  "contact: {body: [platform, link2]}\n"
                  "grid:\n"
                  "  - {key: control.momentum_observer.gain_per_s, values: [[20, 20, 20], "
                  "[40, 40, 40]]}\n"
                  "draw:\n"
                  "  - {key: motion.direction_deg, from: 0, to: 360}\n"
                  "  - {key: motion.speed_m_per_s, from: 0.5, to: 1.2}\n"
                  "  - {key: pylon.stiffness_N_per_m, from: 2000, to: 20000, scale: "
                  "logarithmic}\n");
  return read_campaign(place / "campaigns/small.yaml");
}

}  // namespace flinch::test
