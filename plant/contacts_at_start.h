#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "plant/rig_settings.h"

namespace flinch {

/// A contact of the robot with an obstacle before anything has moved: a scene that cannot be meant.
struct ContactAtStart {
  std::size_t obstacle = 0;  ///< Its place in the scene.
  std::string complaint;     ///< A sentence that names body, obstacle and depth.
};

/// All of them. `settings` must be without problems.
std::vector<ContactAtStart> contacts_at_start(const RigSettings& settings);

}  // namespace flinch
