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

std::shared_ptr<const ParameterFile> RobotFiles::read_calibration(const std::filesystem::path& file) {
  const std::lock_guard lock(mutex_);
  std::shared_ptr<const ParameterFile>& entry = calibrations_[file];
  if (!entry) entry = std::make_shared<ParameterFile>(read_parameter_file(file));
  return entry;
}

std::vector<std::string> RobotFiles::texts() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> texts;
  for (const auto& [file, entry] : entries_) {
    if (!entry) continue;  // it was no good
    texts.push_back(entry->text);
    for (const ParameterFile& calibration : entry->calibrations) texts.push_back(calibration.text);
  }
  for (const auto& [file, entry] : calibrations_) {
    if (entry) texts.push_back(entry->text);
  }
  return texts;
}

}  // namespace flinch
