#pragma once

#include <string>
#include <vector>

namespace flinch {

class ConfigReader;
enum class DriveKind;
struct FusedDetectorSettings;

/// Reads what the fused detector judges by from its section. `estimators`: all that a file may name.
void read_fused_detector(ConfigReader fused, DriveKind drives, const std::vector<std::string>& estimators,
                         FusedDetectorSettings& settings);

}  // namespace flinch
