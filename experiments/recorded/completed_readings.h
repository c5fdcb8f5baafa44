#pragma once

#include <memory>

#include "systems/framework/recording.h"

namespace flinch {

/// A recording of readings as a control path needs it at each of its ticks. Readings of another period are
/// interpolated between samples that are both valid, so they are known up to a sample of the log too early.
/// What the recording has not is "no data", drives that say nothing are taken for enabled, and nobody presses
/// a button. A recording that has the period keeps its readings bit for bit. Throws SetupError where there
/// are no joints.
Recording completed_readings(const std::shared_ptr<const Recording>& readings, Time tick);

}  // namespace flinch
