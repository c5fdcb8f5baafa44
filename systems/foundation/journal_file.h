#pragma once

#include <filesystem>
#include <fstream>
#include <functional>

namespace flinch {

/// Begins the journal `file` anew: what `write` puts into `stream` takes that name once it is whole, and the
/// stream goes on in it. Until then an older journal keeps the name. Throws SetupError where that fails, and
/// leaves nothing of the new one.
void begin_journal(const std::filesystem::path& file, std::ofstream& stream,
                   const std::function<void()>& write);

}  // namespace flinch
