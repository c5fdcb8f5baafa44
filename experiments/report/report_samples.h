#pragma once

#include <cstddef>
#include <functional>

#include "experiments/report/report.h"

namespace flinch {

class ParallelRobot;
struct Recording;

/// An attribute of recordings of a rig alone: what commands it is not known, and left out.
inline constexpr const char* rig_alone = "bench.alone";

/// Adds to a page what was recorded of this robot: times, columns and lanes, in one pass over the samples.
/// The page shows `together` samples as one: the robot is drawn at the hardest contact of them, and every
/// chart has its own peak.
void add_samples(const ParallelRobot& robot, const Recording& recording, Report& report, std::size_t together,
                 const std::function<void(double share)>& progress = {});

}  // namespace flinch
