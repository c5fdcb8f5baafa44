#pragma once

namespace flinch {

class ConfigReader;
struct Scenario;
struct SimulatedStationSettings;
struct PerturbedRobot;

/// Reads what stands behind the control path in simulation: the sections `plant`, `pylon`, `applied_wrench`,
/// `sensors` and `faults` of a scenario. The plant is the robot that the controller believes in, where the
/// scenario says nothing else, and stands at the start of the motion. Where it shall be one of many that
/// differ from their model, `perturbed_robot` is the one that was drawn.
void read_station(ConfigReader& file, const Scenario& scenario, SimulatedStationSettings& station,
                  PerturbedRobot& perturbed_robot);

}  // namespace flinch
