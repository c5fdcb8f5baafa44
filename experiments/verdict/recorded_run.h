#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/verdict/recorded_sensor_faults.h"
#include "experiments/verdict/verdict.h"
#include "systems/robot/configuration_space.h"
#include "systems/signals/braking_status.h"
#include "systems/signals/contact_detection.h"
#include "systems/signals/contact_location.h"
#include "systems/signals/followed_task.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/located_contacts.h"
#include "systems/signals/operator_command.h"
#include "systems/signals/reaction_state.h"

namespace flinch {

/// What one obstacle does to the robot at one sample. What nobody measured is not a number.
struct RunLoad {
  int obstacle = -1;              ///< its place in the list of obstacles; -1: none, or nobody saw which
  int body = -1;                  ///< that it touches hardest, BodyId::index()
  int clamped_leg = -1;           ///< whose links it both touches; -1: none
  double contact_force = 0.0;     ///< of its hardest touch [N]
  CartesianVector touched_point;  ///< where that is [m]; empty where nobody measured it
  CartesianVector touched_force;  ///< and that force on the robot [N], likewise
  double push_force = 0.0;        ///< of what acts on the platform without touching it [N]
  double push_moment = 0.0;       ///< likewise [Nm]

  /// Of the hardest touch or push; not a number where nobody measured it, as the next.
  double force() const { return std::max(contact_force, push_force); }
  bool pushes() const { return push_force >= contact_force; }
  /// How hard the robot is touched or pushed, as a multiple of what counts as a contact.
  double load() const {
    return std::max(force() / Verdict::contact_force, push_moment / Verdict::contact_moment);
  }
};

/// All that a verdict looks at, at one sample, whatever the mechanism. What nobody measured is not a number.
struct RunSample {
  double time = 0.0;     ///< [s]
  bool is_true = false;  ///< bodies, obstacles, clamping, pushes and loop closure are known
  /// Of each obstacle that touches, the hardest first; at least one, which has the pushes as well.
  std::vector<RunLoad> loads{RunLoad()};
  /// Of all that acts on the platform; 0 where only an instrument looked on [N].
  double external_force = 0.0;
  double external_moment = 0.0;  ///< likewise [Nm]
  double loop_closure = 0.0;     ///< [m]
  double speed = 0.0;            ///< of the platform's origin [m/s]
  bool estimate_valid = false;
  double observer_error_force = 0.0;   ///< of the estimate, largest component [N]
  double observer_error_moment = 0.0;  ///< likewise [Nm]
  /// Of the true pose, where that was recorded, else of the one that the controller measured; not numbers
  /// where there was none.
  double sigma_kappa = std::numeric_limits<double>::quiet_NaN();
  double sigma_sc = std::numeric_limits<double>::quiet_NaN();  ///< likewise [m]
  std::optional<SelfContact> self_contact;  ///< bodies of the robot that touch one another, if that is known
  /// The largest magnitude of those that the drives are told; not a number where none is told [Nm or N].
  double drive_torque = std::numeric_limits<double>::quiet_NaN();
  bool reference_valid = false;
  double position_error = 0.0;     ///< [m]
  double orientation_error = 0.0;  ///< [rad]
  bool reference_rests = false;    ///< it has come to its end
  OperatorCommand pressed;         ///< what the operator does
  /// What the followed classifier takes for touched, by name; "" while it has accepted nothing.
  std::string classified;
  double probability = 0.0;  ///< of that
  /// Whether it says that no single contact explains the wrench; none: it says nothing, or does not look.
  std::optional<bool> several_contacts;
  ContactLocation location;  ///< of the followed locator
  LocatedContacts located;   ///< by wrench and base forces; not valid where there are no such sensors
  ContactDetection detection;
  /// Whether a detector detects something that follows the estimator of this name in
  /// `RecordedRun::estimators`.
  std::vector<bool> detected_by;
  ReactionMode mode = ReactionMode::stopped;
  FollowedTask task;  ///< of a reaction that serves tasks
  GateStatus gate;
  BrakingStatus braking;
  RecordedSensorFaults doubts;
  std::optional<CheckMask> askable;             ///< none: the recording does not tell
  std::optional<DriveCheckStatus> drive_check;  ///< none: the drives were not checked
  int lost_ticks = 0;                           ///< periods without a tick before this one
  int unread_readings = 0;  ///< of the joints, that no tick has seen, since the start of the link

  /// Of the hardest touch or push; not a number where nobody measured it, as the next.
  double force() const { return loads.front().force(); }
  double load() const { return loads.front().load(); }
  /// Whether something touches or pushes the robot, as far as the witness knows.
  bool is_touched() const {
    return load() > 1.0 || external_force > Verdict::contact_force ||
           external_moment > Verdict::contact_moment;
  }
};

/// Whether a RecordedRun of a simulation reads the signal `path`.
bool is_judged(const std::string& path);

/// The samples of a recording as its best witness saw them: the truth of a simulation, or an instrument. To
/// be read in their order; however many there are, few are in memory.
class RecordedRun {
 public:
  /// `space`: of the robot that it was recorded of. Throws SetupError when signals are missing. The recording
  /// must outlive the run.
  RecordedRun(const Recording& recording, ConfigurationSpace space);
  ~RecordedRun();

  Witness witness() const { return witness_; }
  /// The estimators that contact detectors follow, and other detectors by their own names, first the one that
  /// the robot follows: "" where the recording does not name it.
  const std::vector<std::string>& estimators() const { return estimators_; }
  /// The names of the obstacles; none where the recording does not tell them.
  const std::vector<std::string>& obstacles() const { return obstacles_; }
  std::size_t size() const;
  double period() const;    ///< [s]
  double duration() const;  ///< of all samples, each one period long [s]
  RunSample operator[](std::size_t sample) const;

 private:
  struct Signals;

  const Recording& recording_;
  ConfigurationSpace space_;
  Witness witness_;
  std::vector<std::string> estimators_;
  std::vector<std::string> obstacles_;
  std::unique_ptr<Signals> signals_;
};

}  // namespace flinch
