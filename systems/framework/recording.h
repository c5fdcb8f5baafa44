#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "systems/framework/fields.h"
#include "systems/framework/time.h"

namespace flinch {

/// One recorded port: rows of numbers as write_row() lays them out, one a sample.
struct Signal {
  std::string path;  ///< of the port in its diagram: "station/encoders/joints"
  RowLayout layout;
  std::vector<internal::Number> rows;  ///< samples x layout.numbers
};

/// What a Recorder has seen: signals with a common time axis, and what made them.
///
/// As a file it is HDF5: a group for each port path, in it a dataset for each field (samples x numbers) with
/// the attributes unit, frame and period_ns; fields that change size have a second dataset NAME.size (rows,
/// columns). The dataset /time_ns holds the time of each sample; the attributes of the root are `attributes`.
/// Equal recordings make equal files, byte for byte: nothing in it depends on when or where it was written.
struct Recording {
  Time period{};
  std::vector<std::int64_t> time_ns;
  std::map<std::string, std::string> attributes;  ///< what made it: version, seed, robot file, scenario, ...
  std::vector<Signal> signals;

  std::size_t samples() const { return time_ns.size(); }

  /// The signal of the port `path`. Throws SetupError naming the nearest path.
  const Signal& signal(const std::string& path) const;

  /// Column `element` of `field` ("joints.active") of the port `path`, as real numbers; NaN where it was
  /// shorter.
  std::vector<double> column(const std::string& path, const std::string& field, int element = 0) const;
};

/// Writes `recording` to `file`, first under another name, so that an older file is replaced only by a whole
/// new one. Throws SetupError when that fails.
void write_recording(const Recording& recording, const std::filesystem::path& file);

/// Reads a recording. Throws SetupError naming the file and what is missing or broken.
Recording read_recording(const std::filesystem::path& file);

}  // namespace flinch
