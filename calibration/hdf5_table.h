#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibration/csv_table.h"

namespace flinch {

/// Reads columns of numbers of an HDF5 file that another tool has written. `wanted`: the path of a data set
/// of one dimension, "/log/time", or a column of one of two, "/log/current[2]", counted from 0. All have as
/// many rows. Throws SetupError naming file, row, counted from 1, and column of what is missing or no finite
/// number; the first few of each.
CsvTable read_hdf5_table(const std::filesystem::path& file, const std::vector<std::string>& wanted);

}  // namespace flinch
