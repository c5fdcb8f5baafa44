#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "systems/robot/parallel_robot.h"
#include "systems/robot/vectors.h"
#include "systems/signals/contact_classes.h"
#include "systems/signals/contact_window.h"

namespace flinch {

/// Ticks of a contact that its classification is judged by. One tick may be several of them.
struct Moment {
  static constexpr int early = 1;     ///< a detector on the estimator `early_by` detects the contact
  static constexpr int detected = 2;  ///< the detector that the robot follows detects it
  static constexpr int later = 4;     ///< 10 ms after that
};

/// What was known of a contact at one tick, and what was true.
struct DataSample {
  int run = 0;               ///< samples of one run belong together
  int configuration = 0;     ///< likewise samples of one configuration of the robot
  int moment = 0;            ///< sum of Moment's
  int touched = 0;           ///< the truth: number in the robot's ContactClasses
  double since_onset = 0.0;  ///< of the contact [s]
  double since_early = 0.0;  ///< since Moment::early [s]
  double force = 0.0;        ///< the truth, of the strongest touch [N]
  Configuration pose;        ///< as the encoders tell it
  ContactMoments course;     ///< what was estimated, and how the platform moved

  const PlatformVector& wrench_in_base() const { return course.front().wrench_in_base; }
  const PlatformVector& velocity() const { return course.front().velocity; }
};

/// Contacts of a robot with their labels.
struct DataSet {
  std::string robot_file;  ///< its name, for people
  std::string robot_text;
  std::shared_ptr<const ParallelRobot> robot;
  /// What made it: title, specification, seed, version, counts.
  std::map<std::string, std::string> card;
  std::string sha256;  ///< of the file that it was read from; "": of none
  std::vector<DataSample> samples;
};

ContactClasses classes_of(const ParallelRobot& robot);

/// A short text that two robot files share if they describe the same robot, whatever their comments, the
/// limits at which it is stopped, and its control period.
std::string fingerprint(const std::string& robot_text, const std::string& robot_file);

/// Samples and runs for each class and configuration, as a table for people; of more than ten configurations
/// all together.
std::string counts_table(const DataSet& data);

/// Writes the data set as HDF5: one table "samples" and the card as attributes. Equal data make equal files.
/// Throws SetupError when that fails.
void write_data_set(const DataSet& data, const std::filesystem::path& file);

/// Throws SetupError naming the file and what is missing or broken.
DataSet read_data_set(const std::filesystem::path& file);

}  // namespace flinch
