#pragma once

#include <string>
#include <vector>

namespace flinch {

struct EstimatorThresholds;
struct ThresholdGoal;

/// As a table for people; as one JSON object on one line, to which later versions add keys and rename none;
/// and as the section `control.contact_detector` of a scenario file, with what they come from above it.
std::string thresholds_table(const std::vector<EstimatorThresholds>& thresholds, const ThresholdGoal& goal);
std::string thresholds_json(const std::vector<EstimatorThresholds>& thresholds, const ThresholdGoal& goal);
std::string thresholds_yaml(const std::vector<EstimatorThresholds>& thresholds, const ThresholdGoal& goal,
                            const std::vector<std::string>& recordings);

}  // namespace flinch
