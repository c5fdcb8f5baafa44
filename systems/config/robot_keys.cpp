#include "systems/config/robot_keys.h"

#include <cstddef>

namespace flinch {

JointFriction read_friction(ConfigReader file) {
  JointFriction friction;
  file.number("viscous", unit::Nms_per_rad, friction.viscous, not_negative);
  file.number("coulomb", unit::Nm, friction.coulomb, not_negative);
  return friction;
}

JointFriction read_sliding_friction(ConfigReader file) {
  JointFriction friction;
  file.number("viscous", unit::Ns_per_m, friction.viscous, not_negative);
  file.number("coulomb", unit::N, friction.coulomb, not_negative);
  return friction;
}

void note_problems(ConfigReader& file, const std::vector<std::string>& sentences,
                   const std::function<std::string(std::string field)>& name_in_file) {
  for (const std::string& sentence : sentences) {
    const std::size_t blank = sentence.find(' ');
    file.problem(name_in_file(sentence.substr(0, blank)), sentence.substr(blank + 1));
  }
}

}  // namespace flinch
