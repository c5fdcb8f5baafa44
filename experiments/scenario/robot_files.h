#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "systems/config/parameter_file.h"
#include "systems/config/robot_file.h"

namespace flinch {

/// Robot files of many scenarios, and the parameter files that these name: each is read once, when it is
/// first asked for, and then stays as it was. Threads may share it.
class RobotFiles {
 public:
  struct Entry {
    RobotFile robot;
    std::string text;                         ///< of the file
    std::vector<ParameterFile> calibrations;  ///< that it names
  };

  /// Throws SetupError with all that is wrong with the file.
  std::shared_ptr<const Entry> read(const std::filesystem::path& file);
  /// The same of a parameter file.
  std::shared_ptr<const ParameterFile> read_calibration(const std::filesystem::path& file);

  /// Texts: of each robot file with the parameter files that it names, then of those that were asked for;
  /// both in order of their names.
  std::vector<std::string> texts() const;

 private:
  mutable std::mutex mutex_;
  std::map<std::filesystem::path, std::shared_ptr<const Entry>> entries_;
  std::map<std::filesystem::path, std::shared_ptr<const ParameterFile>> calibrations_;
};

}  // namespace flinch
