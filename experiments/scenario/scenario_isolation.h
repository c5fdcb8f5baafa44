#pragma once

namespace flinch {

class ConfigReader;
struct IsolationSettings;

/// Reads the section `isolation` of `control`: how contacts are classified and located.
void read_isolation(ConfigReader isolation, IsolationSettings& settings);

}  // namespace flinch
