#include "experiments/report/report_json.h"
#include "systems/foundation/json_text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

namespace flinch {
namespace {

using nlohmann::json;

/// Nearest number with six significant digits; null where it is not finite. Small whole numbers are written
/// without a fraction, because columns are full of zeros.
json rounded(double value) {
  if (!std::isfinite(value)) return nullptr;
  if (std::abs(value) < 1e6 && value == std::trunc(value)) return static_cast<int>(value);
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 6).ptr;
  std::from_chars(text.data(), end, value);
  return value;
}

json rounded(const std::optional<double>& value) { return value ? rounded(*value) : json(nullptr); }

json rounded(const ReportPoint& point) { return {rounded(point[0]), rounded(point[1]), rounded(point[2])}; }

template <typename Values, typename Encode>
json list(const Values& values, Encode encode) {
  json result = json::array();
  for (const auto& value : values) result.push_back(encode(value));
  return result;
}

json encode(const ReportContact& contact) {
  return {{"body", contact.body},
          {"clamping_leg", contact.clamping_leg},
          {"isolated_body", contact.isolated_body},
          {"several_contacts", contact.several_contacts},
          {"object", contact.object},
          {"start", rounded(contact.start)},
          {"detected", rounded(contact.detected)},
          {"detected_by", list(contact.detected_by,
                               [](const auto& by) {
                                 return json::array({by.first, rounded(by.second)});
                               })},
          {"could_stop", contact.could_stop ? json(*contact.could_stop) : json(nullptr)},
          {"removed", rounded(contact.removed)},
          {"speed", rounded(contact.speed)},
          {"peak_force", rounded(contact.peak_force)},
          {"peak_time", rounded(contact.peak_time)},
          {"lasting_force", rounded(contact.lasting_force)},
          {"force_limit", rounded(contact.force_limit)},
          {"limit_name", contact.limit_name},
          {"over_limit", rounded(contact.over_limit)},
          {"within_limit", contact.within_limit}};
}

json encode(const ReportMeasure& measure) {
  return {{"name", measure.name},
          {"value", rounded(measure.value)},
          {"unit", measure.unit},
          {"bound", rounded(measure.bound)},
          {"good", measure.good ? json(*measure.good) : json(nullptr)},
          {"note", measure.note}};
}

json encode(const ReportLeg& leg) {
  return {{"base", rounded(leg.base)}, {"coupling", rounded(leg.coupling)}};
}

json encode(const ReportRobot& robot) {
  return {{"legs", list(robot.legs, [](const ReportLeg& leg) { return encode(leg); })},
          {"link_radius", rounded(robot.link_radius)},
          {"platform", list(robot.platform, [](const ReportPoint& point) { return rounded(point); })},
          {"platform_radius", rounded(robot.platform_radius)}};
}

json encode(const ReportObstacle& obstacle) {
  return {{"name", obstacle.name},
          {"points", list(obstacle.points, [](const ReportPoint& point) { return rounded(point); })},
          {"radius", rounded(obstacle.radius)}};
}

json encode(const ReportBound& bound) {
  return {{"chart", bound.chart}, {"name", bound.name}, {"value", rounded(bound.value)}};
}

/// Only the samples at which the state changes, as [index of sample, state].
json encode(const ReportLane& lane) {
  json changes = json::array();
  for (size_t k = 0; k < lane.state.size(); ++k) {
    if (k == 0 || lane.state[k] != lane.state[k - 1]) changes.push_back({k, lane.state[k]});
  }
  return {{"name", lane.name}, {"states", lane.states}, {"changes", changes}};
}

json encode(const ReportParameter& parameter) {
  return {{"group", parameter.group},
          {"name", parameter.name},
          {"value", parameter.value},
          {"unit", parameter.unit},
          {"note", parameter.note}};
}

json encode(const ReportText& text) { return {{"title", text.title}, {"text", text.text}}; }

template <typename Value>
json encode_all(const std::vector<Value>& values) {
  return list(values, [](const Value& value) { return encode(value); });
}

json columns_of(const Report& report) {
  json columns = json::object();
  for (const auto& [name, values] : report.columns) {
    columns[name] = list(values, [](double value) { return rounded(value); });
  }
  return columns;
}

}  // namespace

std::string samples_json(const Report& report) {
  return "\"columns\": " + json_text(columns_of(report)) +
         ", \"lanes\": " + json_text(encode_all(report.lanes));
}

std::string report_json(const Report& report) {
  const json data = {{"title", report.title},
                     {"kind", report.kind},
                     {"subtitle", report.subtitle},
                     {"note", report.note},
                     {"good", report.good},
                     {"reasons", report.reasons},
                     {"remarks", report.remarks},
                     {"checks_off", report.checks_off},
                     {"fault", report.fault},
                     {"contacts_known", report.contacts_known},
                     {"contacts", encode_all(report.contacts)},
                     {"measures", encode_all(report.measures)},
                     {"robot", report.robot ? encode(*report.robot) : json(nullptr)},
                     {"drive_unit", report.drive_unit},
                     {"obstacles", encode_all(report.obstacles)},
                     {"start", report.start},
                     {"period", report.period},
                     {"count", report.sample_count()},
                     {"columns", columns_of(report)},
                     {"estimators", report.estimators},
                     {"lanes", encode_all(report.lanes)},
                     {"bounds", encode_all(report.bounds)},
                     {"parameters", encode_all(report.parameters)},
                     {"provenance", encode_all(report.provenance)},
                     {"texts", encode_all(report.texts)}};
  return json_text(data);
}

}  // namespace flinch
