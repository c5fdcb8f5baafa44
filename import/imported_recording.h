#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "import/mapped_log.h"
#include "systems/framework/recording.h"

namespace flinch {

/// The readings of a log as a recording: signals joints, drives, imu, force_torque as far as they are mapped.
/// Its rows are made when they are read; only the log is in memory. A reading is not valid where the log has
/// none of one of its entries. Throws SetupError where a signal lacks an entry.
Recording imported_recording(const std::shared_ptr<const MappedLog>& log,
                             const std::map<std::string, std::string>& provenance = {});

/// The same by a mapping file.
Recording import_log(const std::filesystem::path& mapping,
                     const std::map<std::string, std::string>& provenance = {});

/// The files that it is made of: the mapping, the log and the scenario or robot that it names.
std::vector<std::filesystem::path> files_of(const LogMapping& mapping);

}  // namespace flinch
