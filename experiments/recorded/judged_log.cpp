#include "experiments/recorded/judged_log.h"

#include <algorithm>
#include <cmath>

#include "diagrams/contact_control.h"
#include "experiments/recorded/completed_readings.h"
#include "experiments/recorded/recorded_signals.h"
#include "experiments/recorded/replay.h"
#include "experiments/scenario/scenario.h"
#include "experiments/verdict/fault_words.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recorded_values.h"
#include "systems/framework/recorder.h"
#include "systems/framework/simulator.h"
#include "systems/robot/kinematic_check.h"
#include "systems/robot/quantity_units.h"
#include "systems/signals/contact_detection.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/platform_motion.h"

namespace flinch {
namespace {

constexpr std::size_t samples_at_once = 256;
constexpr double quiet = 0.1;  ///< after which a detection is another one [s]

/// A signal of detections, and by whom they are.
struct Detector {
  std::string path;
  std::string by;
  double last = -1e9;  ///< when it detected something last [s]
};

std::vector<Detector> detectors_of(const Diagram& diagram, const Scenario& scenario) {
  const std::string followed = followed_name(scenario.control.stages.detectors);
  std::vector<Detector> all = {{"detection", followed == "contact_detector"
                                                 ? followed_name(scenario.control.stages.estimators)
                                                 : followed}};
  constexpr std::string_view by = "detection_by_", other = "detection_";
  for (const std::string& path : recorded_paths(diagram)) {
    if (path.starts_with(by)) {
      all.push_back({path, path.substr(by.size())});
    } else if (path.starts_with(other)) {
      all.push_back({path, path.substr(other.size())});
    }
  }
  return all;
}

/// What is seen of a run, some samples at a time.
class LogMonitor {
 public:
  /// `has_reference`: the log is of a robot that followed this control path's own references.
  LogMonitor(std::vector<Detector> detectors, bool has_reference, JudgedLog& judged)
      : detectors_(std::move(detectors)), has_reference_(has_reference), judged_(judged) {}

  void see(const Recording& latest) {
    const auto gates = read<GateStatus>(latest, "gate");
    const auto motions = read<PlatformMotion>(latest, "motion");
    for (Detector& detector : detectors_) see(latest, detector);
    for (std::size_t k = 0; k < latest.samples(); ++k) {
      const GateStatus gate = gates[k];
      const bool is_asked = has_reference_ || gate.fault != GateFault::control_error;
      if (gate.phase == GatePhase::closed && !was_closed_ && is_asked)
        judged_.faults.push_back({description_of(gate.fault), seconds(latest, k)});
      was_closed_ = gate.phase == GatePhase::closed;
      poses_ += motions[k].valid() ? 1 : 0;
      ++ticks_;
    }
    judged_.pose_known = static_cast<double>(poses_) / static_cast<double>(std::max<std::size_t>(ticks_, 1));
  }

 private:
  static double seconds(const Recording& latest, std::size_t k) {
    return 1e-9 * static_cast<double>(latest.time_ns[k]);
  }

  void see(const Recording& latest, Detector& detector) {
    const auto values = read<ContactDetection>(latest, detector.path);
    for (std::size_t k = 0; k < latest.samples(); ++k) {
      const ContactDetection detection = values[k];
      if (!detection.valid || detection.present_level == ContactLevel::none) continue;
      const double now = seconds(latest, k);
      if (now - detector.last > quiet) judged_.detections.push_back({detector.by, now});
      detector.last = now;
    }
  }

