#include "experiments/speed_limit/speed_limit_study.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

#include "experiments/campaign/drawn_contact.h"
#include "experiments/campaign/exact_bounds.h"
#include "experiments/campaign/run_result.h"
#include "experiments/scenario/key_values.h"
#include "experiments/scenario/robot_files.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/speed_limit/contact_trials.h"
#include "experiments/speed_limit/workspace_grid.h"
#include "experiments/verdict/body_regions.h"
#include "systems/config/config_document.h"
#include "systems/config/config_node.h"
#include "systems/config/parsed.h"
#include "systems/config/yaml_text.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

using Node = std::shared_ptr<const ConfigNode>;

constexpr std::size_t most_cells = 100'000;
constexpr const char* clamping = "clamping";

/// The value of a key of a mapping; null where it has none.
Node entry(const Node& mapping, const std::string& key) {
  if (!mapping) return nullptr;
  for (const ConfigNode::Entry& each : mapping->entries) {
    if (each.key == key) return each.value;
  }
  return nullptr;
}

// ---------------------------------------------------------------- the scenario

Node scenario_root(const SpeedLimitSettings& settings, RobotFiles& robots) {
  Node root = scenario_with(settings.scenario, settings.set, [&](const Node& read) {
    return parse_simulated_scenario(read, settings.scenario, robots).values;
  });
  return root;
}

/// The section of the obstacle that is met; "" where there is none.
std::string obstacle_of(const Node& root) {
  if (entry(root, "pylon")) return "pylon";
  const Node obstacles = entry(root, "obstacles");
  return obstacles && !obstacles->items.empty() ? "obstacles[0]" : "";
}

void require_passage_and_obstacle(const Node& root, const std::filesystem::path& file) {
  std::vector<std::string> problems;
  const Node kind = entry(entry(root, "motion"), "kind");
  if (!kind || kind->scalar != "passage") {
    const std::string where =
        kind && kind->file ? SourceLocation{kind->file.get(), kind->line}.text() : file.string();
    problems.push_back(where + ": motion.kind: is " +
                       (kind ? "'" + kind->scalar + "'" : std::string("not there")) +
                       "; it must be 'passage', a straight line through a pose at constant speed, whose "
                       "pose, direction and speed are then varied");
  }
  if (obstacle_of(root).empty()) {
    problems.push_back(file.string() +
                       ": has neither 'pylon' nor 'obstacles'; one must be there, to be put where the body "
                       "runs into it");
  }
  throw_if_any(std::move(problems));
}

// ---------------------------------------------------------------- settings

std::vector<std::string> bodies_of(const ParallelRobot& robot) {
  std::vector<std::string> bodies = {"platform"};
  if (BodyId::link1(0).index() < robot.body_count()) bodies.emplace_back("link1");
  if (BodyId::link2(0).index() < robot.body_count()) bodies.emplace_back("link2");
  return bodies;
}

void check_bodies(const std::vector<std::string>& asked, const ParallelRobot& robot,
                  std::vector<std::string>& problems) {
  std::vector<std::string> known = bodies_of(robot);
  if (robot.space_dimension() == 2 && known.size() == 3) known.emplace_back(clamping);
  for (const std::string& body : asked) {
    if (std::find(known.begin(), known.end(), body) == known.end()) {
      problems.push_back("--body " + body + ": this robot has no such contact; it may be " + listed(known));
    }
  }
}

void check_region(const std::string& region, std::vector<std::string>& problems) {
  if (region.empty() || find_body_region(region) != nullptr) return;
  std::vector<std::string> names;
  for (const BodyRegion& each : body_regions()) names.emplace_back(each.name);
  problems.push_back("--region: is '" + region + "', which is no region of the body that has limits" +
                     did_you_mean(region, names));
}

