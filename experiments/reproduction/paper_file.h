#pragma once

#include <filesystem>

#include "experiments/reproduction/paper_figures.h"

namespace flinch {

/// Reads a file of figures and pictures (docs/files.md). Throws SetupError with all that is wrong with it.
PaperFigures read_paper_file(const std::filesystem::path& file);

}  // namespace flinch
