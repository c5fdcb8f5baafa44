#include "experiments/campaign/campaign_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/drawn_contact.h"
#include "experiments/campaign/drawn_move.h"
#include "systems/config/config_document.h"
#include "systems/config/config_node.h"
#include "systems/config/key_error.h"
#include "systems/config/parsed.h"
#include "systems/config/yaml_text.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

using Node = std::shared_ptr<const ConfigNode>;

Node number_node(double value) { return scalar_node(exact_text(value)); }

double drawn_number(const CampaignDraw& draw, RandomGenerator& random) {
  if (draw.scale == CampaignDraw::Scale::linear) return random.uniform(draw.from, draw.to);
  return std::exp(random.uniform(std::log(draw.from), std::log(draw.to)));
}

Node drawn_value(const CampaignDraw& draw, RandomGenerator& random) {
  if (!draw.of.empty()) return draw.of[random() % draw.of.size()];
  ConfigNode number = *number_node(drawn_number(draw, random));
  number.file = draw.file;
  number.line = draw.line;
  return std::make_shared<const ConfigNode>(std::move(number));
}

/// Picks one of `count` by the next digit of `index`, and takes the digit off.
std::size_t next_digit(std::size_t& index, std::size_t count) {
  const std::size_t digit = index % count;
  index /= count;
  return digit;
}

/// "campaign.yaml:7: " where the campaign gave the value; empty where nobody did.
std::string place_of(const ConfigNode& value) {
  return value.file ? SourceLocation{value.file.get(), value.line}.text() + ": " : "";
}

/// A scenario while values are put into it.
class Draft {
 public:
  Draft(const Campaign& campaign, std::size_t scenario)
      : file_(campaign.scenarios[scenario]), root_(campaign.scenario_nodes[scenario]) {}

  void set(const std::string& key, const Node& value) {
    try {
      root_ = with_value(*root_, key, value);
    } catch (const SetupError& error) {
      const std::string problem = place_of(*value) + error.what();
      throw KeyError({problem}, {problem});
    }
  }
  bool has(const std::string& key) const {
    for (const ConfigNode::Entry& entry : root_->entries) {
      if (entry.key == key) return true;
    }
    return false;
  }
  const Node& root() const { return root_; }
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
  Node root_;
};

constexpr std::array axis_keys = {"x_m", "y_m", "z_m"};
constexpr double push_begin = 0.4;  // the torque gate is open by then [s]

/// Throws KeyError where grid or draws give a value to `key`, which `contact` is to draw.
void require_free(const std::string& key, const CampaignRun& run) {
  for (const auto& [varied, value] : run.values) {
    if (!name_one_value(varied, key)) continue;
    const std::string problem =
        "'" + varied + "' is varied, but 'contact' draws where the obstacle is; keep one of them";
    throw KeyError({problem}, {problem});
  }
}

/// Puts an obstacle at `position`, and tells it in the columns of the table.
void place(Draft& draft, const std::string& obstacle, const Eigen::Vector3d& position, int directions,
           CampaignRun& run) {
  for (int i = 0; i < 3; ++i) {
    const char* const axis = axis_keys[static_cast<std::size_t>(i)];
    const Node coordinate = number_node(position[i]);
    require_free(obstacle + axis, run);
    if (i < directions) draft.set(obstacle + axis, coordinate);
    run.values.emplace_back(axis, coordinate->scalar);
  }
}

std::string path_text(const std::vector<PathPoint>& path, int directions) {
  std::string text = "[";
  for (const PathPoint& point : path) {
    text += "{time_s: " + exact_text(point.time);
    for (int i = 0; i < directions; ++i) {
      text += std::string(", ") + axis_keys[static_cast<std::size_t>(i)] + ": " +
              exact_text(point.displacement[i]);
    }
    text += "}, ";
  }
  return text + "]";
}

