#include "experiments/campaign/campaign.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "experiments/scenario/key_values.h"
#include "experiments/scenario/robot_files.h"
#include "experiments/scenario/scenario.h"
#include "experiments/scenario/scenario_calibrations.h"
#include "systems/config/config_file.h"
#include "systems/config/config_node.h"
#include "systems/config/config_reader.h"
#include "systems/config/file_kind.h"
#include "systems/config/parsed.h"
#include "systems/config/yaml_text.h"
#include "systems/foundation/setup_error.h"
#include "systems/foundation/sha256.h"

namespace flinch {
namespace {

constexpr double most_runs = 1e8;             // of all points of the grid
constexpr std::size_t most_scenarios = 1000;  // each is read before the first run
constexpr std::size_t most_values = 10'000;   // of all keys; each is tried before the first run

void check_count(ConfigReader& reader, const char* name, std::size_t count, std::size_t most) {
  if (count <= most) return;
  reader.problem(name, "has " + std::to_string(count) + " entries in all; it may have " +
                           std::to_string(most) + ", so make several campaigns of it");
}

void read_scenarios(ConfigReader& reader, Campaign& campaign) {
  if (reader.one_of({"scenario", "scenarios"}) == "scenarios") {
    std::vector<ConfigReader> entries = reader.sections("scenarios");
    check_count(reader, "scenarios", entries.size(), most_scenarios);
    for (ConfigReader& entry : entries) {
      if (entries.size() > most_scenarios)
        entry.leave_rest_unread();
      else
        entry.required().file("file", campaign.scenarios.emplace_back());
    }
  } else {
    reader.required().file("scenario", campaign.scenarios.emplace_back());
  }
}

/// What is wrong with a key of the scenario that is to be varied; "" if nothing is.
std::string problem_with_key(const std::string& key) {
  if (key == "seed")
    return "is 'seed', but each run has a seed of its own; 'seed' of the campaign draws others";
  if (key == "title" || key == "description") return "is '" + key + "', which changes nothing of a run";
  return "";
}

void check_key(ConfigReader& reader, const std::string& key) {
  const std::string problem = problem_with_key(key);
  if (!problem.empty()) reader.problem("key", problem);
}

CampaignDraw read_draw(ConfigReader& reader, const std::shared_ptr<const std::string>& file) {
  CampaignDraw draw;
  draw.file = file;
  draw.line = reader.line();
  reader.required().text("key", draw.key);
  check_key(reader, draw.key);
  const std::string_view given = reader.one_of({"of", "from"});
  if (given == "of") reader.required().nodes("of", draw.of);
  if (given != "from") return draw;
  reader.required().number("from", unit::none, draw.from);
  reader.required().number("to", unit::none, draw.to);
  reader.choice("scale", draw.scale,
                {{"linear", CampaignDraw::Scale::linear}, {"logarithmic", CampaignDraw::Scale::logarithmic}});
  if (draw.to < draw.from) reader.problem("to", "is below 'from'");
  if (draw.scale == CampaignDraw::Scale::logarithmic && draw.from <= 0.0) {
    reader.problem("from", "is not positive; a logarithmic scale needs that");
  }
  return draw;
}

CampaignAxis read_axis(ConfigReader& reader) {
  CampaignAxis axis;
  reader.required().text("key", axis.key);
  check_key(reader, axis.key);
  reader.required().nodes("values", axis.values);
  return axis;
}

/// "a.b=1,2" as an axis of the grid.
CampaignAxis parsed_axis(const std::string& text) {
  KeyValues given = parse_key_values(text);
  const std::string problem = problem_with_key(given.key);
  if (!problem.empty()) throw SetupError("--set " + text + ": the key " + problem);
  return {std::move(given.key), std::move(given.values)};
}

/// The axis takes the place of whatever the file says of its key, in whatever unit.
void replace(const CampaignAxis& axis, Campaign& campaign) {
  const auto is_same = [&axis](const auto& other) { return name_one_value(other.key, axis.key); };
  std::erase_if(campaign.drawn, is_same);
  const auto same = std::find_if(campaign.grid.begin(), campaign.grid.end(), is_same);
  if (same == campaign.grid.end()) {
    campaign.grid.push_back(axis);
  } else {
    *same = axis;
  }
}

/// Grid and draws; a key has its values from one of them.
void read_varied(ConfigReader& reader, Campaign& campaign) {
  std::vector<std::string> keys;
  const auto note = [&keys](ConfigReader& entry, const std::string& key) {
    const auto earlier = std::find_if(
        keys.begin(), keys.end(), [&key](const std::string& other) { return name_one_value(other, key); });
    if (earlier != keys.end())
      entry.problem("key", "is '" + key + "', but '" + *earlier + "' is varied already; keep one of them");
    keys.push_back(key);
  };
  for (ConfigReader& axis : reader.sections("grid")) {
    campaign.grid.push_back(read_axis(axis));
    note(axis, campaign.grid.back().key);
  }
  std::size_t values = 0;
  for (const CampaignAxis& axis : campaign.grid) values += axis.values.size();
  check_count(reader, "grid", values, most_values);
  const auto name = std::make_shared<const std::string>(campaign.file.string());
  for (ConfigReader& draw : reader.sections("draw")) {
    campaign.drawn.push_back(read_draw(draw, name));
    note(draw, campaign.drawn.back().key);
  }
  values = 0;
  for (const CampaignDraw& draw : campaign.drawn) values += draw.of.size();
  check_count(reader, "draw", values, most_values);
}

CampaignContact read_contact(ConfigReader& reader) {
  using By = CampaignContact::By;
  CampaignContact contact;
  reader.required().words("body", contact.bodies, {"platform", "link1", "link2", "clamping"});
  const bool is_known = reader.choice(
      "by", contact.by, {{"standing", By::standing}, {"moving", By::moving}, {"pushing", By::pushing}});
  if (!is_known) reader.leave_rest_unread();
  if (contact.by == By::moving) reader.number("speed", unit::m_per_s, contact.speed, not_negative);
  if (contact.by == By::pushing) {
    contact.force = {20.0, 60.0};
    reader.numbers("force", unit::N, contact.force, positive);
    reader.number("angle", unit::rad, contact.angle, not_negative);
    reader.number("rise", unit::s, contact.rise, positive);
    reader.number("hold", unit::s, contact.hold, not_negative);
  }
  const bool is_clamped =
      std::find(contact.bodies.begin(), contact.bodies.end(), "clamping") != contact.bodies.end();
  if (is_clamped) reader.number("gap", unit::m, contact.gap, not_negative);
  if (contact.by != By::standing && is_clamped) {
    reader.problem("body", "has 'clamping', which only an obstacle that is 'standing' can be drawn for");
  }
  return contact;
}

std::string line_of(const std::vector<std::shared_ptr<const ConfigNode>>& values) {
  std::string line;
  for (const auto& value : values) line += (line.empty() ? "" : ", ") + yaml_line(*value);
  return line;
}

bool names_files(const std::string& key) { return key == "robot" || key.starts_with("calibrations"); }

/// The scenario with this value; null where its place is made by another key that is varied.
std::shared_ptr<const ConfigNode> varied(const ConfigNode& scenario, const std::string& key,
                                         const std::shared_ptr<const ConfigNode>& value) {
  try {
    return with_value(scenario, key, value);
  } catch (const SetupError&) {
    return nullptr;
  }
}

/// Reads robot and calibrations that a scenario names, `together`: of which one is for the other. Throws
/// SetupError with all that is wrong with them.
void read_named(const std::shared_ptr<const ConfigNode>& scenario, const std::filesystem::path& file,
                bool together, RobotFiles& robots) {
  ConfigReader reader = ConfigReader::over(scenario, file.string());
  reader.leave_rest_unread();
  std::filesystem::path name;
  reader.required().file("robot", name);
  std::shared_ptr<const RobotFiles::Entry> robot;
  try {
    if (!name.empty()) robot = robots.read(name);
  } catch (const SetupError& error) {
    reader.add_problems(error.problems());
  }
  const std::vector<ParameterFile> own = read_calibrations(
      reader, [&robots](const std::filesystem::path& each) { return *robots.read_calibration(each); });
  reader.finish();
  if (!together) return;
  std::vector<ParameterFile> all = robot->calibrations;
  all.insert(all.end(), own.begin(), own.end());
  check_thresholds(all, robot->robot);
}

/// Those of a scenario, but for what comes with flinch.
void hash_networks(const Scenario& scenario, std::set<std::string>& hashes) {
  const IsolationSettings& isolation = scenario.control.isolation;
  const PapersNetworkFiles& papers = isolation.papers_networks;
  for (const auto& file : {isolation.learned_network, papers.clamping, papers.chain, papers.body}) {
    if (!file.empty() && std::filesystem::exists(file)) hashes.insert(sha256_of(file));
  }
}

/// Those of the scenarios with each of these values of a key.
void hash_varied_networks(const std::string& key, const auto& values, Campaign& campaign) {
  const bool names_networks = key.starts_with("control.isolation.learned_classifier") ||
                              key.starts_with("control.isolation.papers_networks");
  if (!names_networks) return;
  for (const auto& value : values) {
    for (std::size_t i = 0; i < campaign.scenarios.size(); ++i) {
      const auto scenario = varied(*campaign.scenario_nodes[i], key, value);
      if (!scenario) continue;
      hash_networks(parse_scenario(scenario, campaign.scenarios[i], *campaign.robots),
                    campaign.network_hashes);
    }
  }
}

/// The same of every value of the keys by which the campaign varies them.
void read_varied_files(const Campaign& campaign) {
  std::vector<std::string> problems;
  const auto note = [&problems](const std::string& problem) {
    if (std::find(problems.begin(), problems.end(), problem) == problems.end()) problems.push_back(problem);
  };
  std::vector<std::string> keys;
  for (const CampaignAxis& axis : campaign.grid) keys.push_back(axis.key);
  for (const CampaignDraw& draw : campaign.drawn) keys.push_back(draw.key);
  const bool together = std::count_if(keys.begin(), keys.end(), names_files) < 2;
  const auto read_values = [&](const std::string& key, const auto& values) {
    if (!names_files(key)) return;
    for (const auto& value : values) {
      for (std::size_t i = 0; i < campaign.scenarios.size(); ++i) {
        const auto scenario = varied(*campaign.scenario_nodes[i], key, value);
        try {
          if (scenario) read_named(scenario, campaign.scenarios[i], together, *campaign.robots);
        } catch (const SetupError& error) {
          std::for_each(error.problems().begin(), error.problems().end(), note);
        }
      }
    }
  };
  for (const CampaignAxis& axis : campaign.grid) read_values(axis.key, axis.values);
  for (const CampaignDraw& draw : campaign.drawn) read_values(draw.key, draw.of);
  throw_if_any(std::move(problems));
}

/// Counted in real numbers, which do not overflow.
void check_size(const Campaign& campaign) {
  double runs = static_cast<double>(campaign.draws) * static_cast<double>(campaign.scenarios.size());
  for (const CampaignAxis& axis : campaign.grid) runs *= static_cast<double>(axis.values.size());
  if (campaign.contact) runs *= static_cast<double>(campaign.contact->bodies.size());
  if (runs <= most_runs) return;
  throw SetupError(campaign.file.string() + ": asks for " + exact_text(runs) +
                   " runs, with 'runs' at each point of 'grid'; at most " + exact_text(most_runs) +
                   " can be");
}

}  // namespace

std::string CampaignAxis::name_of(std::size_t value) const {
  return names.empty() ? yaml_line(*values[value]) : names[value];
}

std::string Campaign::identity() const {
  std::string text = "flinch " FLINCH_VERSION "\nseed " + std::to_string(seed) + "\ndraws " +
                     std::to_string(draws) + "\nmissed after " + exact_text(missed_after) + "\n";
  for (const CampaignAxis& axis : grid) text += "grid " + axis.key + ": " + line_of(axis.values) + "\n";
  for (const CampaignDraw& draw : drawn) {
    text += "draw " + draw.key + ": " + exact_text(draw.from) + " " + exact_text(draw.to) + " " +
            std::to_string(static_cast<int>(draw.scale)) + " " + line_of(draw.of) + "\n";
  }
  if (contact) {
    for (const std::string& body : contact->bodies) text += "contact " + body + "\n";
    text += "by " + std::to_string(static_cast<int>(contact->by)) + " " + exact_text(contact->speed) + " " +
            exact_text(contact->angle) + " " + exact_text(contact->rise) + " " + exact_text(contact->hold);
    for (const double force : contact->force) text += " " + exact_text(force);
    if (contact->gap > 0.0) text += " gap " + exact_text(contact->gap);
    text += "\n";
  }
  if (addition) text += addition->identity + "\n";
  if (task) text += task->identity + "\n";
  if (of_single_runs) text += "single runs\n";
  for (const std::string& scenario : scenario_texts) text += scenario;
  for (const std::string& robot : robot_texts) text += robot;
  for (const std::string& network : network_hashes) text += "network " + network + "\n";
  return text;
}

std::size_t Campaign::grid_points() const {
  std::size_t points = scenarios.size();
  for (const CampaignAxis& axis : grid) points *= axis.values.size();
  return contact ? points * contact->bodies.size() : points;
}

Campaign read_campaign(const std::filesystem::path& file, const CampaignOverrides& overrides) {
  Campaign campaign;
  campaign.file = file;
  campaign.name = file.stem().string();
  campaign.title = campaign.name;
  campaign.file_text = read_config_file(file);
  ConfigReader reader = ConfigReader::parse(campaign.file_text, file.string());
  require_kind(reader, FileKind::campaign);
  reader.text("title", campaign.title);
  reader.text("description", campaign.description);
  read_scenarios(reader, campaign);
  int draws = 1;
  reader.integer("runs", draws, 1, 10'000'000);
  campaign.draws = static_cast<std::size_t>(draws);
  reader.seed("seed", campaign.seed);
  reader.number("missed_after", unit::s, campaign.missed_after, positive);
  reader.choice("summary", campaign.summary,
                {{"detections", Campaign::Summary::detections}, {"reactions", Campaign::Summary::reactions}});
  read_varied(reader, campaign);
  if (reader.has("contact")) {
    ConfigReader contact = reader.section("contact");
    campaign.contact = read_contact(contact);
  }
  reader.finish();

  std::vector<std::string> problems;
  for (const std::string& text : overrides.set) {
    try {
      replace(parsed_axis(text), campaign);
    } catch (const SetupError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  throw_if_any(std::move(problems));
  if (overrides.draws) campaign.draws = *overrides.draws;
  if (overrides.seed) campaign.seed = *overrides.seed;
  check_size(campaign);
  campaign.robots = std::make_shared<RobotFiles>();
  for (const std::filesystem::path& file_of_scenario : campaign.scenarios) {
    campaign.scenario_texts.push_back(read_config_file(file_of_scenario));
    campaign.scenario_nodes.push_back(parse_yaml(campaign.scenario_texts.back(), file_of_scenario.string()));
    hash_networks(parse_scenario(campaign.scenario_nodes.back(), file_of_scenario, *campaign.robots),
                  campaign.network_hashes);
  }
  read_varied_files(campaign);
  for (const CampaignAxis& axis : campaign.grid) hash_varied_networks(axis.key, axis.values, campaign);
  campaign.robot_texts = campaign.robots->texts();
  return campaign;
}

}  // namespace flinch
