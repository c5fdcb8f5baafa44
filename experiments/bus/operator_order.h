#pragma once

#include <string>
#include <string_view>

#include "systems/signals/operator_command.h"
#include "systems/signals/target_command.h"

namespace flinch {

struct Scenario;

/// What an operator wants of a running robot, once.
struct OperatorOrder {
  OperatorCommand buttons;  ///< that are down for one tick
  TargetCommand target;     ///< of no kind: none; its number does not count
  bool end = false;         ///< of the run
};

/// The order that a line of text gives:
///
///   stop, reset, start, end
///   go x_mm: 100, phi_deg: 5    a pose, by the keys that a scenario uses; alone: home
///   step x_mm: 5                a displacement in the base frame, likewise
///
/// Throws SetupError where it is none of these, for a pose out of the reach of the legs, and for a start
/// where the scenario has no motion.
OperatorOrder read_order(std::string_view line, const Scenario& scenario);

/// What can be ordered, a line for each.
std::string_view known_orders();

}  // namespace flinch
