#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>

#include "diagrams/contact_control.h"
#include "plant/simulated_station.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/simulator.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

/// The simulated rig and its pipeline, with encoders that can be broken.
namespace flinch::test {

/// What is wrong with the encoders from now on.
struct EncoderDamage {
  std::array<bool, 3> active_frozen{};
  bool passive_frozen = false;                   ///< all three
  Eigen::Vector3d active_offset{0.0, 0.0, 0.0};  ///< [rad]
};

/// Readings with all stamps as they are, and angles as the damage leaves them.
class BreakableEncoders final : public System {
  State<JointReading> last_ = state<JointReading>("last");

 public:
  InputPort<JointReading> in = input<JointReading>("in");
  InputPort<EncoderDamage> damage = input<EncoderDamage>("damage");
  OutputPort<JointReading> out = output<&BreakableEncoders::spoil>("out", in, damage, last_);

 private:
  Update keep_ = keep(last_, out);

  void spoil(const JointReading& reading, const EncoderDamage& wrong, const JointReading& last,
             JointReading& result) const {
    result = reading;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto drive = static_cast<Eigen::Index>(i);
      if (wrong.active_frozen[i]) result.active[drive] = last.active[drive];
    }
    if (wrong.passive_frozen) result.passive = last.passive;
    result.active += wrong.active_offset;
  }
};

struct GuardedBenchSettings {
  SimulatedStationSettings station;
  ContactControlSettings control;
};

/// Through the middle along x at `speed` [m/s].
inline GuardedBenchSettings passing_at(double speed) {
  GuardedBenchSettings settings;
  const PlanarRrr robot(rig_robot(RigGeometry::individual, RigFriction::test_rig));
  settings.station.rig.robot = std::make_shared<const PlanarRrr>(robot);
  settings.station.drives.torque_constant = Eigen::Vector3d(6.021, 6.6116, 6.7315);
  settings.control.drive_torque.torque_constant = settings.station.drives.torque_constant;
  const Passage passing = passage(robot, {.pose = Eigen::Vector3d::Zero(),
                                          .direction = Eigen::Vector2d(1.0, 0.0),
                                          .speed = speed,
                                          .cruise = 0.05});
  settings.station.rig.initial_pose = passing.path.start();
  settings.control.trajectory.path = passing.path;
  settings.control.trajectory.start = 300ms;
  return settings;
}

/// The tick at which passing_at(speed) passes the middle.
inline Time middle_of_passage(double speed) {
  const PlanarRrr robot(rig_robot(RigGeometry::individual, RigFriction::test_rig));
  const double time = passage(robot, {.pose = Eigen::Vector3d::Zero(),
                                      .direction = Eigen::Vector2d(1.0, 0.0),
                                      .speed = speed,
                                      .cruise = 0.05})
                          .time;
  return 300ms + from_seconds(time) / 1ms * 1ms;
}

class GuardedRig {
 public:
  explicit GuardedRig(const GuardedBenchSettings& settings)
      : robot_(std::dynamic_pointer_cast<const PlanarRrr>(settings.station.rig.robot)),
        station_(add_simulated_station(builder_, settings.station)),
        control_(add_contact_control(builder_, robot_, settings.control)),
        encoders_(builder_.add<BreakableEncoders>("breakable_encoders")),
        damage_(builder_.export_input("damage", encoders_.damage)),
        timing_(builder_.export_input("tick_timing", control_.tick_timing)),
        operator_(builder_.export_input("operator", control_.operator_command)),
        diagram_(build()),
        context_(diagram_->make_context()),
        simulator_(*diagram_, std::make_unique<SundialsIntegrator>()) {}

  void damage(const EncoderDamage& wrong) { context_.set(damage_, wrong); }
  void tick() { simulator_.step(context_); }
  void run_until(Time end) {
    while (context_.time() < end) tick();
  }
  /// The time from now until a tick finds one of `wanted`; none within `limit`.
  std::optional<Time> time_until(FaultMask wanted, Time limit) {
    for (const Time start = context_.time(); context_.time() < start + limit;) {
      tick();
      if ((faults() & wanted) != 0) return context_.time() - start - 1ms;
    }
    return std::nullopt;
  }

  FaultMask faults() const { return context_.get(control_.faults).present; }
  const GateStatus& gate() const { return context_.get(control_.gate); }
  const TorqueCommand& torque() const { return context_.get(control_.torque_command); }
  Eigen::Vector3d pose() const { return context_.get(station_.plant_truth).pose; }
  Eigen::Vector3d velocity() const { return context_.get(station_.plant_truth).velocity; }
  Time now() const { return context_.time(); }

  const Diagram& diagram() const { return *diagram_; }
  Context& context() { return context_; }
  InputPort<TickTiming> timing() const { return timing_; }

 private:
  std::unique_ptr<Diagram> build() {
    builder_.connect(station_.joints, encoders_.in);
    builder_.connect(encoders_.out, control_.joints);
    builder_.connect(station_.drives, control_.drives);
    builder_.connect(station_.status, control_.status);
    builder_.connect(control_.torque_command, station_.torque_command);
    builder_.connect(control_.brake, station_.brake);
    return builder_.build();
  }

  DiagramBuilder builder_{"guarded_bench", 1ms};
  std::shared_ptr<const PlanarRrr> robot_;
  SimulatedStation station_;
  ContactControl control_;
  BreakableEncoders& encoders_;
  InputPort<EncoderDamage> damage_;
  InputPort<TickTiming> timing_;
  InputPort<OperatorCommand> operator_;
  std::unique_ptr<Diagram> diagram_;
  Context context_;
  Simulator simulator_;
};

}  // namespace flinch::test
