#include "experiments/scenario/scenario_fused_detector.h"

#include <algorithm>

#include "diagrams/fused_detector_settings.h"
#include "systems/config/config_reader.h"
#include "systems/foundation/nearest_name.h"
#include "systems/robot/mechanism.h"

namespace flinch {
namespace {

void read(ConfigReader reader, bool drives_turn, MahalanobisThreshold& limit) {
  ConfigReader needed = reader.required();
  needed.number("threshold", unit::none, limit.threshold, positive);
  needed.number("noise", drives_turn ? unit::Nm : unit::N, limit.errors.noise, positive);
  reader.number("speed", drives_turn ? unit::Nms_per_rad : unit::Ns_per_m, limit.errors.speed, not_negative);
  reader.number("load", unit::none, limit.errors.load, not_negative);
  reader.number("torque", unit::none, limit.errors.torque, not_negative);
  reader.number("friction", unit::none, limit.errors.friction, not_negative);
  reader.number("lag", unit::s, limit.errors.lag, not_negative);
  reader.number("rest", drives_turn ? unit::Nm : unit::N, limit.errors.rest, not_negative);
  reader.number("acceleration", drives_turn ? unit::rad_per_s2 : unit::m_per_s2, limit.errors.acceleration,
                not_negative);
  reader.number("turning", unit::none, limit.errors.turning, not_negative);
}

void read(ConfigReader reader, OnsetThreshold& onset) {
  ConfigReader needed = reader.required();
  needed.number("threshold", unit::none, onset.threshold, positive);
  needed.number("innovation", unit::none, onset.course.innovation, positive);
  needed.numbers("prediction", unit::none, onset.course.prediction);
}

bool has(const std::vector<FusedResidual>& residuals, const std::string& estimator) {
  return std::any_of(residuals.begin(), residuals.end(),
                     [&](const FusedResidual& residual) { return residual.estimator == estimator; });
}

}  // namespace

void read_fused_detector(ConfigReader fused, DriveKind drives, const std::vector<std::string>& estimators,
                         FusedDetectorSettings& settings) {
  const bool turn = drives == DriveKind::revolute;
  fused.number("tracking", unit::per_s, settings.tracking.rate, positive);
  fused.number("smoothing", unit::per_s, settings.tracking.smoothing, positive);
  fused.choice("rule", settings.rule,
               {{"chi_square", ChangeRule::chi_square}, {"likelihood_ratio", ChangeRule::likelihood_ratio}});
  if (fused.has("residuals")) settings.residuals.clear();
  for (ConfigReader& own : fused.sections("residuals")) {
    FusedResidual residual;
    own.required().text("estimator", residual.estimator);
    const std::string& name = residual.estimator;
    if (std::find(estimators.begin(), estimators.end(), name) == estimators.end()) {
      own.problem("estimator", "is '" + name + "', which is no estimator" + did_you_mean(name, estimators));
    } else if (has(settings.residuals, name)) {
      own.problem("estimator", "is '" + name + "', as that of an entry before it");
    }
    read(own.section("level"), turn, residual.level);
    read(own.section("change"), turn, residual.change);
    if (own.has("smoothed")) read(own.section("smoothed"), turn, residual.smoothed.emplace());
    if (own.has("onset")) read(own.section("onset"), residual.onset.emplace());
    settings.residuals.push_back(residual);
  }
  if (settings.rule != ChangeRule::likelihood_ratio) return;
  for (const FusedResidual& residual : settings.residuals) {
    if (residual.onset) continue;
    fused.problem("rule", "is likelihood_ratio, which needs an onset, and the residual of " +
                              residual.estimator + " has none; flinch calibrate thresholds finds it");
  }
}

}  // namespace flinch