  std::vector<Detector> detectors_;
  bool has_reference_;
  JudgedLog& judged_;
  bool was_closed_ = false;
  std::size_t poses_ = 0;
  std::size_t ticks_ = 0;
};

/// Ticks in which the robot is assembled in one way.
struct LogPart {
  Scenario scenario;
  std::size_t first = 0;
  std::size_t end = 0;
};

/// The drives' angles where they are valid, and in which sample.
struct DriveAngles {
  std::vector<JointVector> active;
  std::vector<std::size_t> sample;
  bool has_passive = false;  ///< in any sample
};

DriveAngles drive_angles(const Recording& readings) {
  const auto joints = read<JointReading>(readings, "joints");
  DriveAngles angles;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const JointReading reading = joints[k];
    angles.has_passive = angles.has_passive || reading.passive_valid;
    if (!reading.valid) continue;
    angles.active.push_back(reading.active);
    angles.sample.push_back(k);
  }
  return angles;
}

/// The limits of the workspace are said for the elbows as they are at home.
void leave_limits_out(ContactControlSettings& control) {
  control.faults.workspace = WorkspaceLimits();
  control.limits.limits.workspace = WorkspaceLimits();
}

/// Without passive angles nothing tells where the platform is at first: it is looked for from its home pose,
/// with elbows on any side, and followed through the folds of legs.
std::vector<LogPart> parts_of(const Scenario& scenario, const Recording& readings, const Recording& ticks,
                              JudgedLog& judged) {
  std::vector<LogPart> parts = {{scenario, 0, ticks.samples()}};
  const DriveAngles angles = drive_angles(readings);
  auto& begin = parts.front().scenario.control.forward_kinematics.initial_pose;
  if (angles.has_passive || begin) return parts;
  const ParallelRobot& robot = *scenario.robot.robot;
  begin = robot.home_pose();
  const KinematicCheck check = check_kinematics(robot, angles.active);
  const auto time_of = [&](std::size_t row) { return readings.time_ns[angles.sample[row]]; };
  std::vector<LogPart> assembled;
  for (const KinematicCheck::Stretch& stretch : check.stretches) {
    LogPart part{scenario, 0, ticks.samples()};
    part.scenario.robot.robot = robot.assembled_as(stretch.mode);
    if (part.scenario.robot.robot == nullptr) return parts;
    part.scenario.control.forward_kinematics.initial_pose = stretch.pose;
    if (stretch.mode != robot.home_working_mode()) leave_limits_out(part.scenario.control);
    if (!assembled.empty()) {
      const auto tick = std::lower_bound(ticks.time_ns.begin(), ticks.time_ns.end(), time_of(stretch.first));
      part.first = static_cast<std::size_t>(tick - ticks.time_ns.begin());
      assembled.back().end = part.first;
    }
    assembled.push_back(std::move(part));
  }
  if (assembled.empty()) return parts;
  judged.folds_from_home = check.folds_from_home(robot);
  for (const KinematicCheck::Fold& fold : check.folds())
    judged.folds.push_back({fold.leg, 1e-9 * static_cast<double>(time_of(fold.row))});
  return assembled;
}

void check(const LogTruth& truth, double first, double last) {
  std::vector<std::string> problems;
  const auto require = [&](bool good, const std::string& problem) {
    if (!good)
      problems.push_back(problem + "; the log goes from " + std::to_string(first) + " to " +
                         std::to_string(last) + " s");
  };
  for (const LogTruth::Stretch& stretch : truth.free) {
    require(stretch.from < stretch.to && stretch.from >= first - 1e-9 && stretch.from < last,
            "--free: " + std::to_string(stretch.from) + ".." + std::to_string(stretch.to) +
                " is no stretch of it");
    for (const double contact : truth.contacts)
      require(!stretch.contains(contact),
              "--contact: begins at " + std::to_string(contact) + " s, which --free says is free");
  }
  for (const double contact : truth.contacts)
    require(contact >= first && contact <= last,
            "--contact: " + std::to_string(contact) + " s is not within it");
  throw_if_any(std::move(problems));
}

void compare(const LogTruth& truth, double end, JudgedLog& judged) {
  for (const LogTruth::Stretch& stretch : truth.free)
    judged.free_seconds += std::min(stretch.to, end) - stretch.from;
  std::vector<double> contacts = truth.contacts;
  std::sort(contacts.begin(), contacts.end());
  for (const std::string& by : judged.by) {
    std::size_t& alarms = judged.false_alarms[by];
    std::vector<std::optional<double>>& delays = judged.delays[by];
    delays.resize(contacts.size());
    for (const JudgedLog::Detection& detection : judged.detections) {
      if (detection.by != by) continue;
      alarms += std::any_of(truth.free.begin(), truth.free.end(),
                            [&](const LogTruth::Stretch& stretch) { return stretch.contains(detection.at); });
      for (std::size_t i = contacts.size(); i-- > 0;) {
        if (detection.at < contacts[i]) continue;
        if (!delays[i]) delays[i] = detection.at - contacts[i];
        break;
      }
    }
  }
}

/// The control path over the ticks of one part.
class PartOfLog {
 public:
  PartOfLog(const LogPart& part, const Recording& ticks, const SignalMonitor& watch)
      : part_(part), ticks_(ticks), diagram_(build_replay(part.scenario, ticks)) {
    std::vector<std::string> paths = recorded_paths(*diagram_);
    std::erase_if(paths, [&watch](const std::string& path) {
      const bool is_judged = path == "gate" || path == "motion" || path.starts_with("detection");
      return !is_judged && !(watch.see && watch.wants(path));
    });
    recorder_ = std::make_unique<Recorder>(*diagram_, paths, samples_at_once,
                                           quantity_units(*part.scenario.robot.robot));
  }

