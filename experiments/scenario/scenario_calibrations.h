#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "diagrams/control_stages.h"
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

/// Throws SetupError with all that is wrong with the section `control` of the file, whatever robot it is for.
/// `known`: whose estimators it may name.
void check_thresholds(const ParameterFile& file, const ControlStages& known = known_stages());

}  // namespace flinch
