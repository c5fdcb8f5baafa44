#pragma once

#include "systems/framework/system.h"
#include "systems/signals/contact_detection.h"

namespace flinch {

/// Says what either of two detectors says, each for itself: the higher level, since the earlier detection.
/// One that is not valid says nothing new.
class MaxDetector final : public System {
 public:
  InputPort<ContactDetection> first = input<ContactDetection>("first");
  InputPort<ContactDetection> second = input<ContactDetection>("second");
  OutputPort<ContactDetection> contact = output<&MaxDetector::choose>("contact", first, second);

 private:
  void choose(const ContactDetection& one, const ContactDetection& other, ContactDetection& result) const;
};

}  // namespace flinch
