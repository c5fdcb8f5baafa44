#include "systems/config/parameter_file.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

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

using Node = std::shared_ptr<const ConfigNode>;

HashedFile read_hashed(ConfigReader reader) {
  HashedFile hashed;
  reader.required().text("file", hashed.file);
  reader.required().text("sha256", hashed.sha256);
  if (reader.good() && hashed.sha256.size() != 64)
    reader.problem("sha256", "must have 64 hexadecimal digits");
  return hashed;
}

FileParameter read_parameter(ConfigReader& reader) {
  FileParameter parameter;
  double deviation = 0.0;
  reader.required().text("name", parameter.name);
  reader.required().number("value", unit::none, parameter.value);
  reader.text("unit", parameter.unit);
  reader.flag("identifiable", parameter.identifiable);
  reader.text("belongs_to", parameter.belongs_to);
  if (reader.has("standard_deviation")) {
    reader.number("standard_deviation", unit::none, deviation, not_negative);
    parameter.deviation = deviation;
  }
  const std::string& owner = parameter.belongs_to;
  if (!owner.empty() && owner != "robot" && owner != "scenario")
    reader.problem("belongs_to", "is '" + owner + "'; it must be robot or scenario");
  return parameter;
}

ReadValue read_setting(ConfigReader& entry) {
  ReadValue setting;
  entry.required().text("name", setting.key);
  entry.required().text("value", setting.value);
  entry.text("unit", setting.unit);
  return setting;
}

/// In single quotes, in which YAML doubles one that is meant; control characters are no text there.
std::string quoted(const std::string& text) {
  const auto is_control = [](char letter) { return static_cast<unsigned char>(letter) < 0x20; };
  if (std::any_of(text.begin(), text.end(), is_control)) return yaml_line(*scalar_node(text));
  std::string result = "'";
  for (const char letter : text) result += letter == '\'' ? std::string("''") : std::string(1, letter);
  return result + "'";
}

/// A number as the reader takes it, to which those that are too small to compute with are zero.
std::string number_text(double value) { return exact_text(std::abs(value) < least_computable ? 0.0 : value); }

std::string line_of(const FileParameter& parameter) {
  std::string text = "  - {name: " + quoted(parameter.name) + ", value: " + number_text(parameter.value);
  if (parameter.deviation) text += ", standard_deviation: " + number_text(*parameter.deviation);
  if (!parameter.unit.empty()) text += ", unit: " + quoted(parameter.unit);
  text += std::string(", identifiable: ") + (parameter.identifiable ? "true" : "false");
  if (!parameter.belongs_to.empty()) text += ", belongs_to: " + parameter.belongs_to;
  return text + "}\n";
}

std::string line_of(const ReadValue& setting) {
  std::string text = "  - {name: " + quoted(setting.key) + ", value: " + quoted(setting.value);
  if (!setting.unit.empty()) text += ", unit: " + quoted(setting.unit);
  return text + "}\n";
}

std::string line_of(const HashedFile& hashed) {
  return "{file: " + quoted(hashed.file) + ", sha256: " + quoted(hashed.sha256) + "}";
}

/// "drives.torque_constant_Nm_per_A" of "drives.torque_constant_Nm_per_A[0]"; empty where it is no entry of a
/// list of numbers.
std::string list_of(const std::string& name) {
  const std::size_t open = name.rfind('[');
  return name.ends_with(']') && open != std::string::npos ? name.substr(0, open) : "";
}

Node list_node(const std::vector<double>& values) {
  auto node = std::make_shared<ConfigNode>();
  node->kind = ConfigNode::Kind::list;
  for (const double value : values) node->items.push_back(scalar_node(exact_text(value)));
  return node;
}

}  // namespace

ParameterFile parse_parameter_file(std::string_view text, const std::string& file) {
  ParameterFile result;
  result.file = file;
  result.text = text;
  result.nodes = parse_yaml(text, file);
  ConfigReader reader = ConfigReader::over(result.nodes, file);
  require_kind(reader, FileKind::parameters);
  int version = 0;
  reader.required().integer("flinch_calibration", version, 1, ParameterFile::version);
  reader.required().text("kind", result.kind);
  reader.required().text("date", result.date);
  if (reader.has("robot") || !reader.has("control"))
    result.robot = read_hashed(reader.required().section("robot"));
  reader.leave_unread("control");
  for (ConfigReader& recording : reader.sections("recordings"))
    result.recordings.push_back(read_hashed(recording));
  ConfigReader residual = reader.section("residual");
  residual.number("before", unit::none, result.residual_before);
  residual.number("after", unit::none, result.residual_after);
  residual.text("unit", result.residual_unit);
  for (ConfigReader& parameter : reader.sections("parameters"))
    result.parameters.push_back(read_parameter(parameter));
  for (ConfigReader& parameter : reader.sections("assumed"))
    result.assumed.push_back(read_parameter(parameter));
  for (ConfigReader& setting : reader.sections("settings")) result.settings.push_back(read_setting(setting));
  reader.finish();
  return result;
}