void move(Draft& draft, const DrawnMove& drawn, int directions, CampaignRun& run) {
  place(draft, "obstacles[0].", drawn.position_in_base, directions, run);
  draft.set("obstacles[0].path", parse_yaml(path_text(drawn.path, directions), "drawn path"));
}

/// Lets the first obstacle push.
void make_hand(Draft& draft) {
  draft.set("obstacles[0].kind", scalar_node("hand"));
  draft.set("obstacles[0].mount_stiffness_N_per_m", number_node(pushing_stiffness));
}

/// The robot when a moving obstacle meets it: half-way through its motion, or where it holds still.
MeetingPoint meeting_of(const CampaignContact& settings, RobotFiles& robots, const Draft& draft,
                        const Scenario& scenario) {
  if (settings.by == CampaignContact::By::pushing) {
    const SimulatedScenario simulated = parse_simulated_scenario(draft.root(), draft.file(), robots);
    const ParallelRobot& robot = *simulated.robot.robot;
    MeetingPoint at{{}, push_begin};
    robot.kinematics(simulated.station.rig.initial_pose.value_or(robot.home_pose()),
                     PlatformVector::Zero(robot.dof()), at.now);
    return at;
  }
  MeetingPoint at = meeting_point_of(scenario);
  if (const std::optional<Time> start = scenario.control.trajectory.start) at.time += to_seconds(*start);
  return at;
}

/// What is drawn to be touched is what the scenario expects.
void expect(const std::string& body, Draft& draft, CampaignRun& run) {
  run.values.emplace_back("contact", body);
  draft.set("expect.contact", scalar_node(body));
}

/// The first obstacle runs into a body of `kind`, or presses on it. False where this draw has no such place.
bool move_obstacle(const CampaignContact& settings, RobotFiles& robots, Draft& draft, const std::string& kind,
                   RandomGenerator& random, CampaignRun& run) {
  const Scenario scenario = parse_scenario(draft.root(), draft.file(), robots);
  if (scenario.obstacles.empty() || draft.has("pylon")) {
    throw SetupError("there is no entry in 'obstacles', or a 'pylon' before it, so 'contact' can move none");
  }
  const ParallelRobot& robot = *scenario.robot.robot;
  const MeetingPoint at = meeting_of(settings, robots, draft, scenario);
  const auto contact = draw_touch(robot, at.now, kind, scenario.obstacles.front().shape, random);
  if (!contact) return false;
  expect(contact->body, draft, run);
  const int directions = robot.space_dimension();
  if (settings.by == CampaignContact::By::pushing) {
    make_hand(draft);
    move(draft, draw_push(settings, *contact, at.time, directions, random), directions, run);
    return true;
  }
  const auto meeting = draw_meeting(settings, *contact, at.time, directions, random);
  if (meeting) move(draft, *meeting, directions, run);
  return meeting.has_value();
}

/// Stands the first obstacle where it is run into. False where this draw has no such place.
bool place_obstacle(const CampaignContact& settings, RobotFiles& robots, Draft& draft,
                    const std::string& kind, RandomGenerator& random, CampaignRun& run) {
  const Scenario scenario = parse_scenario(draft.root(), draft.file(), robots);
  if (scenario.obstacles.empty()) throw SetupError("there is no obstacle that 'contact' could move");
  const auto contact = draw_contact(scenario, kind, scenario.obstacles.front().shape, random, settings.gap);
  if (!contact) return false;
  expect(contact->body, draft, run);
  place(draft, draft.has("pylon") ? "pylon." : "obstacles[0].", contact->position_in_base,
        scenario.robot.robot->space_dimension(), run);
  return true;
}

