#include "experiments/report/reaction_lane.h"

#include <algorithm>
#include <string>

#include "experiments/verdict/task_words.h"

namespace flinch {

ReactionLane::ReactionLane(bool serves_tasks, int legs, PageSamples& page) : page_(page) {
  if (!serves_tasks) return;
  tasks_ = followed_tasks(legs);
  std::vector<std::string> states{"none"};
  for (const FollowedTask& task : tasks_) states.push_back(in_words(task));
  lane_ = page.lane("reaction", std::move(states));
}

void ReactionLane::show(const FollowedTask& task, double weight) {
  if (tasks_.empty()) return;
  const auto known = std::find(tasks_.begin(), tasks_.end(), task);
  const bool reacts = task.valid && known != tasks_.end();
  page_.set_state(lane_, reacts ? static_cast<int>(known - tasks_.begin()) + 1 : 0, weight);
}

}  // namespace flinch
