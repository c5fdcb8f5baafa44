#include "experiments/campaign/sweep.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "experiments/campaign/sweep_page/sweep_page_template.h"
#include "experiments/report/script_data.h"
#include "experiments/scenario/key_values.h"
#include "experiments/scenario/robot_files.h"
#include "experiments/simulated/simulated_scenario.h"
#include "systems/config/config_node.h"
#include "systems/config/unit.h"
#include "systems/config/yaml_text.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using SweepJson = nlohmann::ordered_json;
using SweptNode = std::shared_ptr<const ConfigNode>;

constexpr std::size_t most_runs_of_sweep = 1'000'000;

CampaignAxis swept_axis(const std::string& text, const std::vector<ReadValue>& read) {
  const KeyValues given = parse_key_values(text);
  KeyValues as = as_read(given, read);
  CampaignAxis axis{std::move(as.key), std::move(as.values)};
  for (const SweptNode& value : given.values) axis.names.push_back(yaml_line(*value));
  return axis;
}

/// Throws SetupError where one key has its values twice.
void require_each_once(const std::vector<CampaignAxis>& axes) {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (name_one_value(axes[i].key, axes[k].key))
        throw SetupError("--set " + axes[i].key + ": is given several values twice; keep one of them");
    }
  }
}

void require_no_more_than_can_be(const Campaign& sweep) {
  double runs = 1.0;  // a real number does not overflow
  for (const CampaignAxis& axis : sweep.grid) runs *= static_cast<double>(axis.values.size());
  if (runs <= static_cast<double>(most_runs_of_sweep)) return;
  throw SetupError(
      fmt::format("--set: asks for {:.0f} runs, each value of a key with each of the others; at "
                  "most {} can be",
                  runs, most_runs_of_sweep));
}

// ---------------------------------------------------------------- rows

/// A value as JSON: a number where it is one.
SweepJson value_json(const std::string& text) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || rest != end || !std::isfinite(number)) return text;
  const bool is_whole = number == std::floor(number) && std::abs(number) < 1e15;
  return is_whole ? SweepJson(static_cast<std::int64_t>(number)) : SweepJson(number);
}

SweepJson value_of(const RunResult& result) {
  if (result.values.size() == 1) return value_json(result.values.front().second);
  SweepJson values = SweepJson::object();
  for (const auto& [key, value] : result.values) values[key] = value_json(value);
  return values;
}

SweepJson figures_of(const RunResult& result) {
  SweepJson figures = SweepJson::parse(result.figures);
  figures.erase("wall_s");  // which differs from call to call
  return figures;
}

std::string name_of(const std::vector<std::pair<std::string, std::string>>& values) {
  std::string name;
  for (const auto& [key, value] : values) name += (name.empty() ? "" : ", ") + value;
  return name;
}

/// "12.3"; "-" for what did not happen.
std::string told(const SweepJson& value, int decimals) {
  return value.is_number() ? fmt::format("{:.{}f}", value.get<double>(), decimals) : "-";
}

std::string told_row(const RunResult& result) {
  const SweepJson figures = figures_of(result);
  const bool touched = !figures["contacts"].empty();
  const SweepJson first = touched ? figures["contacts"][0] : SweepJson::object();
  const auto of_first = [&](const char* key, int decimals) {
    return told(first.value(key, SweepJson()), decimals);
  };
  return fmt::format("{:<7} {:<15} {:>11} {:>10} {:>8} {:>8} {:>6} {:>10} {:>12}  {}",
                     result.good ? "good" : "bad",
                     touched && first["body"].is_string() ? first["body"].get<std::string>() : "-",
                     of_first("detection_ms", 1), of_first("removal_ms", 1), of_first("peak_force_N", 0),
                     of_first("over_limit_ms", 0), figures["false_detections"].dump(),
                     told(figures["max_observer_error_N"], 2), told(figures["max_tracking_error_mm"], 2),
                     result.fault.empty() ? "" : "fault: " + result.fault);
}

// ---------------------------------------------------------------- page

/// A figure of the page: how it is called, its unit, and its value in each row.
struct Curve {
  std::string name;
  std::string unit;
  std::vector<SweepJson> values;
};

/// "peak_force_N" as a name and a unit.
std::pair<std::string, std::string> name_and_unit(const std::string& key) {
  std::string name = key, unit;
  for (std::size_t at = key.find('_'); at != std::string::npos && unit.empty(); at = key.find('_', at + 1)) {
    const std::string end = key.substr(at + 1);
    const KeyUnit* const known = find_key_unit(end);
    if (known == nullptr) continue;
    name = key.substr(0, at);
    unit = known->key == known->si.key ? std::string(known->si.symbol) : end;
  }
  std::replace(name.begin(), name.end(), '_', ' ');
  return {name, unit};
}

/// The numbers among the figures of a run: of contacts those of the first.
void collect_numbers(const SweepJson& figures, const std::string& before, SweepJson& numbers) {
  for (const auto& [key, value] : figures.items()) {
    if (value.is_number()) numbers[before + key] = value;
    if (value.is_boolean()) numbers[before + key] = value.get<bool>() ? 1 : 0;
    if (value.is_object()) collect_numbers(value, before + key + " ", numbers);
  }
}

SweepJson numbers_of(const RunResult& result) {
  SweepJson figures = figures_of(result), numbers = SweepJson::object();
  numbers["contacts"] = figures["contacts"].size();
  if (!figures["contacts"].empty()) collect_numbers(figures["contacts"][0], "first contact: ", numbers);
  for (const char* other : {"contacts", "force_limits", "robot_drawn", "seed"}) figures.erase(other);
  collect_numbers(figures, "", numbers);
  return numbers;
}

