#pragma once

#include <string>
#include <vector>

#include "systems/signals/followed_task.h"

namespace flinch {

/// What a reaction does, in one word, as in `--json`: "retreat". A number of a recording that stands for none
/// is "unknown".
const char* word(ReactionKind kind);

/// What the robot does, without it: "opens leg 2". For a task that is valid.
std::string in_words(const FollowedTask& task);

/// Every task that a reaction of a robot with so many legs can follow.
std::vector<FollowedTask> followed_tasks(int legs);

}  // namespace flinch
