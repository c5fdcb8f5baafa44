#include "calibration/calibration_output.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "calibration/calibration_result.h"
#include "systems/config/parameter_file.h"
#include "systems/foundation/json_text.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

Json number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json json_of(const CalibratedParameter& parameter) {
  return {{"name", parameter.name},
          {"value", number(parameter.value)},
          {"standard_deviation", number(parameter.deviation)},
          {"unit", parameter.unit},
          {"identifiable", parameter.identifiable},
          {"before", number(parameter.before)}};
}

FileParameter in_file(const CalibratedParameter& parameter) {
  return {.name = parameter.name,
          .value = parameter.value,
          .deviation = parameter.deviation,
          .unit = parameter.unit,
          .identifiable = parameter.identifiable,
          .belongs_to = parameter.belongs_to};
}

std::string digits(const std::optional<double>& value) { return value ? fmt::format("{:.5g}", *value) : "-"; }

std::string boxes(const CalibrationResult& result) {
  if (result.validation.empty()) return "";
  std::string text =
      fmt::format("\nerrors on recordings that were not used, {}\n{:<20} {:>9} {:>9} {:>9} {:>9} {:>9}\n",
                  result.validation_unit, "at", "least", "quartile", "median", "quartile", "most");
  for (const BoxNumbers& box : result.validation) {
    text += fmt::format("{:<20} {:>9.2f} {:>9.2f} {:>9.2f} {:>9.2f} {:>9.2f}\n", box.name, box.low,
                        box.quartile1, box.median, box.quartile3, box.high);
  }
  return text;
}

}  // namespace

std::string calibration_table(const CalibrationResult& result) {
  std::size_t width = 9;
  for (const CalibratedParameter& parameter : result.parameters)
    width = std::max(width, parameter.name.size());
  std::string text = fmt::format("{:<{}} {:>11} {:>11} {:>11}  {}\n", "parameter", width, "value",
                                 "deviation", "before", "unit");
  for (const CalibratedParameter& parameter : result.parameters) {
    text += fmt::format("{:<{}} {:>11} {:>11} {:>11}  {}{}\n", parameter.name, width, digits(parameter.value),
                        digits(parameter.deviation), digits(parameter.before), parameter.unit,
                        parameter.identifiable ? "" : "   not identifiable: as believed before");
  }
  const std::string residual_unit = behind_residual(result.residual_unit);
  text += fmt::format("\nresidual {:.4g}{} before, {:.4g}{} after\n", result.residual_before, residual_unit,
                      result.residual_after, residual_unit);
  text += boxes(result);
  for (const std::string& note : result.notes) text += "\n" + note;
  if (!result.notes.empty()) text += "\n";
  return text;
}

std::string calibration_json(const CalibrationResult& result) {
  Json recordings = Json::array(), hashes = Json::array(), parameters = Json::array(), boxes = Json::array();
  for (const CalibrationSource& source : result.recordings) {
    recordings.push_back(source.file);
    hashes.push_back(source.sha256);
  }
  for (const CalibratedParameter& parameter : result.parameters) parameters.push_back(json_of(parameter));
  for (const BoxNumbers& box : result.validation) {
    boxes.push_back({{"name", box.name},
                     {"low", box.low},
                     {"quartile1", box.quartile1},
                     {"median", box.median},
                     {"quartile3", box.quartile3},
                     {"high", box.high}});
  }
  return json_text(Json{{"kind", result.kind},
                        {"recordings", recordings},
                        {"parameters", parameters},
                        {"residual_before", number(result.residual_before)},
                        {"residual_after", number(result.residual_after)},
                        {"warnings", result.warnings},
                        {"doubts", result.contradictions},
                        {"notes", result.notes},
                        {"residual_unit", result.residual_unit},
                        {"sha256", hashes},
                        {"rank", result.rank},
                        {"condition", number(result.condition)},
                        {"validation", boxes}});
}

std::string calibration_yaml(const CalibrationResult& result, const std::string& date) {
  ParameterFile file;
  file.kind = result.kind;
  file.date = date;
  file.robot = {result.robot_file, result.robot_sha256};
  file.recordings = result.recordings;
  file.residual_before = result.residual_before;
  file.residual_after = result.residual_after;
  file.residual_unit = result.residual_unit;
  for (const CalibratedParameter& parameter : result.parameters)
    file.parameters.push_back(in_file(parameter));
  for (const CalibratedParameter& parameter : result.assumed) file.assumed.push_back(in_file(parameter));
  return parameter_file_text(file);
}

}  // namespace flinch
