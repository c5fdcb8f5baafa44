#include "experiments/simulated/exported_truth.h"

#include <algorithm>

#include "experiments/simulated/simulated_scenario.h"
#include "experiments/simulated/true_measures.h"
#include "plant/simulated_station.h"
#include "systems/framework/diagram_builder.h"

namespace flinch {

void export_truth(DiagramBuilder& builder, const SimulatedScenario& scenario,
                  const SimulatedStation& station) {
  builder.export_output("truth", station.plant_truth);
  builder.export_output("contact", station.contact_truth);
  auto& measures = builder.add<TrueMeasures>("true_measures", scenario.station.rig.robot);
  builder.connect(station.platform_truth, measures.platform);
  builder.export_output("true_measures", measures.measures);
  const Obstacles& obstacles = scenario.station.rig.obstacles;
  if (std::any_of(obstacles.begin(), obstacles.end(), [](const auto& each) { return each->moves(); }))
    builder.export_output("obstacles", station.obstacle_truth);
}

}  // namespace flinch
