#include "systems/robot/body_id.h"

namespace flinch {

std::string body_name(BodyId body) {
  if (body.is_platform()) return "platform";
  return "leg" + std::to_string(body.leg() + 1) + (body.is_link1() ? "_link1" : "_link2");
}

}  // namespace flinch
