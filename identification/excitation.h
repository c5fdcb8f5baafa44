#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "systems/motion/random_path.h"
#include "systems/robot/drive_parameters.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {

/// What a motion that excites the dynamics must respect.
struct ExcitationSettings {
  RandomPathSettings path;  ///< speeds, workspace, room around the centre; its duration is that of the motion
  double max_torque = 100.0;  ///< of every drive; eight tenths of it are used [Nm or N]
  int trials = 2000;          ///< poses that are tried in the place of others
};

/// A motion from rest to rest between poses, from which dynamic parameters can be told.
struct Excitation {
  std::vector<Configuration> poses;
  double duration = 0.0;         ///< [s]
  double condition = 0.0;        ///< of the regressor over the motion, over what it can tell at all
  double first_condition = 0.0;  ///< of the random motion at which the search began
  int rank = 0;                  ///< of the regressor
  int parameters = 0;
  double peak_torque = 0.0;  ///< [Nm or N]
};

/// Searches for one: begins with random poses and replaces one after the other where that lowers the
/// condition number of the regressor, parameters counted in deviations of what is believed of them. All of
/// its way stays within the limits. `progress` is told which share is done. Throws SetupError where no pose
/// can be reached.
Excitation design_excitation(const ParallelRobot& robot, const ExcitationSettings& settings,
                             std::uint64_t seed, const std::function<void(double share)>& progress = {});

}  // namespace flinch
