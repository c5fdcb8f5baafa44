#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "systems/framework/recording.h"

namespace flinch {

struct Scenario;

/// Whether a recording is a log: readings of another controller, and no run.
bool holds_readings_alone(const Recording& recording);

/// What somebody knows of a log.
struct LogTruth {
  struct Stretch {
    double from = 0.0;  ///< [s]
    double to = 0.0;

    bool contains(double at) const { return from <= at && at < to; }
  };
  std::vector<Stretch> free;     ///< nothing touches the robot
  std::vector<double> contacts;  ///< when one begins [s]
  /// Contacts with their ends, where a force sensor tells them.
  std::vector<Stretch> measured{};
  std::string source = "marked by the user";  ///< Who says so, a phrase.
};

/// What detectors made of a log.
struct JudgedLog {
  struct Detection {
    std::string by;   ///< the estimator that a contact detector follows, or the detector
    double at = 0.0;  ///< [s]
  };
  struct Fault {
    std::string name;  ///< as the fault table describes it
    double at = 0.0;
  };
  /// A leg whose elbow is on another side from then on.
  struct Fold {
    int leg = 0;  ///< from 0
    double at = 0.0;
  };
  double seconds = 0.0;
  double free_seconds = 0.0;                        ///< in which false alarms were counted
  double pose_known = 0.0;                          ///< fraction of the ticks
  std::vector<std::string> by;                      ///< whatever detects, the one that is followed first
  std::vector<std::string> signals;                 ///< of each, in the recording that a watch sees
  std::vector<Detection> detections;                ///< in the order of time
  std::map<std::string, std::size_t> false_alarms;  ///< in what is free
  /// Of each contact, from its begin; none: missed before the next one.
  std::map<std::string, std::vector<std::optional<double>>> delays;
  std::vector<Fault> faults;     ///< that would have closed the torque gate
  bool folds_from_home = false;  ///< The log begins with an elbow on another side than the robot file says.
  std::vector<Fold> folds;       ///< a type-I singularity lies at each

  /// How many detections are by that one.
  std::size_t count_by(const std::string& name) const;
};

/// Who looks at the signals of a run over a log.
struct SignalMonitor {
  std::function<bool(const std::string& path)> wants{};  ///< signals; "motion" and "gate" come in any case
  std::function<void(const Recording& latest)> see{};    ///< some samples at a time; none: nobody looks
};

/// Runs the control path of a scenario open loop over readings, and tells when each of its estimators and
/// detectors detected something after 0.1 s in which it had detected nothing. Where a log without passive
/// angles passes the fold of a leg, the control path begins anew with that elbow on its other side. Throws
/// SetupError as replay() does, and for a truth that is none of this log.
JudgedLog judge_log(const Scenario& scenario, const std::shared_ptr<const Recording>& readings,
                    const LogTruth& truth, const SignalMonitor& watch = {},
                    const std::function<void(double share)>& progress = {});

/// Those signals of a run over a log that are wanted, a sample for each tick of the control path. Throws
/// SetupError as judge_log().
Recording signals_of_log(const Scenario& scenario, const std::shared_ptr<const Recording>& readings,
                         const std::function<bool(const std::string& path)>& wants,
                         const std::function<void(double share)>& progress = {});

/// What every estimator of the scenario says over a log: "wrench" of that which is followed, "wrench_NAME" of
/// the others, "motion", and "load_NAME" of a detector that judges the drives' residuals, a sample for each
/// tick of the control path. Throws SetupError as judge_log().
Recording estimates_of_log(const Scenario& scenario, const std::shared_ptr<const Recording>& readings,
                           const std::function<void(double share)>& progress = {});

}  // namespace flinch
