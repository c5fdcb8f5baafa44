#include "learning/evaluation_output.h"
#include "systems/foundation/json_text.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

Json number(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json accuracy_of(const Evaluation& evaluation) {
  return {{"body", number(evaluation.body)},
          {"collision_clamping", number(evaluation.collision_clamping)},
          {"chain", number(evaluation.chain)},
          {"collision", number(evaluation.collision)},
          {"clamping", number(evaluation.clamping)},
          {"all_classes", number(evaluation.confusion.balanced_accuracy())}};
}

Json matrix_of(const Confusion& confusion) {
  Json rows = Json::array();
  const Eigen::MatrixXd shares = confusion.row_normalised();
  for (const auto& row : shares.rowwise()) rows.push_back(std::vector<double>(row.begin(), row.end()));
  return rows;
}

Json confusion_json(const Evaluation& evaluation) {
  Json by_configuration = Json::array();
  for (const auto& [configuration, confusion] : evaluation.by_configuration) {
    by_configuration.push_back({{"configuration", configuration},
                                {"samples", confusion.counts.sum()},
                                {"accuracy", number(confusion.balanced_accuracy())},
                                {"rows", matrix_of(confusion)}});
  }
  return {{"classes", evaluation.confusion.classes},
          {"rows", matrix_of(evaluation.confusion)},
          {"by_configuration", by_configuration}};
}

Json curve_json(const Evaluation& evaluation) {
  Json curve = Json::array();
  for (const RejectPoint& point : evaluation.rejects) {
    curve.push_back({{"rejected", point.rejected},
                     {"accepted_from", point.accepted_from},
                     {"accuracy_of_accepted", 1.0 - point.wrong_of_accepted},
                     {"wrong_of_accepted", point.wrong_of_accepted}});
  }
  return curve;
}

std::string percent(const std::optional<double>& share) {
  return share ? fmt::format("{:6.2f} %", 100.0 * *share) : "       -";
}

std::string confusion_table(const Confusion& confusion) {
  std::string text = fmt::format("{:<16}", "");
  for (const std::string& given : confusion.classes) text += fmt::format(" {:>14}", given);
  text += fmt::format(" {:>9}\n", "samples");
  const Eigen::MatrixXd shares = confusion.row_normalised();
  for (Eigen::Index row = 0; row < shares.rows(); ++row) {
    const double samples = confusion.counts.row(row).sum();
    text += fmt::format("{:<16}", confusion.classes[static_cast<std::size_t>(row)]);
    for (const double share : shares.row(row))
      text += samples > 0.0 ? fmt::format(" {:>12.1f} %", 100.0 * share) : fmt::format(" {:>14}", "-");
    text += fmt::format(" {:>9.0f}\n", samples);
  }
  return text;
}

}  // namespace

std::string evaluation_table(const Evaluation& chosen, const std::vector<Evaluation>& all) {
  std::string text = fmt::format("{:<10} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>12} {:>9} {:>9} {:>13}\n",
                                 "at", "samples", "body", "collision", "clamping", "chain", "all",
                                 "calibration", "rejected", "wrong", "wrong at 10 %");
  for (const Evaluation& each : all) {
    text +=
        fmt::format("{:<10} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>12.4f} {:>9} {:>9} {:>13}\n", each.moment,
                    each.samples, percent(each.body), percent(each.collision), percent(each.clamping),
                    percent(each.chain), percent(each.confusion.balanced_accuracy()), each.calibration_error,
                    percent(each.accepted.rejected), percent(each.accepted.wrong_of_accepted),
                    percent(each.at_tenth.wrong_of_accepted));
  }
  text += fmt::format("\nwhat was touched (rows) was told as ({})\n", chosen.moment) +
          confusion_table(chosen.confusion);
  if (chosen.by_configuration.size() > 1) {
    for (const auto& [configuration, confusion] : chosen.by_configuration)
      text += fmt::format("\nconfiguration {}: {}\n", configuration, percent(confusion.balanced_accuracy())) +
              confusion_table(confusion);
  }
  return text;
}

std::string evaluation_json(const Evaluation& chosen, const std::vector<Evaluation>& all) {
  Json moments = Json::object();
  for (const Evaluation& each : all) {
    moments[each.moment] = {{"samples", each.samples},
                            {"accuracy", accuracy_of(each)},
                            {"expected_calibration_error", each.calibration_error},
                            {"rejected", each.accepted.rejected},
                            {"wrong_of_accepted", each.accepted.wrong_of_accepted},
                            {"wrong_at_tenth_rejected", each.at_tenth.wrong_of_accepted}};
  }
  const Json summary = {{"samples", chosen.samples},
                        {"accuracy", accuracy_of(chosen)},
                        {"confusion", confusion_json(chosen)},
                        {"expected_calibration_error", chosen.calibration_error},
                        {"rejected", chosen.accepted.rejected},
                        {"wrong_of_accepted", chosen.accepted.wrong_of_accepted},
                        {"accepted_from", chosen.accepted.accepted_from},
                        {"wrong_at_tenth_rejected", chosen.at_tenth.wrong_of_accepted},
                        {"reject_curve", curve_json(chosen)},
                        {"at", chosen.moment},
                        {"moments", moments}};
  return json_text(summary);
}

}  // namespace flinch