  std::vector<Detector> detectors() const { return detectors_of(*diagram_, part_.scenario); }

  /// Calls `look(latest)` for some samples at a time, and `progress(tick)` now and then.
  void run(const std::function<void(const Recording& latest)>& look,
           const std::function<void(std::size_t tick)>& progress) {
    Recording latest = recorder_->description();
    const auto hand_on = [&] {
      latest.time_ns.clear();
      for (Signal& signal : latest.signals) signal.rows.clear();
      latest.append(recorder_->front());
      recorder_->clear();
      look(latest);
    };
    Simulator simulator(*diagram_);
    simulator.record(*recorder_);
    Context context = diagram_->make_context();
    for (std::size_t tick = part_.first; tick < part_.end; ++tick) {
      context.set_time(Time(ticks_.time_ns[tick]));
      simulator.step(context);
      if (recorder_->samples() == samples_at_once) hand_on();
      if (tick % 1000 == 0) progress(tick);
    }
    hand_on();
  }

 private:
  const LogPart& part_;
  const Recording& ticks_;
  std::unique_ptr<Diagram> diagram_;
  std::unique_ptr<Recorder> recorder_;
};

}  // namespace

bool holds_readings_alone(const Recording& recording) {
  return recording.find("detection") == nullptr && recording.find("gate") == nullptr;
}

std::size_t JudgedLog::count_by(const std::string& name) const {
  return static_cast<std::size_t>(std::count_if(detections.begin(), detections.end(),
                                                [&](const Detection& each) { return each.by == name; }));
}

JudgedLog judge_log(const Scenario& scenario, const std::shared_ptr<const Recording>& readings,
                    const LogTruth& truth, const SignalMonitor& watch,
                    const std::function<void(double share)>& progress) {
  if (readings->samples() == 0) throw SetupError("the log has no samples");
  const double first = 1e-9 * static_cast<double>(readings->time_ns.front());
  const double last = 1e-9 * static_cast<double>(readings->time_ns.back());
  check(truth, first, last);
  const Recording ticks = completed_readings(readings, scenario.control_period);
  JudgedLog judged;
  judged.seconds = last - first;
  std::unique_ptr<LogMonitor> seen;
  for (const LogPart& part : parts_of(scenario, *readings, ticks, judged)) {
    PartOfLog path(part, ticks, watch);
    if (seen == nullptr) {
      std::vector<Detector> detectors = path.detectors();
      for (const Detector& detector : detectors) {
        judged.by.push_back(detector.by);
        judged.signals.push_back(detector.path);
      }
      seen =
          std::make_unique<LogMonitor>(std::move(detectors), readings->find("reference") != nullptr, judged);
    }
    path.run(
        [&](const Recording& latest) {
          seen->see(latest);
          if (watch.see) watch.see(latest);
        },
        [&](std::size_t tick) {
          if (progress) progress(static_cast<double>(tick) / static_cast<double>(ticks.samples()));
        });
  }
  std::stable_sort(judged.detections.begin(), judged.detections.end(),
                   [](const auto& a, const auto& b) { return a.at < b.at; });
  compare(truth, last, judged);
  return judged;
}

Recording signals_of_log(const Scenario& scenario, const std::shared_ptr<const Recording>& readings,
                         const std::function<bool(const std::string& path)>& wants,
                         const std::function<void(double share)>& progress) {
  Recording kept;
  kept.period = scenario.control_period;
  kept.attributes["control.estimator"] = followed_name(scenario.control.stages.estimators);
  const auto keep = [&](const Recording& latest) {
    if (kept.signals.empty()) {
      for (const Signal& signal : latest.signals) {
        if (wants(signal.path)) kept.signals.push_back({signal.path, signal.layout, {}});
      }
    }
    kept.time_ns.insert(kept.time_ns.end(), latest.time_ns.begin(), latest.time_ns.end());
    for (Signal& signal : kept.signals) {
      const std::vector<internal::Number>& rows = latest.signal(signal.path).rows;
      signal.rows.insert(signal.rows.end(), rows.begin(), rows.end());
    }
  };
  judge_log(scenario, readings, {}, {wants, keep}, progress);
  return kept;
}

Recording estimates_of_log(const Scenario& scenario, const std::shared_ptr<const Recording>& readings,
                           const std::function<void(double share)>& progress) {
  const auto is_estimate = [](const std::string& path) {
    return path == "motion" || path.starts_with("wrench") || path.starts_with("load_");
  };
  return signals_of_log(scenario, readings, is_estimate, progress);
}

}  // namespace flinch
