#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "import/mapped_log.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/instrument_mounting.h"

namespace flinch {

/// The axes of the body on which the instrument of a log sits, from the joints.
class InstrumentAxes {
 public:
  /// The forward kinematics of a sample begins with the pose of the one before, so those of the first samples
  /// of blocks are kept.
  explicit InstrumentAxes(const MappedLog& log);

  /// Axes at each of these samples, as columns in the base frame.
  std::vector<Eigen::Matrix3d> read(const MappedLog& log, std::size_t first, std::size_t count) const;

 private:
  Eigen::Matrix3d axes_at(const JointVector& active, Time time, Configuration& pose) const;

  std::shared_ptr<const ParallelRobot> robot_;
  std::vector<InstrumentMounting> mountings_;
  Time period_;
  std::vector<Configuration> begin_;
};

}  // namespace flinch
