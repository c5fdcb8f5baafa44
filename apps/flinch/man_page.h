#pragma once

#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming): it is theirs
class App;
}

namespace flinch {

/// The manual page of a program, section 1, as troff: what `app` says of itself, its verbs and options.
std::string man_page(const CLI::App& app, const std::string& version);

}  // namespace flinch
