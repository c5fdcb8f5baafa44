#include "experiments/verdict/recorded_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <sstream>

#include "diagrams/link_status.h"
#include "experiments/verdict/recorded_classification.h"
#include "experiments/verdict/recorded_estimate.h"
#include "experiments/verdict/recorded_sensor_faults.h"
#include "experiments/verdict/recorded_truth.h"
#include "systems/framework/recorded_values.h"
#include "systems/framework/tick_timing.h"
#include "systems/robot/body_id.h"
#include "systems/signals/contact_classes.h"
#include "systems/signals/force_torque_reading.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/platform_reference.h"
#include "systems/signals/torque_command.h"
#include "systems/signals/workspace_measures.h"

namespace flinch {
namespace {

Witness witness_of(const Recording& recording) {
  if (recording.find("contact") != nullptr || recording.find("truth") != nullptr) return Witness::truth;
  return recording.find("force_torque") != nullptr ? Witness::force_torque : Witness::none;
}

const std::string detection_by = "detection_by_";  // + an estimator, with a contact detector after it
const std::string detection_of = "detection_";     // + a detector

std::string attribute(const Recording& recording, const std::string& name) {
  const auto found = recording.attributes.find(name);
  return found == recording.attributes.end() ? "" : found->second;
}

/// What a detector is told as: a contact detector by the estimator that it follows, another by its own name.
std::string told_as(const std::string& detector, const std::string& estimator) {
  return detector.empty() || detector == "contact_detector" ? estimator : detector;
}

/// The name and the signal of every detector, first of the one that the robot follows.
std::vector<std::pair<std::string, std::string>> detections_of(const Recording& recording) {
  const std::string estimator = attribute(recording, "control.estimator");
  std::vector<std::pair<std::string, std::string>> found = {
      {told_as(attribute(recording, "control.detector"), estimator), "detection"}};
  for (const auto& [path, layout, rows] : recording.signals) {
    if (path.starts_with(detection_by)) {
      found.emplace_back(path.substr(detection_by.size()), path);
    } else if (path.starts_with(detection_of)) {
      found.emplace_back(told_as(path.substr(detection_of.size()), estimator), path);
    }
  }
  return found;
}

std::vector<std::string> class_names_of(const Recording& recording) {
  const auto attribute = recording.attributes.find("contact.classes");
  if (attribute == recording.attributes.end()) return {};
  std::istringstream text(attribute->second);
  return {std::istream_iterator<std::string>(text), {}};
}

/// Force and moment of a wrench [N, Nm]; none where it has another size.
struct Strength {
  Strength(const PlatformVector& wrench, ConfigurationSpace space) {
    if (wrench.size() != space.dimension()) return;
    force = wrench.head(space.translations()).norm();
    moment = wrench.tail(space.rotations()).norm();
  }

