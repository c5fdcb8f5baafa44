#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "systems/framework/time.h"
#include "systems/signals/gate_fault.h"

/// Lies of sensors and drives in the closed loop of a realistic robot, and what becomes of it.
namespace flinch::test {

/// What the robot does when it is lied to.
enum class LieMoment {
  motion,    ///< it follows its path, or stands
  stop,      ///< the operator has stopped it 10 ms before
  contact,   ///< it has run into an obstacle some milliseconds before, which it has not detected yet
  reaction,  ///< and gives way
};

/// Where and how the robot moves when it is lied to.
struct LieScene {
  std::string robot = "planar_3rrr";  ///< of lie_stage()
  double speed = 0.3;                 ///< of the platform through the middle [m/s]; 0: it stands there
  double direction_deg = 0.0;
  unsigned seed = 1;  ///< draws robot and noise
  bool passive_encoders = true;
  bool imu = true;
  Time brakes = 0ms;             ///< that they take to close
  bool from_standstill = false;  ///< the lie begins before the motion
  std::string realism = "bench";
  LieMoment moment = LieMoment::motion;
  Time period = 1ms;  ///< from tick to tick of the control
};

/// A run as the trial looks at it, by ticks.
struct LieRun {
  std::vector<double> speed, energy, phase, fault;
  std::vector<double> reaction;                 ///< of the gate
  std::vector<double> force;                    ///< largest of a contact so far [N]
  std::vector<std::vector<double>> torque;      ///< of each drive [Nm]
  std::vector<std::array<double, 3>> position;  ///< [m]
};

struct LieOutcome {
  std::string lie;
  LieScene scene;
  bool began = false;         ///< the gate was open when the lie began
  std::optional<Time> alarm;  ///< from the lie until the gate closes
  GateFault fault = GateFault::none;
  bool named = false;  ///< a fault that doubts what lies, not a limit that is passed
  /// Largest beyond the honest run's, until 50 ms or the alarm [% of the largest; Nm at the rig].
  double torque = 0.0;
  double excess = 0.0;       ///< speed above the honest run's, after the alarm [m/s]
  std::optional<Time> rest;  ///< from the alarm until the platform rests
  Time watched{};            ///< from the alarm until the run ends
  double travel = 0.0;       ///< meanwhile [m]
  Time growth{};             ///< of the kinetic energy after the alarm
  double force = 0.0;        ///< peak of the contact over that of the honest run; 0 without a contact
};

/// The tick at which the lie of a scene begins.
Time lie_at(const LieScene& scene);

/// The scene without a lie.
LieRun honest_run(const LieScene& scene);

/// The same with "SIGNAL:KIND" and a size; several are joined by '+'.
LieOutcome try_lie(const LieScene& scene, const std::string& lie, const LieRun& honest);

/// What speaks against an answer: no name for a lie that makes more than 30 % of the largest torque (30 Nm at
/// the rig) within 50 ms, more than
/// 0.3 m/s above the honest run after the alarm, more than 30 ms until rest (60 ms with brakes of 30 ms), or
/// an energy that grows for more than 5 ms. "" where nothing does.
std::string problem_with(const LieOutcome& outcome);

/// A line of the table.
std::string line_of(const LieOutcome& outcome);
std::string table_head();

}  // namespace flinch::test
