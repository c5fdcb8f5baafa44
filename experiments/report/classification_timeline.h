#pragma once

#include <cstddef>

#include "experiments/report/page_samples.h"
#include "experiments/verdict/recorded_classification.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {

/// What the robot takes for touched, as named states of a page: nothing, a class, or several contacts.
class ClassificationTimeline {
 public:
  ClassificationTimeline(const ParallelRobot& robot, PageSamples& page);

  void show(const RecordedClassification& said, double weight);

 private:
  PageSamples& page_;
  int several_ = 0;  ///< The state of several contacts.
  std::size_t lane_ = 0;
};

}  // namespace flinch
