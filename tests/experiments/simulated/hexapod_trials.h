#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict.h"

namespace flinch::test {

/// The shipped hexapod at home among nothing, with the noise of all sensors. It draws back from hard contacts
/// as from others: in zero gravity it would give way, and stay in touch.
SimulatedScenario hexapod_trial(std::uint64_t seed);

/// `trial` with six straight motions from rest to rest, at most 0.6 m/s, 12 m/s^2, 3 rad/s and 60 rad/s^2,
/// between poses drawn from 0.12 x 0.12 x 0.1 m about home and turned by up to 15 degrees.
SimulatedScenario with_free_motion(SimulatedScenario trial, std::uint64_t seed);

/// What the controller believes of the friction of a robot whose drives differ from one another.
enum class KnownFriction { of_its_make, of_each_drive };

/// `trial` with a robot each of whose drives rubs by a share from 0.8 to 1.2, drawn from `seed`, of what the
/// robot file says.
SimulatedScenario with_uneven_drives(SimulatedScenario trial, KnownFriction known, std::uint64_t seed);

/// `trial` with limits that nothing reaches.
SimulatedScenario unheeding(SimulatedScenario trial);

/// `trial`, whose contacts are detected where the estimate exceeds by a fifth what it was without one, but
/// not below the limits that it has.
SimulatedScenario with_limits_above(SimulatedScenario trial, const Verdict& without_contact);

/// A contact of the platform with a ball that lies in line with the platform's origin.
struct PlatformContact {
  Eigen::Vector3d direction{1.0, 0.0,
                            0.0};  ///< From the platform to the ball, a unit vector in the base frame.
  double speed = 0.0;              ///< At which they meet [m/s].
  bool ball_moves = false;         ///< The ball comes; otherwise the platform goes.
};

/// So many contacts: in every second one the ball moves; all directions in space and all speeds from 0.2 to
/// 0.6 m/s are equally likely. Where a leg is nearer to the ball than the platform, it is drawn again.
std::vector<PlatformContact> draw_contacts(const SimulatedScenario& trial, int count, std::uint64_t seed);

/// How stiff the ball's surface is [N/m].
enum class Stiffness { pad = 6000, hand = 75000 };

/// `trial` with this contact at the home pose.
SimulatedScenario with_contact(SimulatedScenario trial, const PlatformContact& contact, Stiffness stiffness);

/// What a contact led to. Times since its onset [ms]; infinite: never.
struct ContactOutcome {
  double detected = 0.0;
  double detected_at_best = 0.0;  ///< by the same gain and thresholds, from the true wrench
  double removed = 0.0;
  double peak_force = 0.0;  ///< [N]
  bool is_platform_alone = false;
  Verdict verdict;
};
ContactOutcome outcome_of(const SimulatedScenario& trial);

double median(std::vector<double> values);

}  // namespace flinch::test