std::vector<Curve> curves_of(const CampaignResults& results) {
  std::vector<Curve> curves;
  std::map<std::string, std::size_t> places;
  std::size_t row = 0;
  for (const RunResult& result : results) {
    const SweepJson numbers = numbers_of(result);
    for (const auto& [key, value] : numbers.items()) {
      const auto [place, is_new] = places.try_emplace(key, curves.size());
      if (is_new) {
        const auto [name, unit] = name_and_unit(key);
        curves.push_back({name, unit, std::vector<SweepJson>(results.size())});
      }
      curves[place->second].values[row] = value;
    }
    ++row;
  }
  return curves;
}

bool is_constant(const Curve& curve) {
  return std::all_of(curve.values.begin(), curve.values.end(),
                     [&](const SweepJson& value) { return value == curve.values.front(); });
}

}  // namespace

bool gives_several_values(const std::string& set) {
  try {
    return parse_key_values(set).values.size() > 1;
  } catch (const SetupError&) {
    return false;
  }
}

Campaign read_sweep(const std::filesystem::path& file, const std::vector<std::string>& set,
                    std::optional<std::uint64_t> seed) {
  Campaign sweep;
  sweep.of_single_runs = true;
  sweep.file = file;
  sweep.name = file.stem().string();
  sweep.title = sweep.name;
  sweep.scenarios = {file};
  sweep.robots = std::make_shared<RobotFiles>();
  std::vector<std::string> held, swept;
  for (const std::string& text : set) (gives_several_values(text) ? swept : held).push_back(text);
  std::vector<ReadValue> read;
  const auto values_of = [&](const SweptNode& root) {
    const SimulatedScenario scenario = parse_simulated_scenario(root, file, *sweep.robots, seed);
    sweep.title = scenario.title;
    sweep.description = scenario.description;
    return read = scenario.values;
  };
  SweptNode root = scenario_with(file, held, values_of);
  if (seed) root = with_value(*root, "seed", scalar_node(std::to_string(*seed)));
  for (const std::string& text : swept) sweep.grid.push_back(swept_axis(text, read));
  const bool varies_seed = std::any_of(sweep.grid.begin(), sweep.grid.end(),
                                       [](const CampaignAxis& axis) { return axis.key == "seed"; });
  if (seed && varies_seed) throw SetupError("--seed: 'seed' is varied with --set; keep one of them");
  require_each_once(sweep.grid);
  require_no_more_than_can_be(sweep);
  sweep.scenario_nodes = {root};
  sweep.scenario_texts = {yaml_text(*root)};
  sweep.robot_texts = sweep.robots->texts();
  return sweep;
}

std::string sweep_table(const Campaign& sweep, const CampaignResults& results) {
  std::string keys;
  for (const CampaignAxis& axis : sweep.grid) keys += (keys.empty() ? "" : ", ") + axis.key;
  std::size_t width = 8;
  for (const RunResult& result : results) width = std::max(width, name_of(result.values).size());
  std::string text = fmt::format("{}: {} runs over {}\n\n", sweep.title, results.size(), keys);
  text += fmt::format("{:>{}}  {:<7} {:<15} {:>11} {:>10} {:>8} {:>8} {:>6} {:>10} {:>12}\n", "value", width,
                      "verdict", "contact with", "detected ms", "removed ms", "peak N", "above ms", "false",
                      "observer N", "tracking mm");
  for (const RunResult& result : results)
    text += fmt::format("{:>{}}  {}\n", name_of(result.values), width, told_row(result));
  return text;
}

std::string sweep_json(const Campaign& sweep, const CampaignResults& results) {
  SweepJson keys = SweepJson::array(), rows = SweepJson::array();
  for (const CampaignAxis& axis : sweep.grid) keys.push_back(axis.key);
  for (const RunResult& result : results) {
    SweepJson row = {{"value", value_of(result)}};
    row.update(figures_of(result));
    rows.push_back(std::move(row));
  }
  return json_text(SweepJson{{"keys", keys}, {"rows", rows}});
}

std::string sweep_page(const Campaign& sweep, const CampaignResults& results, const RunCall& call_of,
                       const std::string& call) {
  SweepJson keys = SweepJson::array(), rows = SweepJson::array(), curves = SweepJson::array(),
            same = SweepJson::array();
  for (const CampaignAxis& axis : sweep.grid) keys.push_back(axis.key);
  for (const RunResult& result : results) {
    SweepJson values = SweepJson::array();
    for (const auto& [key, value] : result.values) values.push_back(value_json(value));
    rows.push_back({{"values", values},
                    {"good", result.good},
                    {"fault", result.fault},
                    {"call", call_of(result.values)}});
  }
  for (const Curve& curve : curves_of(results)) {
    if (is_constant(curve))
      same.push_back({{"name", curve.name}, {"unit", curve.unit}, {"value", curve.values.front()}});
    else
      curves.push_back({{"name", curve.name}, {"unit", curve.unit}, {"values", curve.values}});
  }
  const SweepJson data = {
      {"title", sweep.title},
      {"description", sweep.description},
      {"keys", keys},
      {"rows", rows},
      {"curves", curves},
      {"same", same},
      {"provenance",
       {{"Version", "flinch " FLINCH_VERSION}, {"File", sweep.file.filename().string()}, {"Call", call}}},
      {"text", sweep.scenario_texts.front()}};
  return std::string(sweep_page_template_before_data) + inside_script(json_text(data)) +
         std::string(sweep_page_template_after_data);
}

}  // namespace flinch