  double force = 0.0;
  double moment = 0.0;
};

void compare_estimate(const PlatformVector& estimate, const PlatformVector& external,
                      ConfigurationSpace space, RunSample& now) {
  if (estimate.size() != space.dimension() || external.size() != space.dimension()) return;
  const PlatformVector error = estimate - external;
  now.observer_error_force = largest_component(error.head(space.translations()));
  now.observer_error_moment = largest_component(error.tail(space.rotations()));
}

/// The leg whose links an obstacle both touches, as far as touches are listed; -1: none.
int clamped_leg(int obstacle, const std::vector<RecordedTouch>& touches) {
  for (const RecordedTouch& a : touches) {
    for (const RecordedTouch& b : touches) {
      if (a.obstacle != obstacle || b.obstacle != obstacle || a.body >= b.body) continue;
      const int leg = BodyId::from_index(a.body).leg();
      if (leg >= 0 && leg == BodyId::from_index(b.body).leg()) return leg;
    }
  }
  return -1;
}

RunLoad load_of(const RecordedTouch& touch) {
  return {.obstacle = touch.obstacle,
          .body = touch.body,
          .contact_force = touch.force_in_base.norm(),
          .touched_point = touch.point_in_base,
          .touched_force = touch.force_in_base};
}

/// The hardest touch of each obstacle. Where but one touches, its clamping counts whatever is listed.
std::vector<RunLoad> loads_of(const RecordedContact& contact, const std::vector<RecordedTouch>& touches) {
  std::vector<RunLoad> loads{load_of(contact.strongest)};
  for (const RecordedTouch& touch : touches) {
    const auto same = [&touch](const RunLoad& load) { return load.obstacle == touch.obstacle; };
    if (std::none_of(loads.begin(), loads.end(), same)) loads.push_back(load_of(touch));
  }
  if (!contact.clamping) return loads;
  for (RunLoad& load : loads) load.clamped_leg = clamped_leg(load.obstacle, touches);
  RunLoad& hardest = loads.front();
  if (loads.size() == 1 && hardest.clamped_leg < 0)
    hardest.clamped_leg = BodyId::from_index(hardest.body).leg();
  return loads;
}

void add_truth(const RecordedTruth& truth, const RecordedContact& contact, ConfigurationSpace space,
               RunSample& now) {
  now.is_true = true;
  now.loop_closure = truth.loop_closure_error;
  const Strength external(truth.wrench_in_base, space);
  now.external_force = external.force;
  now.external_moment = external.moment;
  if (contact.wrench_in_base.size() != truth.wrench_in_base.size()) return;
  const Strength push(truth.wrench_in_base - contact.wrench_in_base, space);
  now.loads.front().push_force = push.force;
  now.loads.front().push_moment = push.moment;
}

void compare_motion(const Configuration& pose, const PlatformVector& velocity, const Configuration& reference,
                    ConfigurationSpace space, RunSample& now) {
  const PlatformVector error = space.difference(pose, reference);
  now.position_error = error.head(space.translations()).norm();
  now.orientation_error = error.tail(space.rotations()).norm();
  const bool has_velocity = velocity.size() == space.dimension();
  now.speed = has_velocity ? velocity.head(space.translations()).norm() : std::nan("");
}

}  // namespace

bool is_judged(const std::string& path) {
  static constexpr std::array judged = {
      "detection",    "reaction",        "wrench",        "reference",      "gate",
      "truth",        "contact",         "location",      "classification", "true_measures",
      "plausibility", "braking",         "reaction_task", "torque_command", "operator",
      "drive_check",  "located_contacts"};
  return path.starts_with(detection_of) || std::find(judged.begin(), judged.end(), path) != judged.end();
}

/// Those that the witness has.
struct RecordedRun::Signals {
  Signals(const Recording& recording, Witness witness,
          const std::vector<std::pair<std::string, std::string>>& detections)
      : detection(recording, "detection"),
        reaction(recording, "reaction"),
        wrench(recording, "wrench"),
        reference(recording, "reference"),
        gate(recording, "gate") {
    for (std::size_t i = 1; i < detections.size(); ++i)
      detections_by.emplace_back(recording, detections[i].second);
    class_names = class_names_of(recording);
    if (recording.find("classification") != nullptr) classification.emplace(recording, "classification");
    if (records(recording, "classification", "residual")) residual.emplace(recording, "classification");
    if (recording.find("location") != nullptr) location.emplace(recording, "location");
    const bool is_true = witness == Witness::truth && recording.find("true_measures") != nullptr;
    const char* const measured = is_true ? "true_measures" : "measures";
    if (recording.find(measured) != nullptr) measures.emplace(recording, measured);
    if (recording.find("torque_command") != nullptr) torque_command.emplace(recording, "torque_command");
    if (recording.find("operator") != nullptr) buttons.emplace(recording, "operator");
    if (recording.find("braking") != nullptr) braking.emplace(recording, "braking");
    if (recording.find("reaction_task") != nullptr) task.emplace(recording, "reaction_task");
    if (records(recording, "contact", "further.0.body")) further.emplace(recording, "contact");
    if (records(recording, "contact", "self_contact")) self_contact.emplace(recording, "contact");
    if (records(recording, "contact", "self_body")) self_bodies.emplace(recording, "contact");
    if (records(recording, "plausibility", "imu_doubt")) doubts.emplace(recording, "plausibility");
    if (records(recording, "plausibility", "askable")) askable.emplace(recording, "plausibility");
    if (recording.find("drive_check") != nullptr) drive_check.emplace(recording, "drive_check");
    if (recording.find("located_contacts") != nullptr) located.emplace(recording, "located_contacts");
    if (recording.find("tick_timing") != nullptr) timing.emplace(recording, "tick_timing");
    if (recording.find("joints_link") != nullptr) joints_link.emplace(recording, "joints_link");
    if (witness == Witness::truth) {
      contact.emplace(recording, "contact");
      truth.emplace(recording, "truth");
      return;
    }
    if (witness == Witness::force_torque) force_torque.emplace(recording, "force_torque");
    motion.emplace(recording, "motion");
  }

