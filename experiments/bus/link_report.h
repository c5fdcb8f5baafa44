#pragma once

#include <string>
#include <vector>

#include "drivers/dds_station.h"
#include "experiments/live/seen_pose.h"
#include "systems/framework/tick_statistics.h"

namespace flinch {

/// How a link was while it was tried.
struct LinkReport {
  DdsLink link;
  DdsLinkTimes times;
  TickStatistics loop;
  SeenPose pose;                       ///< at the end
  std::vector<SeenRobot> robots = {};  ///< that were seen
  bool is_chosen = false;              ///< the user has said which is meant
  Time period = 1ms;                   ///< from tick to tick

  /// What speaks against moving a robot over this link, one sentence each: several robots of which nobody has
  /// chosen one, commands that take longer than a tick, readings older than the station lets in, more than
  /// one lost in a thousand, of readings or of this program's ticks.
  std::vector<std::string> objections() const;

  std::string table() const;
  std::string json() const;
};

}  // namespace flinch
