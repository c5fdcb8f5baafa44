#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "systems/signals/drive_check_status.h"
#include "systems/signals/followed_task.h"
#include "systems/signals/imu_fault.h"

namespace flinch {

class ConfigurationSpace;
class RunMonitor;
struct Recording;

/// A force limit for contact with a person. These defaults are the values that [SafePR] quotes for the hand
/// from ISO/TS 15066; whoever makes a claim takes them from the standard.
struct ForceLimits {
  std::string region = "hand";      ///< of the body, see body_regions.h
  double transient = 280.0;         ///< for the first `transient_duration` of a contact [N]
  double quasi_static = 140.0;      ///< for what lasts longer [N]
  double transient_duration = 0.5;  ///< [s]
  std::string transient_source = "[SafePR] V-G, which quotes ISO/TS 15066";  ///< where the number is from
  std::string quasi_static_source = transient_source;                        ///< likewise
};

/// What a run is expected to show; what is not given is not judged.
struct Expectations {
  /// The body that is touched, or "none": then pushes are loads that the robot shall bear without a reaction.
  std::optional<std::string> contact{};
  std::optional<double> detection_time{};         ///< longest time from contact to detection [s]
  std::optional<double> removal_time{};           ///< longest time from contact to its end [s]
  std::optional<double> lasting_force{};          ///< largest force after the transient duration [N]
  std::optional<double> observer_error{};         ///< largest force error of the estimate without contact [N]
  std::optional<double> observer_error_moment{};  ///< the same for the moment [Nm]
  std::optional<double> tracking_error{};         ///< largest distance from the reference without contact [m]
  double loop_closure = 1e-9;                     ///< [m]
  /// Longest time from an operator's reset until `start` sets the robot off again [s]. That the gate closed
  /// before is then no failure.
  std::optional<double> return_time{};
};

/// When a detector that follows an estimator detected a contact.
struct DetectionBy {
  std::string estimator;           ///< "" where the recording does not name it
  std::optional<double> detected;  ///< [s]; none: never
};

/// A task that a reaction followed.
struct TaskBegin {
  FollowedTask task;
  double time = 0.0;  ///< from when on [s]
};

/// One contact with one obstacle: from its first force above `contact_force`, or push with a moment above
/// `contact_moment`, to the last, where interruptions shorter than `same_contact` do not count. A push is a
/// contact by itself only where no obstacle touches; else it counts with what touches hardest.
struct ContactVerdict {
  std::string body;   ///< "platform", "leg1_link2"; "leg1_clamping" where both links of a leg are touched;
                      ///< "" where nobody saw
  int obstacle = -1;  ///< by its place in the list of obstacles; -1: none seen, or pushes were harder
  std::string obstacle_name;  ///< its name; "" where nobody knows
  bool is_push = false;  ///< something pushed the platform without touching it, as a scenario may ask for
  double onset = 0.0;    ///< t_c, when the force rose above `contact_force`, between samples [s]
  /// t_det, when the estimate reached the reaction threshold [s]. It may be above it for another contact:
  /// what is detected once counts for all that have begun and are not over.
  std::optional<double> detected;
  /// The same for every estimator that ran, as by a contact detector that followed it; first that which the
  /// robot followed.
  std::vector<DetectionBy> detected_by;
  /// What the robot first took for touched, and acted upon; "" where it was never sure enough.
  std::string classified;
  std::optional<double> classified_at;  ///< when [s]
  double probability = 0.0;             ///< that it gave to this
  /// Whether the robot, in what it said last, found the wrench such as no single contact makes; none: its
  /// classifier said nothing, or does not look.
  std::optional<bool> several_contacts;
  std::optional<double> location_error;  ///< of where it placed the contact then [m]; none: it did not know
  std::optional<double> force_error;     ///< of the force there [N], likewise
  /// How many contacts wrench and base forces together were taken for, `LocatedContacts::settled` after the
  /// detection; none: there are no such sensors, or it was over by then.
  std::optional<int> contacts_located;
  std::optional<double> base_location_error;  ///< of the nearest of these [m]
  /// Whether the robot could still stop within the limits that it keeps when it detected the contact; none:
  /// it was not in its nominal motion, or keeps none.
  std::optional<bool> could_stop;
  std::optional<double> stop_duration;  ///< of the shortest straight stop from there [s]; none: none possible
  /// What the reaction followed since it was detected, one after the other; empty: it did not react, or
  /// serves no tasks.
  std::vector<TaskBegin> reaction_tasks;
  std::optional<double> removed;        ///< t_rem; none: still touching at the end [s]
  double speed = 0.0;                   ///< of the platform at the onset [m/s]
  double peak_force = 0.0;              ///< of one touching body [N]
  double peak_time = 0.0;               ///< [s]
  std::optional<double> lasting_force;  ///< the largest after the transient duration, if it lasts so long [N]
  /// Of the peak force: transient, or quasi-static where only the lasting force fails [N].
  double limit = 0.0;
  std::string limit_name;
  bool within_limit = false;  ///< both forces are
  double over_limit = 0.0;    ///< how long the force was above the limit of its time [s]
};

/// Two bodies of the robot that touched one another, by name; "" where nobody knows which.
struct SelfContact {
  std::string body{};
  std::string other{};
  double since = 0.0;  ///< first [s]
};

/// How far a measure of the workspace went.
struct MeasureRange {
  double first = 0.0;
  double least = 0.0;
  double most = 0.0;
  double last = 0.0;
};

/// How far both measures that laws keep within limits went, over a part of a run; none: nobody recorded
/// them, or there is no such part.
struct MeasureRanges {
  std::optional<MeasureRange> sigma_kappa;
  std::optional<MeasureRange> sigma_sc;  ///< [m]
};

/// How an operator brought the robot back to its nominal motion, from the first reset on after something had
/// interrupted that.
struct Return {
  double reset = 0.0;               ///< when that button went down [s]
  std::string from{};               ///< "hold", "zero_g", "react" or "stopped", where the gate was not open
  std::string stopped_by{};         ///< for which fault; "" none
  std::optional<double> resumed{};  ///< when `start` set it off to the begin of its motion [s]; none: never
  int resets = 1;                   ///< until then
  int reactions = 0;                ///< new ones until then
  double recovery_speed = 0.0;      ///< of the platform, the largest in the mode `recover` until then [m/s]
  double nominal_speed = 0.0;       ///< likewise in the mode `nominal`
  std::string fault{};              ///< why the gate closed again, whenever; "" it did not
};

/// What a verdict rests on, besides what the controller itself says.
enum class Witness {
  truth,         ///< the simulation: exact, for verdicts only
  force_torque,  ///< the sensor below the pylon, as in [SafePR]; motions are those that the controller
                 ///< measured
  none,          ///< nothing: contacts are not judged, and errors only until the first detection
};

/// How late the computer of a controller was in a run in real time.
struct ComputerLateness {
  std::int64_t ticks_lost = 0;
  std::optional<double> p99;  ///< of the starts of ticks, 99 of 100 were less late [s]; none: not known
};

/// What a run shows, judged.
struct Verdict {
  static constexpr double contact_force = 1.0;  ///< below it there is no contact, as in the papers [N]
  /// Below it nothing turns the platform: `contact_force` at a coupling joint, a tenth of a metre away [Nm].
  static constexpr double contact_moment = 0.1;
  static constexpr double same_contact = 0.1;  ///< [s]