  RecordedValues<ContactDetection> detection;
  RecordedValues<ReactionState> reaction;
  std::vector<RecordedValues<ContactDetection>> detections_by;
  RecordedValues<RecordedEstimate> wrench;
  RecordedValues<PlatformReference> reference;
  RecordedValues<GateStatus> gate;
  std::optional<RecordedValues<RecordedSensorFaults>> doubts;
  std::optional<RecordedValues<RecordedAskable>> askable;
  std::optional<RecordedValues<DriveCheckStatus>> drive_check;
  std::optional<RecordedValues<LocatedContacts>> located;
  std::vector<std::string> class_names;  // of what can be touched
  std::optional<RecordedValues<RecordedClassification>> classification;
  std::optional<RecordedValues<RecordedResidual>> residual;
  std::optional<RecordedValues<ContactLocation>> location;
  std::optional<RecordedValues<WorkspaceMeasures>> measures;
  std::optional<RecordedValues<TorqueCommand>> torque_command;
  std::optional<RecordedValues<BrakingStatus>> braking;
  std::optional<RecordedValues<OperatorCommand>> buttons;
  std::optional<RecordedValues<FollowedTask>> task;
  std::optional<RecordedValues<RecordedSelfContact>> self_contact;
  std::optional<RecordedValues<RecordedSelfBodies>> self_bodies;
  std::optional<RecordedValues<RecordedContact>> contact;
  std::optional<RecordedValues<RecordedFurtherTouches>> further;
  std::optional<RecordedValues<RecordedTruth>> truth;
  std::optional<RecordedValues<ForceTorqueReading>> force_torque;
  std::optional<RecordedValues<PlatformMotion>> motion;
  std::optional<RecordedValues<TickTiming>> timing;
  std::optional<RecordedValues<LinkStatus>> joints_link;

  std::vector<RunLoad> loads(std::size_t sample, const RecordedContact& touched) const {
    std::vector<RecordedTouch> touches{touched.strongest, touched.second};
    if (further) {
      for (const RecordedTouch& touch : (*further)[sample].further) touches.push_back(touch);
    }
    std::erase_if(touches, [](const RecordedTouch& touch) { return touch.body < 0; });
    return loads_of(touched, touches);
  }

  /// What the robot takes for touched, where it says so.
  void add_classification(std::size_t sample, RunSample& now) const {
    if (!classification) return;
    const RecordedClassification said = (*classification)[sample];
    const auto number = static_cast<std::size_t>(said.most_likely);
    if (said.valid && said.accepted && number < class_names.size()) {
      now.classified = class_names[number];
      now.probability = said.confidence();
    }
    const bool looks = residual && (*residual)[sample].residual >= 0.0;
    if (said.valid && (looks || said.several_contacts)) now.several_contacts = said.several_contacts;
  }

