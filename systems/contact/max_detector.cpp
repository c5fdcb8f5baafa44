#include "systems/contact/max_detector.h"

#include <algorithm>

namespace flinch {

void MaxDetector::choose(const ContactDetection& one, const ContactDetection& other,
                         ContactDetection& result) const {
  const bool other_detected = other.level != ContactLevel::none;
  const bool other_was_first =
      other_detected && (one.level == ContactLevel::none || other.detected < one.detected);
  result = other_was_first ? other : one;
  result.valid = one.valid || other.valid;
  result.level = std::max(one.level, other.level);
  result.present_level = std::max(one.present_level, other.present_level);
}

}  // namespace flinch
