#pragma once

#include <cstdint>
#include <filesystem>

namespace flinch::test {

enum class Pace : std::uint8_t { real_time, as_fast_as_possible };

/// Starts so many runs in processes of their own, recording into `folder`, kills each of them (SIGKILL) at a
/// moment drawn from `seed`, and expects that what each has left can be opened, is the beginning of the same
/// run left alone, bit for bit, and holds all that was recorded until 1 s before.
void kill_runs(int count, std::uint64_t seed, Pace pace, const std::filesystem::path& folder);

/// Starts processes that make short recordings over and over again, and kills each of them, so that most die
/// while a recording begins or ends. Expects that what lies there is whole, or the beginning of a run.
void kill_ends_of_runs(int count, std::uint64_t seed, const std::filesystem::path& folder);

}  // namespace flinch::test
