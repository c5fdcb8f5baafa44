#pragma once

#include <optional>
#include <vector>

#include "experiments/recorded/judged_log.h"

namespace flinch {

/// Force in newtons above which a force sensor tells a contact, where its noise is less than a sixth of it.
inline constexpr double least_contact_force = 2.0;

/// Contacts as the force sensor of a log, its signal "force_torque", tells them. Zero and noise of the sensor
/// are median and deviation of its force in `free`, or in the whole log where `free` is empty. A contact is
/// where the force differs from that zero by more than `threshold` [N], by default the larger of
/// least_contact_force and six deviations of the noise. It begins with the last sample before in which the
/// force is within four deviations, and ends when the force has been below half of the threshold for 0.1 s.
/// What is in no contact is free, but for what the sensor does not tell. A contact that lasts since the first
/// sample has no begin, so it is neither free nor to be detected.
/// Throws SetupError where the log has no such signal or no valid sample of it, where the threshold is within
/// the noise, where a contact lies in `free`, and where the log begins in contact and nothing is said to be
/// free.
LogTruth measured_contacts(const Recording& readings, std::optional<double> threshold,
                           const std::vector<LogTruth::Stretch>& free);

}  // namespace flinch
