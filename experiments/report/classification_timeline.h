#pragma once

#include <cstddef>

#include "experiments/report/page_samples.h"
#include "experiments/verdict/recorded_classification.h"
#include "systems/signals/contact_classes.h"

namespace flinch {

/// What the robot takes for touched, as named states of a page: nothing, a class, or several contacts.
class ClassificationTimeline {
 public:
  ClassificationTimeline(const ContactClasses& classes, PageSamples& page);

  void show(const RecordedClassification& said, double weight);

 private:
  ContactClasses classes_;
  PageSamples& page_;
  std::size_t lane_ = 0;
};

}  // namespace flinch
