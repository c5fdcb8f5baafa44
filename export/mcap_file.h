#pragma once

#include <filesystem>
#include <vector>

#include "export/exported_signal.h"

namespace flinch {

/// Writes signals as an MCAP file, as PlotJuggler and Foxglove read it: a channel /SIGNAL for each, with a
/// message of JSON for each sample, at the time since the start. Named numbers of a field are an object, as
/// in {"fx": 1.5}, numbered ones a list; what a sample does not have, or is not finite, is null. Units and
/// frames stand in the schemas. Nothing is compressed: a minute of a whole run has some 0.5 GB. Throws
/// SetupError where the file cannot be written.
void write_mcap(const Recording& recording, const std::vector<ExportedSignal>& signals,
                const std::filesystem::path& file);

}  // namespace flinch