ParameterFile read_parameter_file(const std::filesystem::path& file) {
  return parse_parameter_file(read_config_file(file), file.string());
}

std::vector<ParameterFile> read_calibrations(
    ConfigReader& file, const std::function<ParameterFile(const std::filesystem::path&)>& read) {
  constexpr std::size_t most = 100;
  std::vector<ParameterFile> files;
  std::vector<ConfigReader> entries = file.sections("calibrations");
  if (entries.size() > most) {
    file.problem("calibrations", "is a list of " + std::to_string(entries.size()) + "; it may have " +
                                     std::to_string(most) +
                                     " entries, so leave out those that others replace");
    for (ConfigReader& entry : entries) entry.leave_rest_unread();
    return files;
  }
  for (ConfigReader& entry : entries) {
    std::filesystem::path name;
    entry.required().file("file", name);
    if (name.empty()) continue;
    try {
      files.push_back(read(name));
    } catch (const SetupError& error) {
      entry.add_problems(error.problems());
    }
  }
  return files;
}

std::vector<ParameterFile> robot_calibrations(std::string_view robot_text, const std::string& file) {
  ConfigReader reader = ConfigReader::parse(robot_text, file);
  std::vector<ParameterFile> files = read_calibrations(reader);
  reader.leave_rest_unread();  // for who reads the robot
  reader.finish();
  return files;
}

std::string calibrated_robot_hash(std::string_view robot_text) {
  std::string kept;
  bool inside = false;
  while (!robot_text.empty()) {
    const std::string_view line = robot_text.substr(0, robot_text.find('\n') + 1);
    robot_text.remove_prefix(line.empty() ? robot_text.size() : line.size());
    const std::size_t text = line.find_first_not_of(" \t\r\n");
    if (text == std::string_view::npos || line[text] == '#') continue;
    const bool is_key = text == 0 && line.front() != '-' && line.front() != ']';
    if (is_key) inside = line.starts_with("calibrations:") || line.starts_with("control_period_");
    if (!inside) kept += line;
  }
  return sha256(kept);
}

std::string parameter_file_text(const ParameterFile& parameters) {
  std::string text =
      "# Written by flinch calibrate. A scenario takes it over with\n#   calibrations: [{file: NAME}]\n";
  text += "flinch_calibration: " + std::to_string(ParameterFile::version) + "\n";
  text += "kind: " + parameters.kind + "\ndate: '" + parameters.date + "'\n";
  if (!parameters.robot.sha256.empty()) text += "robot: " + line_of(parameters.robot) + "\n";
  if (!parameters.recordings.empty()) text += "recordings:\n";
  for (const HashedFile& recording : parameters.recordings) text += "  - " + line_of(recording) + "\n";
  if (!parameters.residual_unit.empty()) {
    text += "residual: {before: " + number_text(parameters.residual_before) +
            ", after: " + number_text(parameters.residual_after) +
            ", unit: " + quoted(parameters.residual_unit) + "}\n";
  }
  if (!parameters.parameters.empty()) text += "parameters:\n";
  for (const FileParameter& parameter : parameters.parameters) text += line_of(parameter);
  if (!parameters.assumed.empty()) text += "assumed:\n";
  for (const FileParameter& parameter : parameters.assumed) text += line_of(parameter);
  if (!parameters.settings.empty()) text += "settings:\n";
  for (const ReadValue& setting : parameters.settings) text += line_of(setting);
  return text;
}

std::string with_parameters(std::string_view robot_text, const std::string& file,
                            const ParameterFile& parameters) {
  Node root = parse_yaml(robot_text, file);
  std::map<std::string, std::vector<double>> lists;
  for (const FileParameter& parameter : parameters.parameters) {
    if (parameter.belongs_to != "robot" || !parameter.identifiable) continue;
    const std::string list = list_of(parameter.name);
    if (list.empty()) {
      root = with_value(*root, parameter.name, scalar_node(exact_text(parameter.value)));
      continue;
    }
    std::vector<double>& values = lists[list];
    const std::string expected = list + "[" + std::to_string(values.size()) + "]";
    if (parameter.name != expected) {
      throw SetupError(parameters.file + ": '" + parameter.name + "' stands where '" + expected +
                       "' should; a list is taken over as a whole");
    }
    values.push_back(parameter.value);
  }
  for (const auto& [list, values] : lists) root = with_value(*root, list, list_node(values));
  return yaml_text(*root);
}

}  // namespace flinch
