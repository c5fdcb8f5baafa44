#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "systems/framework/recording.h"

namespace flinch {

/// A recording out of a log of another tool: the CSV or HDF5 file that the mapping file (YAML) names, and
/// what its columns are. docs/files.md has the keys. Values are interpolated to the recording's period;
/// across gaps of more than three periods nothing is valid. Throws SetupError with all that is wrong with
/// either, by row and column.
Recording read_csv_recording(const std::filesystem::path& mapping,
                             const std::map<std::string, std::string>& provenance = {});

/// The files that it is made of: the mapping, the log and the scenario that it names. Throws likewise.
std::vector<std::filesystem::path> files_of_mapping(const std::filesystem::path& mapping);

}  // namespace flinch