/// The search of each cell; what is wrong with it is added to `problems`.
SpeedSearch search_of(const SpeedLimitSettings& settings, std::vector<std::string>& problems) {
  SpeedSearch search{.slowest = settings.slowest, .fastest = settings.fastest, .step = settings.step};
  if (settings.slowest > settings.fastest) {
    problems.push_back(fmt::format("--slowest: is {:g} m/s, above the --fastest of {:g} m/s; lower it",
                                   settings.slowest, settings.fastest));
  }
  const std::size_t fewest = trials_without_event(settings.share, settings.confidence);
  const std::size_t runs = settings.runs.value_or(fewest);  // that come about
  search.spares = (runs + 3) / 4;
  search.trials = runs + search.spares;
  const auto tolerated = tolerated_events(runs, settings.share, settings.confidence);
  if (!tolerated) {
    problems.push_back(fmt::format(
        "--runs: is {}; even if all are within the limits, that shows fewer than {:g} % beyond them with a "
        "confidence of {:.3g} % only, and not of {:g} %; give {} or more, or raise --share, or lower "
        "--confidence",
        runs, 100.0 * settings.share, 100.0 * confidence_below(0, runs, settings.share),
        100.0 * settings.confidence, fewest));
  }
  search.tolerated = tolerated.value_or(0);
  return search;
}

std::vector<SpeedLimitCell> cells_of(const std::vector<Eigen::Vector2d>& places,
                                     const SpeedLimitSettings& settings,
                                     const std::vector<std::string>& bodies) {
  const double count = static_cast<double>(places.size()) *
                       static_cast<double>(settings.directions_deg.size() * bodies.size());
  if (count > static_cast<double>(most_cells)) {
    throw SetupError(fmt::format(
        "--grid: asks for {} cells, with each direction and body at each place; at most {} can be", count,
        most_cells));
  }
  std::vector<SpeedLimitCell> cells;
  for (const Eigen::Vector2d& place : places) {
    for (const double direction : settings.directions_deg) {
      for (const std::string& body : bodies) cells.push_back({place, direction, body});
    }
  }
  return cells;
}

// ---------------------------------------------------------------- cells

/// What tells cells apart, in one word: in another grid the same place has the same contacts.
std::string name_of(const SpeedLimitCell& cell) {
  return exact_text(cell.place.x()) + " " + exact_text(cell.place.y()) + " " +
         exact_text(cell.direction_deg) + " " + cell.body;
}

using KeyValue = std::pair<std::string, std::string>;

/// What a scenario says differently at a cell, at `speed` [m/s].
std::vector<KeyValue> values_at(const SpeedLimitStudy& study, const SpeedLimitCell& cell, double speed) {
  std::vector<KeyValue> values = {{"motion.pose.x_m", exact_text(cell.place.x())},
                                  {"motion.pose.y_m", exact_text(cell.place.y())},
                                  {"motion.speed_m_per_s", exact_text(speed)}};
  if (study.robot->space_dimension() == 2) {
    values.emplace_back("motion.direction_deg", exact_text(cell.direction_deg));
  } else {
    const double angle = cell.direction_deg * std::numbers::pi / 180.0;
    values.emplace_back("motion.direction",
                        fmt::format("[{}, {}, 0]", exact_text(std::cos(angle)), exact_text(std::sin(angle))));
  }
  // Between two links nothing gets out of the way: what is clamped is never a transient contact.
  if (cell.body == clamping)
    values.emplace_back("force_limits.transient_N", exact_text(study.limits.quasi_static));
  return values;
}

Node root_at(const SpeedLimitStudy& study, const SpeedLimitCell& cell, double speed) {
  Node root = study.campaign.scenario_nodes.front();
  for (const auto& [key, value] : values_at(study, cell, speed))
    root = with_value(*root, key, parse_yaml(value, study.campaign.file.string()));
  return root;
}

/// The contacts of a cell as a campaign.
Campaign contacts_of(const SpeedLimitStudy& study, const SpeedLimitCell& cell) {
  Campaign contacts = study.campaign;
  contacts.task.reset();
  contacts.seed = derive_seed(study.campaign.seed, name_of(cell));
  contacts.draws = 2 * study.search.trials;
  contacts.contact.emplace().bodies = {cell.body};
  contacts.scenario_nodes = {root_at(study, cell, study.search.slowest)};
  return contacts;
}

