#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace flinch {

class RobotFiles;
struct ConfigNode;
struct RunResult;
struct SimulatedScenario;

/// The values that a key of the scenario takes in turn: one axis of the grid.
struct CampaignAxis {
  std::string key;  ///< "control.momentum_observer.gain_per_s"
  std::vector<std::shared_ptr<const ConfigNode>> values;
  std::vector<std::string> names = {};  ///< what people call each value; empty: as it stands there

  std::string name_of(std::size_t value) const;
};

/// A key of the scenario that is drawn anew for each run.
struct CampaignDraw {
  enum class Scale { linear, logarithmic };
  std::string key;
  /// One of these; empty: a number between the bounds.
  std::vector<std::shared_ptr<const ConfigNode>> of = {};
  double from = 0.0;
  double to = 0.0;
  Scale scale = Scale::linear;
  std::shared_ptr<const std::string> file = {};  ///< that asks for it; null: none
  int line = 0;                                  ///< likewise
};

/// Contacts that are drawn anew for each run: where the first obstacle of the scenario stands, so that the
/// motion runs a body into it, or how it moves, so that it runs into a body.
struct CampaignContact {
  enum class By {
    standing,  ///< it stands where the motion leads a body
    moving,    ///< it moves itself when it meets a body, half-way through the motion
    pushing,   ///< it is led against a body of a robot that holds still, and drawn back
  };
  /// "platform", "link1", "link2": of a leg that is drawn; "clamping": between the links of a leg.
  std::vector<std::string> bodies;
  By by = By::standing;
  double speed = 1.0;         ///< of a moving one, up to that [m/s]
  double gap = 0.0;           ///< of a clamping: to the other link when the first is touched, up to that [m]
  std::vector<double> force;  ///< of a pushing one: between the first and the last [N]
  double angle = 0.0;         ///< of a push against the normal of the surface, up to that either way [rad]
  double rise = 1.0, hold = 0.0;  ///< of a push; it falls as it rises [s]
};

/// What a program adds to the scenario of every run, for which there is no key.
struct CampaignAddition {
  std::string identity;                         ///< results of one do not go on with those of another
  std::function<void(SimulatedScenario&)> add;  ///< called by several threads at once
};

/// What is done for each number of a campaign, in place of simulating one run: a search, say, that simulates
/// many. Its result stands in the table as that of a run.
struct CampaignTask {
  std::string identity;   ///< results of one do not go on with those of another
  std::size_t count = 0;  ///< numbers of the campaign
  std::function<RunResult(std::size_t number)> result_of;  ///< called by several threads at once
};

/// Many runs of scenarios that differ in some of their keys. docs/files.md has the keys of the file.
struct Campaign {
  std::filesystem::path file;
  std::string file_text;  ///< of that file
  std::string name;       ///< the file's name without ".yaml"
  std::string title;
  std::string description;
  std::uint64_t seed = 1;
  std::size_t draws = 1;  ///< runs at each point of the grid
  /// What the runs are added up to: how contacts were detected, or how they were answered.
  enum class Summary { detections, reactions };
  Summary summary = Summary::detections;
  double missed_after = 0.1;  ///< a contact that is not detected by then counts as missed [s]

  std::vector<std::filesystem::path> scenarios;
  std::vector<std::string> scenario_texts;
  std::vector<std::shared_ptr<const ConfigNode>> scenario_nodes;  ///< of these texts
  std::vector<std::string> robot_texts;  ///< and those of all calibrations, also those that are varied
  std::set<std::string> network_hashes;  ///< SHA-256 of the networks that scenarios name, also of varied ones
  std::vector<CampaignAxis> grid;
  std::vector<CampaignDraw> drawn;
  std::optional<CampaignContact> contact;
  std::optional<CampaignAddition> addition;
  std::optional<CampaignTask> task;  ///< none: each number is a run
  /// Each run is what 'flinch run' makes of its scenario: with the seed that stands there, and all figures of
  /// its verdict in its result.
  bool of_single_runs = false;
  std::shared_ptr<RobotFiles> robots;  ///< of all runs

  /// Everything that decides about the results, in words: two campaigns with one identity have one table.
  std::string identity() const;

  std::size_t grid_points() const;
  std::size_t runs() const { return task ? task->count : grid_points() * draws; }
};

/// What the command line says in place of the file.
struct CampaignOverrides {
  std::vector<std::string> set = {};  ///< "control.contact_detector.reaction_force_N=5,10"
  std::optional<std::size_t> draws = std::nullopt;
  std::optional<std::uint64_t> seed = std::nullopt;
};

/// Throws SetupError with all that is wrong with the file, with `overrides`, and with the scenarios.
Campaign read_campaign(const std::filesystem::path& file, const CampaignOverrides& overrides = {});

}  // namespace flinch
