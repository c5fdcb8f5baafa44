#include "systems/signals/contact_classes.h"

namespace flinch {

std::string ContactClasses::name(int number) const {
  if (!contains(number)) return "";
  if (is_clamping(number)) return "leg" + std::to_string(leg(number) + 1) + "_clamping";
  return body_name(body(number));
}

}  // namespace flinch
