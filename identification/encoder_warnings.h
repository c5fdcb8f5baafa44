#pragma once

#include <string>
#include <vector>

#include "systems/robot/parallel_robot.h"

namespace flinch {

struct Recording;

/// Why the encoders cannot be what they are said to be, each with its likely cause: the zero of one that is
/// off, where passive encoders let the legs be closed.
std::vector<std::string> warnings_about_encoders(const Recording& recording, const ParallelRobot& robot);

/// Adds those about every recording of a calibration, each behind the name of its file.
template <class Recordings>
void add_encoder_warnings(const Recordings& recordings, const ParallelRobot& robot,
                          std::vector<std::string>& warnings) {
  for (const auto& from : recordings) {
    for (const std::string& warning : warnings_about_encoders(*from.recording, robot))
      warnings.push_back(from.source.file + ": " + warning);
  }
}

/// Of drives that say a full turn more or less than the robot file counts, from -pi to pi.
std::vector<std::string> warnings_about_turns(const Recording& recording, const ParallelRobot& robot);

}  // namespace flinch
