#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "diagrams/arrival.h"
#include "diagrams/link_status.h"
#include "systems/framework/system.h"
#include "systems/signals/drive_reading.h"
#include "systems/signals/force_torque_reading.h"
#include "systems/signals/imu_reading.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/station_status.h"

namespace flinch {

/// How many joints of each kind a robot has encoders for.
struct JointCount {
  int drives = 0;
  int passive = 0;
};

/// Whether the values of a reading that says to be valid can be: finite, and one for each joint.
inline bool is_sound(const JointReading& joints, JointCount robot) {
  return joints.active.size() == robot.drives && joints.active.allFinite();
}
inline bool is_sound(const DriveReading& drives, JointCount robot) {
  return drives.current.size() == robot.drives && drives.current.allFinite();
}
inline bool is_sound(const ImuReading& imu, JointCount) {
  return imu.angular_velocity.allFinite() && imu.specific_force.allFinite();
}
inline bool is_sound(const ForceTorqueReading& sensor, JointCount) {
  return sensor.force_in_base.allFinite() && sensor.moment_in_base.allFinite();
}
inline bool is_sound(const StationStatus&, JointCount) { return true; }

/// The passive angles may be broken alone.
inline void distrust_broken_parts(JointReading& joints, JointCount robot) {
  const bool sound = joints.passive.size() == robot.passive && joints.passive.allFinite();
  joints.passive_valid = joints.passive_valid && sound;
}
template <class Reading>
void distrust_broken_parts(Reading&, JointCount) {}

struct GuardSettings {
  JointCount robot;
  Time max_age{};         ///< of a reading, by its acquisition
  bool lockstep = false;  ///< see ExternalStationSettings
};

/// Lets a reading in from outside. It is valid where it says so itself, is sound and not older than `max_age`
/// by its acquisition; a tick without a new one sees the last one again, as long as it is young enough.
/// Of a broken one nothing is shown but that the reading is no longer valid, and of an older one than the
/// last not even that. In lockstep no reading is late or out of order, and only a broken one is kept out.
template <class Reading>
class ReadingGuard final : public System {
 public:
  struct Memory {
    Arrival<Reading> last;
    LinkStatus link;
  };

 private:
  State<Memory> memory_ = state<Memory>("memory");

 public:
  explicit ReadingGuard(const GuardSettings& settings)
      : robot_(settings.robot), max_age_(settings.max_age), lockstep_(settings.lockstep) {}

  InputPort<Arrival<Reading>> arrival = System::input<Arrival<Reading>>("arrival");

 private:
  Intermediate<Memory> next_ =
      System::intermediate<&ReadingGuard::advance>("next", arrival, memory_, System::clock);

 public:
  OutputPort<Reading> reading = System::output<&ReadingGuard::read>("reading", next_);
  OutputPort<LinkStatus> link = System::output<&ReadingGuard::report>("link", next_);

 private:
  Update remember_ = System::keep(memory_, next_);

  void advance(const Arrival<Reading>& came, const Memory& memory, Time now, Memory& next) const {
    next = memory;
    next.link.flow = judge(came, memory, now);
    if (next.link.flow == Flow::fresh) {
      next.last.reading = came.reading;
      distrust_broken_parts(next.last.reading, robot_);
    }
    if (is_refusal(next.link.flow)) ++next.link.refused;
    if (next.link.flow == Flow::broken) next.last.reading.valid = false;
    if (next.link.flow == Flow::restarted) next.last.reading = Reading();
    if (next.link.flow != Flow::out_of_order) count(came, memory, next);
    if (next.last.source != 0) next.link.age = now - next.last.reading.acquired;
    if (!lockstep_) expire(next);
  }

  void count(const Arrival<Reading>& came, const Memory& memory, Memory& next) const {
    const std::uint32_t step = came.number - memory.last.number;
    const bool same_source = !lockstep_ && came.source != 0 && came.source == memory.last.source;
    if (same_source && step > 1) next.link.skipped += step - 1;
    next.last.source = came.source;
    next.last.number = came.number;
  }

  Flow judge(const Arrival<Reading>& came, const Memory& memory, Time now) const {
    if (came.source == 0) return Flow::nothing;
    const bool is_broken = came.reading.valid && !is_sound(came.reading, robot_);
    if (lockstep_) return is_broken ? Flow::broken : Flow::fresh;
    if (came.source != memory.last.source && memory.last.source != 0) return Flow::restarted;
    const auto step = static_cast<std::int32_t>(came.number - memory.last.number);
    const bool first = memory.last.source == 0;
    if (!first && step == 0) return Flow::repeated;
    if (!first && step < 0) return Flow::out_of_order;
    if (came.reading.acquired > now) return Flow::broken;
    if (!first && came.reading.acquired < memory.last.reading.acquired) return Flow::broken;
    return is_broken ? Flow::broken : Flow::fresh;
  }

  static bool is_refusal(Flow flow) {
    return flow == Flow::out_of_order || flow == Flow::broken || flow == Flow::restarted;
  }

  void expire(Memory& next) const {
    if (next.link.age <= max_age_) return;
    next.last.reading.valid = false;
    if (next.link.flow == Flow::fresh || next.link.flow == Flow::repeated) next.link.flow = Flow::stale;
  }

  void read(const Memory& next, Reading& result) const { result = next.last.reading; }
  LinkStatus report(const Memory& next) const { return next.link; }

  JointCount robot_;
  Time max_age_;
  bool lockstep_;
};

}  // namespace flinch
