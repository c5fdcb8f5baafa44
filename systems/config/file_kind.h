#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "systems/config/config_reader.h"

namespace flinch {

/// What a YAML file of flinch is.
enum class FileKind { parameters, mapping, scenario, campaign, robot, data_spec, figures };

/// The kind of a file, told by keys that only files of that kind have; none: by its keys it may be any.
/// Throws SetupError where it cannot be read.
std::optional<FileKind> kind_of(const std::filesystem::path& file);

/// Throws SetupError where a file shows no key of the kind that is wanted, but one of another: it says in one
/// line what the file is, and who reads it. Call it before anything is read.
void require_kind(const ConfigReader& file, FileKind wanted);

/// The same where no YAML is wanted but what `wanted` says, "a recording". Files that do not end in .yaml or
/// .yml are let be.
void require_no_kind(const std::filesystem::path& file, const std::string& wanted);

}  // namespace flinch