  Witness witness = Witness::truth;
  ForceLimits limits;  ///< that contacts are judged by
  std::vector<ContactVerdict> contacts;
  /// When each estimator first detected anything at all, in the order of `ContactVerdict::detected_by`.
  std::vector<DetectionBy> first_detected;
  std::vector<double> detections;  ///< when the detector detected something after it had been quiet [s]
  int false_detections = 0;        ///< while nothing has touched the robot in the last `same_contact`
  double max_observer_error_force = 0.0;   ///< of any component, before anything touches the robot [N]
  double max_observer_error_moment = 0.0;  ///< [Nm]
  double max_tracking_error = 0.0;         ///< in the nominal mode, before anything touches the robot [m]
  double max_orientation_error = 0.0;      ///< likewise [rad]
  std::optional<double> loop_closure;      ///< largest miss of a leg; of simulations [m]
  MeasureRanges measures;                  ///< of the whole run
  MeasureRanges measures_once_detected;    ///< from the first detection on
  std::vector<SelfContact> self_contacts;  ///< each pair once, in the order of their first times
  std::optional<double> largest_torque;    ///< that any drive was told [Nm or N]; none: none was, or recorded
  std::string fault;                       ///< why the torque gate closed; "" if it did not
  /// The first doubt about the IMU, and when it came up [s]; none: it was believed.
  ImuFault imu_doubt = ImuFault::none;
  double imu_doubted = 0.0;
  std::optional<Return> returned;            ///< none: no operator has reset an interrupted robot
  std::optional<double> passive_lost;        ///< when the passive encoders were lost [s]; none: they were not
  double simulated = 0.0;                    ///< [s]
  std::optional<ComputerLateness> computer;  ///< none: no clock took part, or the recording does not tell
  DriveCheckStatus drive_check;              ///< of the drives before the first motion, as it ended
  /// What could not be asked of sensors and drives at any time, one sentence each; empty: everything could,
  /// or the recording does not tell.
  std::vector<std::string> checks_off;

  std::vector<std::string> failures;  ///< why the verdict is bad, one sentence each; empty: it is good
  std::vector<std::string> remarks;   ///< what a reader must know of a good verdict as well, likewise
  bool good() const { return failures.empty(); }
};

/// Judges what was recorded of a robot with this space of configurations, by the best witness that the
/// recording holds. `progress` is told now and then what share of it was read. Throws SetupError when signals
/// are missing.
Verdict judge(const Recording& recording, const ConfigurationSpace& space, const Expectations& expected,
              const ForceLimits& limits, const std::function<void(double share)>& progress = {});

/// What a computer that lost ticks says first of all; "" where it lost none.
std::string lateness_sentence(const Verdict& verdict);

/// The same for a run that was watched, up to the sample seen last.
Verdict judge(const RunMonitor& watch, const Expectations& expected);

}  // namespace flinch
