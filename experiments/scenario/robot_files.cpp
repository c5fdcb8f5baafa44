#include "experiments/scenario/robot_files.h"

#include "systems/config/config_file.h"

namespace flinch {

std::shared_ptr<const RobotFiles::Entry> RobotFiles::read(const std::filesystem::path& file) {
  const std::lock_guard lock(mutex_);
  std::shared_ptr<const Entry>& entry = entries_[file];
  if (!entry) {
    std::string text = read_config_file(file);
    RobotFile robot = parse_robot_file(text, file.string());
    std::vector<ParameterFile> calibrations = robot_calibrations(text, file.string());
    entry = std::make_shared<Entry>(Entry{std::move(robot), std::move(text), std::move(calibrations)});
  }
  return entry;
}

}  // namespace flinch
