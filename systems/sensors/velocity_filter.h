#pragma once

#include <memory>

#include "systems/framework/system.h"
#include "systems/robot/parallel_robot.h"
#include "systems/sensors/first_order_low_pass.h"
#include "systems/signals/joint_motion.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/sampling.h"

namespace flinch {

struct VelocityFilterSettings {
  LowPassSettings low_pass;
  Sampling sampling;
};

/// What the velocity filter remembers: its last sample.
struct VelocityFilterMemory {
  bool has_sample = false;
  Time acquired{};
  Time arrived{};  ///< tick at which it was read
  JointVector position;
  LowPassMemory velocity;
};

/// Rates of the drives from their encoders: difference over the time between acquisitions, angles wrapped,
/// then low-passed. [ICRA23] III-A
///
/// A velocity needs two samples: before the second, and again after an interruption, the motion is not valid;
/// the second then starts the filter with the plain difference. A reading that is not valid, not finite, of
/// the wrong size or not newer than the last is skipped: the motion stays as it was, with its acquisition
/// time, for the longest hold and is not valid thereafter.
class VelocityFilter final : public System {
  State<VelocityFilterMemory> memory_ = state<VelocityFilterMemory>("memory");

 public:
  explicit VelocityFilter(std::shared_ptr<const ParallelRobot> robot,
                          const VelocityFilterSettings& settings = {});

  InputPort<JointReading> joints = input<JointReading>("joints");

 private:
  Intermediate<VelocityFilterMemory> next_ =
      intermediate<&VelocityFilter::advance>("next", joints, memory_, clock);

 public:
  OutputPort<JointMotion> motion = output<&VelocityFilter::read>("motion", next_);

 private:
  void advance(const JointReading& reading, const VelocityFilterMemory& memory, Time now,
               VelocityFilterMemory& next) const;
  void read(const VelocityFilterMemory& next, JointMotion& result) const;
  bool is_new(const JointReading& reading, const VelocityFilterMemory& memory) const;

  std::shared_ptr<const ParallelRobot> robot_;
  Sampling sampling_;
  FirstOrderLowPass low_pass_;
};

}  // namespace flinch
