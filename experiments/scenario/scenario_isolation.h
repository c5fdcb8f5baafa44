#pragma once

#include <filesystem>

namespace flinch {

class ConfigReader;
struct IsolationSettings;

/// Reads the section `isolation` of `control`: how contacts are classified and located.
void read_isolation(ConfigReader isolation, IsolationSettings& settings);

/// Takes files of networks that have no place from `folder` on, that of the scenario.
void find_networks(const std::filesystem::path& folder, IsolationSettings& settings);

}  // namespace flinch