/// The scenario at a point of the grid before anything is drawn; `digits` is what is left of the point.
Draft undrawn(const Campaign& campaign, std::size_t& digits, CampaignRun& run) {
  const std::size_t base = next_digit(digits, campaign.scenarios.size());
  Draft draft(campaign, base);
  if (campaign.scenarios.size() > 1) {
    run.values.emplace_back("scenario", campaign.scenarios[base].stem().string());
  }
  for (const CampaignAxis& axis : campaign.grid) {
    const std::size_t value = next_digit(digits, axis.values.size());
    draft.set(axis.key, axis.values[value]);
    run.values.emplace_back(axis.key, axis.name_of(value));
  }
  return draft;
}

void draw_values(const Campaign& campaign, RandomGenerator& random, Draft& draft, CampaignRun& run) {
  for (const CampaignDraw& draw : campaign.drawn) {
    const Node value = drawn_value(draw, random);
    draft.set(draw.key, value);
    run.values.emplace_back(draw.key, yaml_line(*value));
  }
}

/// What is wrong with that scenario.
std::vector<std::string> undrawn_problems(const Campaign& campaign, CampaignRun run) {
  try {
    std::size_t digits = run.point;
    const Draft draft = undrawn(campaign, digits, run);
    parse_simulated_scenario(draft.root(), draft.file(), *campaign.robots);
    return {};
  } catch (const SetupError& error) {
    return error.problems();
  }
}

bool have_one_in_common(const std::vector<std::string>& some, const std::vector<std::string>& others) {
  return std::find_first_of(some.begin(), some.end(), others.begin(), others.end()) != some.end();
}

/// Draws everything once. False, or SetupError, where that is not possible.
bool draw_once(const Campaign& campaign, RandomGenerator& random, CampaignRun& run) {
  run.values.clear();
  std::size_t digits = run.point;
  Draft draft = undrawn(campaign, digits, run);
  draw_values(campaign, random, draft, run);
  if (!campaign.of_single_runs) draft.set("seed", scalar_node(std::to_string(run.seed)));
  if (campaign.contact) {
    const auto& bodies = campaign.contact->bodies;
    const std::string& kind = bodies[next_digit(digits, bodies.size())];
    RobotFiles& robots = *campaign.robots;
    const bool is_placed = campaign.contact->by == CampaignContact::By::standing
                               ? place_obstacle(*campaign.contact, robots, draft, kind, random, run)
                               : move_obstacle(*campaign.contact, robots, draft, kind, random, run);
    if (!is_placed) return false;
  }
  run.scenario = parse_simulated_scenario(draft.root(), draft.file(), *campaign.robots);
  run.seed = run.scenario.seed;
  return true;
}

/// The problems, each with the run and the first values that were drawn for it.
std::vector<std::string> of_run(const CampaignRun& run, const std::vector<std::string>& problems) {
  constexpr std::size_t longest = 120;
  std::string drawn;
  std::size_t told = 0;
  for (const auto& [key, value] : run.values) {
    const std::string next = (told > 0 ? ", " : ": ") + key + " = " + value;
    if (drawn.size() + next.size() > longest) break;
    drawn += next;
    ++told;
  }
  if (told < run.values.size()) drawn += " and " + std::to_string(run.values.size() - told) + " more";
  std::vector<std::string> result;
  for (const std::string& problem : problems)
    result.push_back(problem + " (run " + std::to_string(run.number) + drawn + ")");
  return result;
}

/// Points of the grid that differ from the first one of their scenario by one value of one axis at most:
/// those of no axis, then of each its second value and those after it.
std::vector<std::vector<std::size_t>> points_by_axis(const Campaign& campaign) {
  std::size_t stride = campaign.scenarios.size();
  std::vector<std::vector<std::size_t>> points(1);
  for (std::size_t scenario = 0; scenario < stride; ++scenario) points.front().push_back(scenario);
  for (const CampaignAxis& axis : campaign.grid) {
    std::vector<std::size_t>& of_axis = points.emplace_back();
    for (std::size_t value = 1; value < axis.values.size(); ++value) {
      for (std::size_t scenario = 0; scenario < campaign.scenarios.size(); ++scenario)
        of_axis.push_back(scenario + value * stride);
    }
    stride *= axis.values.size();
  }
  return points;
}

