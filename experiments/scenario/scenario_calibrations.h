#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "systems/config/parameter_file.h"
#include "systems/config/robot_file.h"

namespace flinch {

class ConfigReader;
struct ContactControlSettings;
class ParallelRobot;
struct Recording;
struct Scenario;

/// The files that `calibrations` of robot file and scenario name, as a recording keeps them, by its
/// attributes calibration.1.file and .text, ...; the key of the scenario is taken.
std::vector<ParameterFile> recorded_calibrations(ConfigReader& scenario, const Recording& recording,
                                                 const std::filesystem::path& file);

/// The robot with what is calibrated in the place of what the robot file says. Throws SetupError where that
/// does not fit it.
RobotFile calibrated_robot(const Scenario& scenario);

/// The same for what `control` of the scenario does not say itself: the mount of the IMU, thresholds of the
/// estimators among its stages, which are all that a file may name.
/// Throws SetupError with all that is wrong with the sections `control` of the files.
void calibrate_control(const std::vector<ParameterFile>& calibrations, const ParallelRobot& robot,
                       ContactControlSettings& control);

/// Throws SetupError with all that is wrong with the sections `control` of the files for this robot.
void check_thresholds(const std::vector<ParameterFile>& files, const RobotFile& robot);
/// The same of one file, whatever robot it is for.
void check_thresholds(const ParameterFile& file);

}  // namespace flinch
