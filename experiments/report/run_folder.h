#pragma once

#include <filesystem>
#include <functional>

#include "experiments/verdict/verdict.h"
#include "systems/foundation/folder_lock.h"

namespace flinch {

struct Recording;
struct Scenario;

/// A folder for what a run leaves. Nobody else writes into it while this lives.
struct RunFolder {
  std::filesystem::path path;
  FolderLock lock;

  operator const std::filesystem::path&() const { return path; }  // NOLINT(google-explicit-constructor)
};

/// Where a run called `name` leaves its results unless told otherwise: out/name. Throws SetupError for a name
/// that leads out of there.
std::filesystem::path default_folder(const std::string& name);

/// Makes the folder, if it is not there. Throws SetupError where that fails, or another run has it.
[[nodiscard]] RunFolder make_run_folder(const std::filesystem::path& folder);

/// Where a run leaves its recording.
std::filesystem::path recording_in(const std::filesystem::path& folder);

/// Judges `recording`, which is in `folder`, and leaves report.html beside it. Throws SetupError where a file
/// cannot be read or written.
Verdict report_run(const Scenario& scenario, const Recording& recording, const std::filesystem::path& folder,
                   const std::function<void(double share)>& progress = {});

/// The same for a recording that is not there yet.
Verdict conclude_run(const Scenario& scenario, const Recording& recording,
                     const std::filesystem::path& folder);

}  // namespace flinch