constexpr std::array bound_names = {"force", "motion", "fastest"};  // as FoundSpeed::Bound

/// What was found, in the columns of the table.
void tell(const SpeedLimitStudy& study, const SpeedLimitCell& cell, const std::optional<FoundSpeed>& found,
          const std::string& reason, RunResult& row) {
  const std::vector<std::pair<std::string, std::string>> of_run = std::exchange(row.values, {});
  const auto add = [&row](const char* name, std::string text) {
    row.values.emplace_back(name, std::move(text));
  };
  add("x_m", exact_text(cell.place.x()));
  add("y_m", exact_text(cell.place.y()));
  add("direction_deg", exact_text(cell.direction_deg));
  add("body", cell.body);
  const bool has_speed = found && found->speed;
  add("limit_m_per_s", has_speed ? exact_text(*found->speed) : "");
  add("bound", found ? bound_names[static_cast<std::size_t>(found->bound)] : "");
  add("runs", found ? std::to_string(study.search.trials) : "");
  add("exceeded", found ? std::to_string(found->exceeded) : "");
  add("untested", found ? std::to_string(found->untested) : "");
  add("reason", reason);
  for (const char* name : {"contact", "x_m", "y_m", "z_m", "duration_s"}) {
    const auto same =
        std::find_if(of_run.begin(), of_run.end(), [name](const auto& value) { return value.first == name; });
    const std::string key = std::string(name).ends_with("_m") ? std::string("obstacle_") + name : name;
    row.values.emplace_back(key, same == of_run.end() ? "" : same->second);
  }
}

/// The search in a cell, as a row of the table.
RunResult search_in(const SpeedLimitStudy& study, std::size_t number) {
  const SpeedLimitCell& cell = study.cells[number];
  std::optional<FoundSpeed> found;
  std::string reason;
  RunResult row;
  const Campaign contacts = contacts_of(study, cell);
  try {
    ContactTrials trials(contacts, study.search.slowest, study.search.trials);
    found = find_speed(study.search, [&](std::size_t trial, double speed) { return trials(trial, speed); });
    const RunResult* const nearest = found->speed ? trials.nearest(*found->speed) : nullptr;
    if (nearest != nullptr) row = *nearest;
  } catch (const SetupError& error) {
    reason = error.problems().front();
  }
  row.run = number;
  row.point = number;
  tell(study, cell, found, reason, row);
  return row;
}

std::string identity_of(const SpeedLimitStudy& study) {
  const SpeedSearch& search = study.search;
  std::string text =
      fmt::format("speed limit {} {} {} {} {} {}", exact_text(search.slowest), exact_text(search.fastest),
                  exact_text(search.step), search.trials, search.tolerated, search.spares);
  for (const SpeedLimitCell& cell : study.cells) text += "\n" + name_of(cell);
  return text;
}

// ---------------------------------------------------------------- rows

std::string value_of(const RunResult& row, const std::string& name) {
  const auto found = std::find_if(row.values.begin(), row.values.end(),
                                  [&name](const auto& value) { return value.first == name; });
  return found == row.values.end() ? "" : found->second;
}

std::size_t count_of(const RunResult& row, const std::string& name) {
  const std::string text = value_of(row, name);
  std::size_t count = 0;
  std::from_chars(text.data(), text.data() + text.size(), count);
  return count;
}

std::optional<FoundSpeed> found_of(const RunResult& row) {
  const auto* const bound = std::find(bound_names.begin(), bound_names.end(), value_of(row, "bound"));
  if (bound == bound_names.end()) return std::nullopt;
  FoundSpeed found;
  found.bound = static_cast<FoundSpeed::Bound>(bound - bound_names.begin());
  found.exceeded = count_of(row, "exceeded");
  found.untested = count_of(row, "untested");
  const std::string speed = value_of(row, "limit_m_per_s");
  if (!speed.empty()) std::from_chars(speed.data(), speed.data() + speed.size(), found.speed.emplace());
  return found;
}

}  // namespace

