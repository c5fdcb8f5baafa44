#pragma once

#include <cstdint>
#include <filesystem>

namespace flinch {

class ConfigReader;
struct PlanarRrrParameters;
struct SimulatedStationSettings;

/// Reads what stands behind the control path: the sections `plant`, `pylon`, `applied_wrench` and `sensors` of a
/// scenario. The plant is `robot`, the one that the controller believes in, where the scenario says nothing else.
void read_station(ConfigReader& scenario, const PlanarRrrParameters& robot, std::uint64_t seed,
                  SimulatedStationSettings& station);

}  // namespace flinch
