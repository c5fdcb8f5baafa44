#pragma once

#include <cstdint>
#include <optional>

namespace flinch {

class ConfigReader;
class PlatformPath;
struct PlanarRrrParameters;
struct SimulatedStationSettings;

/// Reads what stands behind the control path: the sections `plant`, `pylon`, `applied_wrench` and `sensors`
/// of a scenario. The plant is `robot`, the one that the controller believes in, where the scenario says
/// nothing else, and stands at the start of `path`.
void read_station(ConfigReader& scenario, const PlanarRrrParameters& robot,
                  const std::optional<PlatformPath>& path, std::uint64_t seed,
                  SimulatedStationSettings& station);

}  // namespace flinch