void append_new(const auto& more, auto& all) {
  std::copy_if(more.begin(), more.end(), std::back_inserter(all),
               [&all](const auto& each) { return std::find(all.begin(), all.end(), each) == all.end(); });
}

/// Whether the campaign varies calibrations, and leaves the threshold that they replace to the scenario.
bool is_meant(const Campaign& campaign, const CalibrationWarning& warning) {
  const auto varies = [&campaign](const std::string& key) {
    const auto begins = [&key](const auto& of) {
      return of.key.starts_with(key) || key.starts_with(of.key + ".");
    };
    return std::any_of(campaign.grid.begin(), campaign.grid.end(), begins) ||
           std::any_of(campaign.drawn.begin(), campaign.drawn.end(), begins);
  };
  return !warning.key.empty() && varies("calibrations") && !varies(warning.key);
}

}  // namespace

CampaignRun draw_run(const Campaign& campaign, std::size_t number, int most_attempts) {
  CampaignRun run;
  run.number = number;
  run.point = number / campaign.draws;
  run.draw = number % campaign.draws;
  const std::uint64_t of_draw = derive_seed(campaign.seed, "draw " + std::to_string(run.draw));
  run.seed = derive_seed(of_draw, "noise");
  run.tells_figures = campaign.of_single_runs;
  RandomGenerator random(derive_seed(of_draw, "values"));
  std::optional<std::vector<std::string>> undrawn_wrong;  // which no draw mends
  const bool draws_again = !campaign.drawn.empty() || campaign.contact;
  for (run.attempts = 1;; ++run.attempts) {
    const bool is_last = !draws_again || run.attempts >= most_attempts;
    try {
      if (draw_once(campaign, random, run)) break;
      if (is_last) throw SetupError("no body moves as 'contact' asks, in none of the draws");
    } catch (const KeyError& error) {
      throw SetupError(of_run(run, error.problems()));
    } catch (const SetupError& error) {
      if (!undrawn_wrong) undrawn_wrong = undrawn_problems(campaign, run);
      if (is_last || have_one_in_common(error.problems(), *undrawn_wrong))
        throw SetupError(of_run(run, error.problems()));
    }
  }
  if (campaign.addition) campaign.addition->add(run.scenario);
  return run;
}

std::vector<CalibrationWarning> check_keys(const Campaign& campaign) {
  const bool draws_again = !campaign.drawn.empty() || campaign.contact;  // which may mend values
  std::vector<CalibrationWarning> warnings;
  const auto look_at = [&](std::size_t point) {
    CampaignRun unused;
    RandomGenerator random(campaign.seed);
    std::size_t digits = point;
    Draft draft = undrawn(campaign, digits, unused);
    draw_values(campaign, random, draft, unused);
    if (campaign.contact && campaign.contact->by == CampaignContact::By::pushing) make_hand(draft);
    auto told = parse_simulated_scenario(draft.root(), draft.file(), *campaign.robots).warnings;
    std::erase_if(told, [&](const CalibrationWarning& warning) { return is_meant(campaign, warning); });
    append_new(told, warnings);
  };
  for (const std::vector<std::size_t>& points : points_by_axis(campaign)) {
    std::vector<std::string> of_keys, of_values;
    for (const std::size_t point : points) {
      try {
        look_at(point);
      } catch (const KeyError& error) {
        append_new(error.of_keys(), of_keys);
      } catch (const SetupError& error) {
        if (!draws_again) append_new(error.problems(), of_values);
      }
    }
    throw_if_any(std::move(of_keys));
    throw_if_any(std::move(of_values));
  }
  return warnings;
}

std::vector<CalibrationWarning> check_campaign(const Campaign& campaign) {
  std::vector<CalibrationWarning> warnings = check_keys(campaign);
  draw_run(campaign, 0);
  return warnings;
}

}  // namespace flinch
