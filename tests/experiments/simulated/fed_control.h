#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "diagrams/contact_control.h"
#include "experiments/scenario/scenario.h"
#include "systems/framework/context.h"
#include "systems/framework/recorded_values.h"

namespace flinch::test {

/// What a station says at one tick.
struct Readings {
  JointReading joints;
  DriveReading drives;
  ImuReading imu;
  StationStatus status;
};

/// All that was recorded of a station, tick by tick.
inline std::vector<Readings> readings_of(const Recording& recording) {
  const auto joints = read<JointReading>(recording, "joints");
  const auto drives = read<DriveReading>(recording, "drives");
  const auto imu = read<ImuReading>(recording, "imu");
  const auto status = read<StationStatus>(recording, "status");
  std::vector<Readings> all;
  for (std::size_t k = 0; k < recording.samples(); ++k) {
    all.push_back({joints[k], drives[k], imu[k], status[k]});
  }
  return all;
}

/// The control path of a scenario that is fed by hand.
class FedControl {
 public:
  explicit FedControl(const Scenario& scenario)
      : control_(add_contact_control(builder_, scenario.robot.robot, scenario.control)),
        joints_(builder_.export_input("joints", control_.joints)),
        drives_(builder_.export_input("drives", control_.drives)),
        imu_(builder_.export_input("imu", control_.imu)),
        status_(builder_.export_input("status", control_.status)),
        buttons_(builder_.export_input("operator", control_.operator_command)),
        timing_(builder_.export_input("tick_timing", control_.tick_timing)),
        diagram_(builder_.build()),
        context_(diagram_->make_context()) {
    context_.set(buttons_, {});
    context_.set(timing_, {});
  }

  /// One tick; what it estimates then.
  const WrenchEstimate& see(const Readings& readings) {
    context_.set(joints_, readings.joints);
    context_.set(drives_, readings.drives);
    context_.set(imu_, readings.imu);
    context_.set(status_, readings.status);
    diagram_->evaluate(context_);
    diagram_->update(context_);
    context_.set_time(context_.time() + diagram_->tick());
    return context_.get(control_.wrench_estimate);
  }

 private:
  DiagramBuilder builder_{"fed", 1ms};
  ContactControl control_;
  InputPort<JointReading> joints_;
  InputPort<DriveReading> drives_;
  InputPort<ImuReading> imu_;
  InputPort<StationStatus> status_;
  InputPort<OperatorCommand> buttons_;
  InputPort<TickTiming> timing_;
  std::unique_ptr<Diagram> diagram_;
  Context context_;
};

}  // namespace flinch::test
