#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_results.h"
#include "experiments/speed_limit/speed_search.h"
#include "experiments/verdict/verdict.h"
#include "systems/robot/vectors.h"

namespace flinch {

class ParallelRobot;

/// What is asked: how fast may the robot of a scenario move where, so that contacts stay within force limits?
struct SpeedLimitSettings {
  std::filesystem::path scenario;     ///< With a passage and an obstacle.
  std::vector<std::string> set = {};  ///< Values of its keys, "KEY=VALUE".
  std::string region = {};  ///< Of the body, as body_regions() name them; empty: the scenario's limits.
  /// Those that are touched: "platform", "link1", "link2" of any leg, "clamping". Empty: the first three, as
  /// far as the robot has them.
  std::vector<std::string> bodies = {};
  /// Of the platform, x and y in the base frame [m]; empty: a grid.
  std::vector<Eigen::Vector2d> places = {};
  int grid = 5;                                 ///< Number of places along the longer side of the workspace.
  std::optional<double> height = std::nullopt;  ///< Of the platform in space, z [m]; none: the scenario's.
  /// Of the motion, against the x axis of the base frame [deg].
  std::vector<double> directions_deg = {0.0, 90.0, 180.0, 270.0};
  double share = 0.1;        ///< Fraction of contacts that may exceed a limit.
  double confidence = 0.95;  ///< At which fewer do.
  /// Contacts of each cell that come about; none: as few as can show it.
  std::optional<std::size_t> runs = std::nullopt;
  double slowest = 0.1;  ///< Speeds that are tried [m/s].
  double fastest = 2.0;
  double step = 0.03;      ///< Largest relative distance between them.
  std::uint64_t seed = 1;  ///< Of all that is drawn.
};

/// One entry of the map: a body, where the platform is, and where it moves.
struct SpeedLimitCell {
  Eigen::Vector2d place{0.0, 0.0};  ///< Of the platform [m].
  double direction_deg = 0.0;       ///< Of its motion.
  std::string body;                 ///< As in SpeedLimitSettings::bodies.
};

/// A campaign whose numbers are cells: the search in one stands in its table as a run.
struct SpeedLimitStudy {
  Campaign campaign;
  std::vector<SpeedLimitCell> cells;
  SpeedSearch search;
  double share = 0.1;
  double confidence = 0.95;
  ForceLimits limits;  ///< Of all bodies but clampings, for which the quasi-static one holds at once.
  std::shared_ptr<const ParallelRobot> robot;
  Configuration pose;  ///< Of the scenario's passage.
  /// Keys and values that all cells have beside the scenario and SpeedLimitSettings::set.
  std::vector<std::pair<std::string, std::string>> added;
  std::string obstacle;  ///< Which is met, as a section of the scenario: "pylon", "obstacles[0]".
};

/// Reads scenario and robot. The robots are those of `plant: {realism: bench}` where the scenario does not
/// say what they are. Throws SetupError with all that is wrong with the settings or the scenario.
SpeedLimitStudy read_speed_limit_study(const SpeedLimitSettings& settings);

/// What the search in a cell has found.
struct SpeedLimit {
  SpeedLimitCell cell = {};
  std::optional<FoundSpeed> found = std::nullopt;  ///< None: the body cannot be run into anything there.
  std::string reason = {};                         ///< Then why.
  double confidence = 0.0;  ///< That fewer than the share exceed a limit at that speed; 0 without a speed.
  RunResult nearest = {};   ///< The run at that speed that came nearest to a limit; without a speed empty.
};

/// In the order of the cells.
std::vector<SpeedLimit> speed_limits_of(const SpeedLimitStudy& study, const CampaignResults& results);

/// Keys of the scenario and their values with which 'flinch run' repeats the nearest run of a limit, but for
/// its seed.
std::vector<std::pair<std::string, std::string>> values_of_run(const SpeedLimitStudy& study,
                                                               const SpeedLimit& limit);

}  // namespace flinch
