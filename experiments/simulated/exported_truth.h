#pragma once

namespace flinch {

class DiagramBuilder;
struct SimulatedScenario;
struct SimulatedStation;

/// What every simulation records of its robot, by the names that verdict and report ask for: "truth",
/// "contact", "true_measures", and "obstacles" where they move.
void export_truth(DiagramBuilder& builder, const SimulatedScenario& scenario,
                  const SimulatedStation& station);

}  // namespace flinch
