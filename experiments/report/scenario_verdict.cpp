#include "experiments/report/scenario_verdict.h"

#include "experiments/scenario/scenario.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {

Verdict verdict_of(const Scenario& scenario, const Recording& recording) {
  Verdict verdict = judge(recording, scenario.robot.robot->space(), scenario.expected, scenario.force_limits);
  verdict.remarks.insert(verdict.remarks.end(), scenario.doubts.begin(), scenario.doubts.end());
  return verdict;
}

}  // namespace flinch
