#pragma once

#include <optional>
#include <vector>

#include "systems/estimators/disturbance_filter.h"
#include "systems/model/robot_model.h"
#include "systems/sensors/first_order_low_pass.h"
#include "systems/signals/drive_torque.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

/// Blocks of one control path that several of its stages ask for. Who asks first adds them; whoever asks for
/// the same gets the same.
struct SharedParts {
  struct Torque {
    std::optional<LowPassSettings> aligned_with;
    OutputPort<DriveTorque> port;
  };
  struct Filter {
    DisturbanceFilterSettings settings;
    DisturbanceFilter* filter;
  };

  std::vector<Torque> torques;
  std::vector<Filter> filters;
  MotionModel* model_low_latency = nullptr;
  std::optional<OutputPort<WrenchEstimate>> momentum_observer;
};

}  // namespace flinch
