#pragma once

namespace flinch {

class ConfigReader;
struct Scenario;
struct SimulatedStationSettings;

/// Reads what stands behind the control path in simulation: the sections `plant`, `pylon`, `applied_wrench`
/// and `sensors` of a scenario. The plant is the robot that the controller believes in, where the scenario
/// says nothing else, and stands at the start of the motion.
void read_station(ConfigReader& file, const Scenario& scenario, SimulatedStationSettings& station);

}  // namespace flinch
