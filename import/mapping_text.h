#pragma once

#include <filesystem>
#include <string>

#include "import/mapping_guess.h"

namespace flinch {

/// A guess as a mapping file, with its reasons as comments.
std::string mapping_text(const MappingGuess& guess, const std::filesystem::path& robot);

}  // namespace flinch
