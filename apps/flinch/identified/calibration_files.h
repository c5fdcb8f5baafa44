#pragma once

#include <filesystem>
#include <vector>

#include "apps/flinch/command_line.h"
#include "calibration/calibration_result.h"
#include "experiments/scenario/scenario.h"
#include "systems/framework/recording.h"

namespace flinch {

/// Throws SetupError with the doubts of a calibration, unless they are accepted: then they are warnings.
void require_belief(CalibrationResult& result, bool accept);

/// A recording with the scenario that it was made from.
struct OpenedRecording {
  CalibrationSource source;
  Recording recording;
  Scenario scenario;
};

/// Opens all of them. Throws SetupError with all that is wrong with any, and where they are of different
/// robots or one comes twice.
std::vector<OpenedRecording> open_recordings(const std::vector<std::filesystem::path>& files,
                                             const CommonOptions& common);

/// What a calibration finds its parameters in, and what it is tried on.
struct CalibrationRecordings {
  std::vector<OpenedRecording> used, unseen;
};

/// The same of all that the call names; says on stderr how much that is, for what follows takes some seconds.
CalibrationRecordings open_recordings(const CalibrateOptions& options);

/// Throws SetupError where the parameter file and the page beside it cannot be written, or would replace what
/// the call reads.
void require_places(const CalibrateOptions& options);

/// The torque constants with which the scenario ran, or those of parameter files that hold already.
JointVector calibrated_constants(const Scenario& scenario, const std::vector<std::filesystem::path>& files);

/// Writes the parameter file of `result`, called after its kind, into `folder`, and reads it again.
/// `scenario`: of the first recording.
ParameterFile write_calibration(CalibrationResult& result, const Scenario& scenario,
                                const std::filesystem::path& folder);

/// Prints the result and writes the files that were asked for. `scenario`: of the first recording.
ExitStatus conclude_calibration(CalibrationResult& result, const Scenario& scenario,
                                const CalibrateOptions& options);

}  // namespace flinch