  /// Nothing where no bodies of the robot touch one another.
  std::optional<SelfContact> self_touch(std::size_t sample) const {
    if (!self_contact || !(*self_contact)[sample].self_contact) return std::nullopt;
    SelfContact touch{.since = 0.0};
    if (!self_bodies) return touch;
    const RecordedSelfBodies bodies = (*self_bodies)[sample];
    touch.body = body_name(BodyId::from_index(bodies.self_body));
    touch.other = body_name(BodyId::from_index(bodies.self_other));
    return touch;
  }
};

RecordedRun::RecordedRun(const Recording& recording, ConfigurationSpace space)
    : recording_(recording),
      space_(space),
      witness_(witness_of(recording)),
      signals_(std::make_unique<Signals>(recording, witness_, detections_of(recording))) {
  for (const auto& [name, path] : detections_of(recording)) estimators_.push_back(name);
  for (int number = 1;; ++number) {
    const std::string name = attribute(recording, "obstacle." + std::to_string(number) + ".name");
    if (name.empty()) break;
    obstacles_.push_back(name);
  }
}

RecordedRun::~RecordedRun() = default;

std::size_t RecordedRun::size() const { return recording_.samples(); }

double RecordedRun::period() const { return to_seconds(recording_.period); }

double RecordedRun::duration() const {
  if (size() == 0) return 0.0;
  return to_seconds(Time(recording_.time_ns.back())) - to_seconds(Time(recording_.time_ns.front())) +
         period();
}

RunSample RecordedRun::operator[](std::size_t sample) const {
  const Signals& signals = *signals_;
  RunSample now;
  now.time = to_seconds(Time(recording_.time_ns[sample]));
  now.detection = signals.detection[sample];
  now.detected_by.push_back(now.detection.present_level != ContactLevel::none);
  for (const auto& detection : signals.detections_by) {
    now.detected_by.push_back(detection[sample].present_level != ContactLevel::none);
  }
  now.mode = signals.reaction[sample].mode;
  if (signals.task) now.task = (*signals.task)[sample];
  now.gate = signals.gate[sample];
  const bool is_detected = now.detection.level != ContactLevel::none;
  if (signals.braking && is_detected) now.braking = (*signals.braking)[sample];
  if (signals.located) now.located = (*signals.located)[sample];
  if (signals.doubts) now.doubts = (*signals.doubts)[sample];
  if (signals.askable) now.askable = (*signals.askable)[sample].askable;
  if (signals.drive_check) now.drive_check = (*signals.drive_check)[sample];
  if (signals.timing) now.lost_ticks = static_cast<int>((*signals.timing)[sample].lost_periods);
  if (signals.joints_link) now.unread_readings = static_cast<int>((*signals.joints_link)[sample].skipped);
  signals.add_classification(sample, now);
  if (signals.location) now.location = (*signals.location)[sample];
  const RecordedEstimate estimate = signals.wrench[sample];
  now.estimate_valid = estimate.valid;
  if (signals.measures) {
    const WorkspaceMeasures measures = (*signals.measures)[sample];
    if (measures.valid) {
      now.sigma_kappa = measures.sigma_kappa;
      now.sigma_sc = measures.sigma_sc;
    }
  }
  if (signals.torque_command) {
    const TorqueCommand command = (*signals.torque_command)[sample];
    if (command.valid) now.drive_torque = largest_component(command.torque);
  }
  now.self_contact = signals.self_touch(sample);
  const PlatformReference reference = signals.reference[sample];
  now.reference_valid = reference.valid;
  now.reference_rests = reference.finished;
  if (signals.buttons) now.pressed = (*signals.buttons)[sample];
  if (signals.truth) {
    const RecordedTruth truth = (*signals.truth)[sample];
    const RecordedContact contact = (*signals.contact)[sample];
    now.loads = signals.loads(sample, contact);
    add_truth(truth, contact, space_, now);
    compare_estimate(estimate.wrench_in_base, truth.wrench_in_base, space_, now);
    compare_motion(truth.pose, truth.velocity, reference.pose, space_, now);
    return now;
  }
  const PlatformMotion motion = (*signals.motion)[sample];
  compare_estimate(estimate.wrench_in_base, PlatformVector::Zero(space_.dimension()), space_, now);
  compare_motion(motion.pose, motion.velocity, reference.pose, space_, now);
  RunLoad& seen = now.loads.front();
  seen.contact_force = std::nan("");
  if (signals.force_torque) {
    seen.obstacle = 0;  // it carries the instrument
    const ForceTorqueReading reading = (*signals.force_torque)[sample];
    if (reading.valid) seen.contact_force = reading.force_in_base.head(space_.translations()).norm();
  }
  return now;
}

}  // namespace flinch
