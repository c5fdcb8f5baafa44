#pragma once

#include <filesystem>
#include <vector>

namespace flinch {

/// Kinds of files that verbs write under a name that somebody gave.
enum class OutputKind {
  page,
  picture,
  graph,
  parameters,
  scenario,
  recording,
  data_set,
  classifier,
  robot,
  model,
  urdf,
  closures
};

/// As require_place(). Throws SetupError as well where the name does not end as those of this kind do, or
/// where it is that of a file of another kind, which would be lost. Links are replaced, devices have no kind.
void require_output(const std::filesystem::path& file, const std::vector<std::filesystem::path>& inputs,
                    OutputKind kind);

}  // namespace flinch
