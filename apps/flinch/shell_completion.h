#pragma once

#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): it is theirs
class App;
}

namespace flinch {

/// The shells that completion_for() knows: "bash", "fish", "zsh".
std::vector<std::string> completed_shells();

/// A script that lets a shell complete verbs and options of `app`, and names of files elsewhere. `shell` is
/// one of completed_shells().
std::string completion_for(const std::string& shell, const CLI::App& app);

}  // namespace flinch
