#pragma once

#include "systems/laws/task_level.h"
#include "systems/motion/constraint_settings.h"
#include "systems/motion/pose_goal_settings.h"
#include "systems/motion/reaction_task_settings.h"

namespace flinch {

/// What can be set of control by tasks. The defaults are those of [SafePR]; each block's settings say more.
struct TaskSettings {
  PoseGoalSettings nominal;       ///< of the nominal motion, and of the place that a reaction holds
  ReactionTaskSettings reaction;  ///< what is done about a contact
  ConstraintSettings constraints;
  TaskLevelSettings levels;
  Time blend = 10ms;  ///< from the tasks of one constraint mode to those of the next
};

}  // namespace flinch
