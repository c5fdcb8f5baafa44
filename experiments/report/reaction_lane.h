#pragma once

#include <cstddef>
#include <vector>

#include "experiments/report/page_samples.h"
#include "systems/signals/followed_task.h"

namespace flinch {

/// The tasks that reactions follow, as named states of a page; nothing where no law serves tasks.
class ReactionLane {
 public:
  /// `serves_tasks`: the recording has them; `legs`: of the robot.
  ReactionLane(bool serves_tasks, int legs, PageSamples& page);

  void show(const FollowedTask& task, double weight);

 private:
  PageSamples& page_;
  std::vector<FollowedTask> tasks_;
  std::size_t lane_ = 0;
};

}  // namespace flinch
