#pragma once

#include <filesystem>

namespace flinch {

/// The folder with the robots, scenarios and campaigns that come with flinch: share/flinch or apps/ in one
/// above the program, as it was installed or built. Empty: there is none.
std::filesystem::path shipped_folder();

/// `file` where it is there and no folder, or is more than a name; otherwise the shipped file of this name,
/// with or without ".yaml", in the folder `kind`, "scenarios". Where that is not there either, what is
/// missing is `file`, or for a name without an ending the file of that folder, so that the error tells the
/// name that is near.
std::filesystem::path or_shipped(const std::filesystem::path& file, const char* kind);

}  // namespace flinch
