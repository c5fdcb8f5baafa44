#include "experiments/report/scenario_verdict.h"

#include "experiments/scenario/scenario.h"
#include "systems/framework/recording.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {

Verdict verdict_of(const Scenario& scenario, const Recording& recording,
                   const std::function<void(double share)>& progress) {
  Verdict verdict =
      judge(recording, scenario.robot.robot->space(), scenario.expected, scenario.force_limits, progress);
  const bool is_missing = verdict.contacts.empty() && !verdict.good() &&
                          scenario.expected.contact.value_or("none") != "none" && scenario.near_miss;
  if (is_missing) {
    const std::string sentence = scenario.near_miss(scenario, recording);
    if (!sentence.empty()) verdict.failures.push_back(sentence);
  }
  for (const CalibrationWarning& warning : scenario.warnings) verdict.remarks.push_back(warning.sentence);
  return verdict;
}

}  // namespace flinch
