#include "experiments/report/scenario_verdict.h"

#include "experiments/scenario/scenario.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {

Verdict verdict_of(const Scenario& scenario, const Recording& recording,
                   const std::function<void(double share)>& progress) {
  Verdict verdict =
      judge(recording, scenario.robot.robot->space(), scenario.expected, scenario.force_limits, progress);
  for (const CalibrationDoubt& doubt : scenario.doubts) verdict.remarks.push_back(doubt.sentence);
  return verdict;
}

}  // namespace flinch
