#include "experiments/verdict/recorded_run.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/verdict/recorded_truth.h"
#include "systems/framework/recorded_values.h"
#include "systems/signals/force_torque_reading.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/platform_reference.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {
namespace {

Witness witness_of(const Recording& recording) {
  if (recording.find("contact") != nullptr || recording.find("truth") != nullptr) return Witness::truth;
  return recording.find("force_torque") != nullptr ? Witness::force_torque : Witness::none;
}

/// Not a number where the vector is shorter.
Eigen::Vector3d three(const auto& vector) {
  Eigen::Vector3d numbers = Eigen::Vector3d::Constant(std::nan(""));
  const Eigen::Index size = std::min<Eigen::Index>(vector.size(), 3);
  numbers.head(size) = vector.head(size);
  return numbers;
}

}  // namespace

/// Those that the witness has.
struct RecordedRun::Signals {
  Signals(const Recording& recording, Witness witness)
      : detection(recording, "detection"),
        reaction(recording, "reaction"),
        wrench(recording, "wrench"),
        reference(recording, "reference"),
        gate(recording, "gate") {
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
  RecordedValues<WrenchEstimate> wrench;
  RecordedValues<PlatformReference> reference;
  RecordedValues<GateStatus> gate;
  std::optional<RecordedValues<RecordedContact>> contact;
  std::optional<RecordedValues<RecordedTruth>> truth;
  std::optional<RecordedValues<ForceTorqueReading>> force_torque;
  std::optional<RecordedValues<PlatformMotion>> motion;
};

RecordedRun::RecordedRun(const Recording& recording)
    : recording_(recording),
      witness_(witness_of(recording)),
      signals_(std::make_unique<Signals>(recording, witness_)) {}

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
  now.mode = signals.reaction[sample].mode;
  now.gate = signals.gate[sample];
  const WrenchEstimate estimate = signals.wrench[sample];
  now.estimate_valid = estimate.valid;
  now.estimate = three(estimate.wrench_in_base);
  const PlatformReference reference = signals.reference[sample];
  now.reference_valid = reference.valid;
  now.reference = three(reference.pose);
  if (signals.truth) {
    const RecordedContact contact = (*signals.contact)[sample];
    const RecordedTruth truth = (*signals.truth)[sample];
    now.is_true = true;
    now.body = contact.strongest.body;
    now.clamping = contact.clamping;
    now.contact_force = contact.strongest.force_in_base;
    now.loop_closure = truth.loop_closure_error;
    now.pose = three(truth.pose);
    now.velocity = three(truth.velocity);
    now.external = three(truth.wrench_in_base);
    return now;
  }
  const PlatformMotion motion = (*signals.motion)[sample];
  now.pose = three(motion.pose);
  now.velocity = three(motion.velocity);
  now.contact_force.setConstant(std::nan(""));
  if (signals.force_torque) {
    const ForceTorqueReading reading = (*signals.force_torque)[sample];
    if (reading.valid) now.contact_force = reading.force_in_base.head<2>();
  }
  return now;
}

}  // namespace flinch
