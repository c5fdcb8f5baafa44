#pragma once

#include <functional>
#include <string>
#include <vector>

#include "systems/config/config_reader.h"
#include "systems/robot/joint_friction.h"

/// What the readers of the kinds of robots share. Each reads one mechanism's own keys, notes all that is
/// wrong with them, also physically, and returns the robot; nothing where something is wrong with the file.
namespace flinch {

/// viscous and coulomb of a turning joint.
JointFriction read_friction(ConfigReader file);
/// The same of a sliding joint.
JointFriction read_sliding_friction(ConfigReader file);

/// Notes sentences about fields, "platform_mass is -1 kg; ...", each under what `name_in_file` calls the
/// field.
void note_problems(ConfigReader& file, const std::vector<std::string>& sentences,
                   const std::function<std::string(std::string field)>& name_in_file);

}  // namespace flinch
