#pragma once

#include "systems/framework/time.h"
#include "systems/laws/scripted_operator.h"

namespace flinch {

class ConfigReader;
class ParallelRobot;
struct ContactControlSettings;

/// Reads what an operator does in a run that lasts `duration`: the list `operator` of a scenario.
OperatorScript read_operator(ConfigReader& scenario, const ParallelRobot& robot,
                             const ContactControlSettings& control, Time duration);

}  // namespace flinch
