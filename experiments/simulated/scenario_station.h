#pragma once

namespace flinch {

class ConfigReader;
struct Scenario;
struct SimulatedStationSettings;
struct Specimen;

/// Reads what stands behind the control path in simulation: the sections `plant`, `pylon`, `applied_wrench`,
/// `sensors` and `faults` of a scenario. The plant is the robot that the controller believes in, where the
/// scenario says nothing else, and stands at the start of the motion. Where it shall be one of many that
/// differ from their model, `specimen` is the one that was drawn.
void read_station(ConfigReader& file, const Scenario& scenario, SimulatedStationSettings& station,
                  Specimen& specimen);

}  // namespace flinch
