#pragma once

#include <filesystem>
#include <string>

namespace flinch {

/// What an HDF5 file says that it is, in the attribute `format` of its root: "flinch campaign"; "" where it
/// does not say, and where it is none.
std::string hdf5_format(const std::filesystem::path& file);

}  // namespace flinch
