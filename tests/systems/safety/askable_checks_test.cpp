// Which questions can be asked: those whose lie is found, and no others.
#include "systems/safety/askable_checks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "systems/robot/joint_space_dynamics.h"
#include "tests/systems/safety/watched.h"

namespace flinch {
namespace {

using test::Told;
using test::Watched;

using Change = std::function<void(Told&)>;

CheckMask without(std::initializer_list<PlausibilityCheck> checks) {
  CheckMask mask = all_checks;
  for (const PlausibilityCheck check : checks) mask &= ~check_bit(check);
  return mask;
}

/// What a monitor has to do without, and what it can ask then.
struct Lack {
  const char* name;
  Change always = [](Told&) {};
  CheckMask askable = all_checks;
  PlausibilityLimits limits = test::watched_limits();
};

std::vector<Lack> lacks() {
  using enum PlausibilityCheck;
  std::vector<Lack> lacks = {
      {"nothing"},
      {"IMU", [](Told& told) { told.imu.valid = false; }, without({gyroscope, accelerometer})},
      {"passive encoders", [](Told& told) { told.joints.passive_valid = false; }, without({parity})},
      {"currents", [](Told& told) { told.drives.valid = false; }, without({tube, quiet_current})},
      {"noise of an angle",
       [](Told& told) { told.joints.active[2] = 5e-5 * std::floor(told.joints.active[2] / 5e-5); },
       without({quiet_angle})},
      {"noise of a current", [](Told& told) { told.drives.current[1] = 0.0; }, without({quiet_current})},
      {"torque constants", [](Told&) {}, without({tube, quiet_current})},
      {"commands that act", [](Told&) {}, without({jump, isolated, pair, tube, still, status, response})}};
  lacks[6].limits.torque_constant = {};
  lacks[7].limits.commands_act = false;
  return lacks;
}

/// Three drives that a torque of `torque` on the first turns the wrong way round.
Change turned_round() {
  const test::Posture home(*test::planar_rig(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0ns);
  const Eigen::Matrix3d inertia = joint_space_dynamics(home.kinematics, home.dynamics).M_qa;
  const Eigen::Vector3d torque(30.0, 0.0, 0.0);
  const Eigen::Vector3d acceleration = -inertia.inverse() * torque;
  return [=, k = 0](Told& told) mutable {
    const double time = 1e-3 * k++;
    told.joints.active += 0.5 * time * time * acceleration;
    told.command.torque = torque;
    told.drives.current += torque / 6.0;
  };
}

/// For each question a lie that it finds; the three of jumps have theirs in common.
std::map<PlausibilityCheck, Change> lies(int now) {
  using enum PlausibilityCheck;
  const Time begin = Time(1ms) * now;
  return {{jump, [](Told& told) { told.joints.active[1] += 2e-3; }},
          {pair, [](Told& told) { told.joints.active[0] += 4e-4; }},
          {isolated, [k = 0](Told& told) mutable { told.joints.active[0] += 0.7e-3 * ++k; }},
          {quiet_angle, [](Told& told) { told.joints.active[2] = 1.0; }},
          {gyroscope, [](Told& told) { told.imu.angular_velocity[2] += 0.2; }},
          {accelerometer, [](Told& told) { told.imu.specific_force[0] += 20.0; }},
          {parity, [](Told& told) { told.joints.passive[2] += 0.01; }},
          {tube, [](Told& told) { told.drives.current[2] += 0.3; }},
          {quiet_current, [](Told& told) { told.drives.current[1] = 0.0; }},
          {still,
           [k = 0](Told& told) mutable {
             told.command.torque.setConstant(0.8 * ++k);
             told.drives.current = told.command.torque / 6.0;
           }},
          {stop,
           [=, k = 0](Told& told) mutable {
             told.gate = {
                 .phase = GatePhase::closed, .reaction = GateReaction::controlled_stop, .since = begin};
             told.joints.active.array() += 1e-3 * ++k;
           }},
          {brakes,
           [k = 0](Told& told) mutable {
             Watched::held(told);
             told.gate = {.phase = GatePhase::closed, .fault = GateFault::station_fault};
             told.joints.active[1] += 0.2e-3 * ++k;
           }},
          {status, [](Told& told) { told.station.braked = true; }},
          {response, turned_round()}};
}

TEST(AskableChecks, AreAllOfARobotWithEverything) { EXPECT_EQ(Watched().tick().askable, all_checks); }

TEST(AskableChecks, AreThoseThatHaveWhatTheyNeed) {
  for (const Lack& lack : lacks())
    EXPECT_EQ(Watched(lack.always, lack.limits).tick().askable, lack.askable) << lack.name;
}

TEST(AskableChecks, FindTheirLieAndTheOthersFindNothing) {
  for (const Lack& lack : lacks()) {
    for (const auto& [check, lie] : lies(Watched().ticks())) {
      // What is missing stays so, whatever is said of it.
      const Change told = [&lack, lie = lie](Told& tick) mutable {
        lie(tick);
        lack.always(tick);
      };
      Watched watched(lack.always, lack.limits);
      double most = 0.0;
      for (int k = 0; k < 100; ++k) most = std::max(most, watched.tick(told).of(check));
      const bool askable = (lack.askable & check_bit(check)) != 0;
      SCOPED_TRACE(std::string("without ") + lack.name + ", check " +
                   std::to_string(static_cast<int>(check)));
      if (askable) {
        EXPECT_GT(most, 1.0);
      } else if (std::string(lack.name).starts_with("noise")) {
        EXPECT_LE(most, 1.0) << "but for the other drives";
      } else {
        EXPECT_EQ(most, 0.0);
      }
    }
  }
}

TEST(AskableChecks, NeedWhatIsLearnedBeforeTheFirstMotion) {
  using enum PlausibilityCheck;
  EXPECT_EQ(Watched([](Told&) {}, test::watched_limits(), 20).tick().askable,
            without({quiet_angle, quiet_current, gyroscope, accelerometer, parity}));
}

}  // namespace
}  // namespace flinch
