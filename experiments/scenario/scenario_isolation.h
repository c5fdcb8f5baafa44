#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

namespace flinch {

class ConfigReader;
enum class DriveKind;
struct IsolationSettings;

/// The drives of a robot, as far as they are known.
struct KnownDrives {
  DriveKind kind;
  std::optional<std::size_t> count;  ///< empty: not known
};

/// Reads the section `isolation` of `control`: how contacts are classified and located.
void read_isolation(ConfigReader isolation, const KnownDrives& drives, IsolationSettings& settings);

/// Reads of that section what is calibrated: how far the wrench is off where nothing touches the robot.
void read_wrench_errors(ConfigReader& isolation, const KnownDrives& drives, IsolationSettings& settings);

/// Takes files of networks that have no place from `folder` on, that of the scenario.
void find_networks(const std::filesystem::path& folder, IsolationSettings& settings);

}  // namespace flinch