SpeedLimitStudy read_speed_limit_study(const SpeedLimitSettings& settings) {
  std::vector<std::string> problems;
  check_region(settings.region, problems);
  SpeedLimitStudy study;
  study.search = search_of(settings, problems);
  throw_if_any(std::exchange(problems, {}));
  study.share = settings.share;
  study.confidence = settings.confidence;
  Campaign& campaign = study.campaign;
  campaign.robots = std::make_shared<RobotFiles>();
  Node root = scenario_root(settings, *campaign.robots);
  require_passage_and_obstacle(root, settings.scenario);
  const auto add = [&](const char* key, const std::string& value) {
    root = with_value(*root, key, scalar_node(value));
    study.added.emplace_back(key, value);
  };
  if (!settings.region.empty()) {  // whatever the scenario has in its place
    const ForceLimits limits = force_limits_of(*find_body_region(settings.region));
    add("force_limits.region", settings.region);
    add("force_limits.transient_N", exact_text(limits.transient));
    add("force_limits.quasi_static_N", exact_text(limits.quasi_static));
  }
  if (!entry(entry(root, "plant"), "realism")) add("plant.realism", "bench");
  const auto parsed = [&] { return parse_simulated_scenario(root, settings.scenario, *campaign.robots); };
  SimulatedScenario scenario = parsed();
  study.robot = scenario.robot.robot;
  check_bodies(settings.bodies, *study.robot, problems);
  if (settings.height && study.robot->space_dimension() == 2)
    problems.push_back("--z: this robot moves in a plane; leave it out");
  throw_if_any(std::move(problems));
  if (settings.height) {
    add("motion.pose.z_m", exact_text(*settings.height));
    scenario = parsed();
  }
  study.obstacle = obstacle_of(root);
  study.limits = scenario.force_limits;
  study.pose = meeting_point_of(scenario).now.pose;
  const std::vector<std::string> bodies = settings.bodies.empty() ? bodies_of(*study.robot) : settings.bodies;
  study.cells = cells_of(settings.places.empty()
                             ? workspace_grid(*study.robot, scenario.robot.limits, study.pose, settings.grid)
                             : settings.places,
                         settings, bodies);
  campaign.file = settings.scenario;
  campaign.name = settings.scenario.stem().string() + "_speed_limit";
  campaign.title = scenario.title;
  campaign.description = scenario.description;
  campaign.seed = settings.seed;
  campaign.scenarios = {settings.scenario};
  campaign.scenario_nodes = {root};
  campaign.scenario_texts = {yaml_text(*root)};
  campaign.robot_texts = campaign.robots->texts();
  const auto shared = std::make_shared<const SpeedLimitStudy>(study);  // without a task
  campaign.task = CampaignTask{identity_of(study), study.cells.size(),
                               [shared](std::size_t number) { return search_in(*shared, number); }};
  return study;
}

std::vector<SpeedLimit> speed_limits_of(const SpeedLimitStudy& study, const CampaignResults& results) {
  std::vector<SpeedLimit> limits;
  for (const RunResult& row : results) {
    SpeedLimit limit{study.cells[row.run], found_of(row), value_of(row, "reason"), 0.0, row};
    if (limit.found && limit.found->speed) {
      limit.confidence =
          confidence_below(limit.found->exceeded + limit.found->untested, study.search.trials, study.share);
    }
    limits.push_back(std::move(limit));
  }
  return limits;
}

std::vector<std::pair<std::string, std::string>> values_of_run(const SpeedLimitStudy& study,
                                                               const SpeedLimit& limit) {
  std::vector<KeyValue> values = values_at(study, limit.cell, limit.found->speed.value());
  for (const char* axis : {"x_m", "y_m", "z_m"}) {
    const std::string at = value_of(limit.nearest, std::string("obstacle_") + axis);
    if (axis[0] != 'z' || study.robot->space_dimension() > 2)
      values.emplace_back(study.obstacle + "." + axis, at);
  }
  values.emplace_back("duration_s", value_of(limit.nearest, "duration_s"));
  values.emplace_back("expect.contact", value_of(limit.nearest, "contact"));
  values.insert(values.end(), study.added.begin(), study.added.end());
  return values;
}

}  // namespace flinch
