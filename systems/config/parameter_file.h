#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "systems/config/read_value.h"

namespace flinch {

class ConfigReader;
struct ConfigNode;

/// One number of a parameter file.
struct FileParameter {
  std::string name{};  ///< "offset[0]", or the path of a key: "drives.torque_constant_Nm_per_A[0]"
  double value = 0.0;
  std::optional<double> deviation{};  ///< standard deviation; none: not known
  std::string unit{};                 ///< SI, as people write it
  bool identifiable = true;           ///< otherwise it is only what was believed, and is not taken over
  std::string belongs_to{};           ///< "robot" or "scenario": whose key `name` is; empty: it is only told
};

/// A file that something comes from, and what was in it.
struct HashedFile {
  std::string file;
  std::string sha256;  ///< of its bytes, as sha256sum prints it
};

/// What a calibration has found, as `flinch run` reads it.
struct ParameterFile {
  static constexpr int version = 1;

  std::string file;  ///< from where it was read
  std::string text;  ///< all of it
  std::string kind;  ///< "torque-constant"
  std::string date;  ///< "2026-11-22"
  HashedFile robot;  ///< that the recordings were made with; no hash: they are of several
  std::vector<HashedFile> recordings;
  double residual_before = 0.0;  ///< root mean square
  double residual_after = 0.0;
  std::string residual_unit;  ///< empty: nothing was fitted
  std::vector<FileParameter> parameters;
  std::vector<FileParameter> assumed;  ///< other parameters that these rest on: torque constants
  std::vector<ReadValue> settings;     ///< of the control path in the recordings, on which these rest, too
  /// `text` as it was parsed, of which calibrate_control() reads the section `control`; null: made in code.
  std::shared_ptr<const ConfigNode> nodes;
};

/// Reads one. Throws SetupError with all that is wrong.
ParameterFile read_parameter_file(const std::filesystem::path& file);
/// The same for text that came from `file`.
ParameterFile parse_parameter_file(std::string_view text, const std::string& file);

/// The files that `calibrations` of a scenario or robot file names, as `read` gives them. What is wrong with
/// them is noted.
std::vector<ParameterFile> read_calibrations(
    ConfigReader& file,
    const std::function<ParameterFile(const std::filesystem::path&)>& read = &read_parameter_file);
/// Those of the robot file `robot_text`, which lies at `file`. Throws SetupError with all that is wrong.
std::vector<ParameterFile> robot_calibrations(std::string_view robot_text, const std::string& file);

/// The hash by which a parameter file knows its robot: of the robot file without `calibrations`, lines of
/// comment and the control period, on which a result says itself whether it rests. So a robot file that takes
/// results over is still the same.
std::string calibrated_robot_hash(std::string_view robot_text);

/// As text of YAML that reads back to the same numbers, bit for bit; all but `control`.
std::string parameter_file_text(const ParameterFile& parameters);

/// The robot file `robot_text`, which came from `file`, with all that belongs to it and was identifiable.
/// Throws SetupError where a key fits nothing there.
std::string with_parameters(std::string_view robot_text, const std::string& file,
                            const ParameterFile& parameters);

}  // namespace flinch
