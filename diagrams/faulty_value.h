#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "diagrams/requested_fault.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/random.h"
#include "systems/framework/system.h"
#include "systems/signals/brake_command.h"
#include "systems/signals/drive_reading.h"
#include "systems/signals/force_torque_reading.h"
#include "systems/signals/imu_reading.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/station_status.h"
#include "systems/signals/torque_command.h"

namespace flinch {

/// The numbers of a value that a fault may touch: two lists, of which the second is mostly empty.
using FaultyNumbers = std::array<std::span<double>, 2>;

template <class Numbers>
std::span<double> numbers_of(Numbers& numbers) {
  return {numbers.data(), static_cast<std::size_t>(numbers.size())};
}

inline FaultyNumbers touched_numbers(JointReading& joints, FaultSignal signal) {
  return {numbers_of(signal == FaultSignal::encoder ? joints.active : joints.passive)};
}
inline FaultyNumbers touched_numbers(DriveReading& drives, FaultSignal) {
  return {numbers_of(drives.current)};
}
inline FaultyNumbers touched_numbers(ImuReading& imu, FaultSignal signal) {
  if (signal == FaultSignal::gyroscope) return {numbers_of(imu.angular_velocity)};
  if (signal == FaultSignal::accelerometer) return {numbers_of(imu.specific_force)};
  return {numbers_of(imu.angular_velocity), numbers_of(imu.specific_force)};
}
inline FaultyNumbers touched_numbers(ForceTorqueReading& sensor, FaultSignal) {
  return {numbers_of(sensor.force_in_base), numbers_of(sensor.moment_in_base)};
}
inline FaultyNumbers touched_numbers(TorqueCommand& command, FaultSignal) {
  return {numbers_of(command.torque)};
}
inline FaultyNumbers touched_numbers(StationStatus&, FaultSignal) { return {}; }
inline FaultyNumbers touched_numbers(BrakeCommand&, FaultSignal) { return {}; }

/// Whether a fault is one of such values.
template <class Value>
bool touches(const RequestedFault& fault) {
  using enum FaultSignal;
  const FaultSignal signal = fault.signal;
  if (signal == link) return true;
  if constexpr (std::is_same_v<Value, JointReading>) return signal == encoder || signal == passive_encoder;
  if constexpr (std::is_same_v<Value, DriveReading>) return signal == current;
  if constexpr (std::is_same_v<Value, ImuReading>)
    return signal == gyroscope || signal == accelerometer || signal == imu;
  if constexpr (std::is_same_v<Value, ForceTorqueReading>) return signal == force_torque;
  if constexpr (std::is_same_v<Value, StationStatus>) return signal == status;
  // What a motor makes of its current is the simulated drive's.
  if constexpr (std::is_same_v<Value, TorqueCommand>)
    return signal == drive && fault.kind != FaultKind::scaled;
  return false;
}

/// A value with one fault, from its begin on.
template <class Value>
class FaultyValue final : public System {
 public:
  struct Memory {
    std::array<Value, 256> past;  ///< a ring: the value of each tick, of 64 ms at least
    std::size_t ticks = 0;        ///< how many have been
    Value delivered;              ///< the last one that was let through
    Value onset;                  ///< at the begin of the fault
    bool begun = false;
    std::array<double, 2 * max_dof> normal{};  ///< drawn anew for each tick
    double chance = 1.0;
    RandomGenerator generator;
  };

 private:
  State<Memory> memory_;

 public:
  /// `tick`: time between ticks. The fault must be one of such values.
  FaultyValue(const RequestedFault& fault, Time tick, std::uint64_t seed)
      : memory_(System::state<Memory>("memory", first(seed))), fault_(fault), tick_(tick) {}

  InputPort<Value> healthy = System::input<Value>("healthy");
  OutputPort<Value> spoilt = System::output<&FaultyValue::spoil>("spoilt", System::clock, healthy, memory_);

 private:
  Update remember_ = System::update<&FaultyValue::remember>(memory_, System::clock, healthy, spoilt);

  static Memory first(std::uint64_t seed) {
    Memory memory;
    memory.generator = RandomGenerator(seed);
    draw(memory);
    return memory;
  }

  static void draw(Memory& memory) {
    for (double& each : memory.normal) each = memory.generator.normal();
    memory.chance = memory.generator.uniform(0.0, 1.0);
  }

  void remember(Time now, const Value& value, const Value& told, Memory& memory) const {
    memory.past[memory.ticks % memory.past.size()] = value;
    ++memory.ticks;
    memory.delivered = told;
    if (!memory.begun && now >= fault_.begin) memory.onset = value;
    memory.begun = now >= fault_.begin;
    draw(memory);
  }

  void spoil(Time now, const Value& value, const Memory& memory, Value& result) const {
    result = value;
    if (now < fault_.begin) return;
    if (fault_.signal == FaultSignal::link) {
      result = arrived(value, memory);
    } else if (fault_.kind == FaultKind::off || (fault_.kind == FaultKind::intermittent && is_lost(memory))) {
      switch_off(result);
    } else if constexpr (std::is_same_v<Value, StationStatus>) {
      result = fault_.kind == FaultKind::stuck ? onset(value, memory) : before(value, memory);
      result.acquired = value.acquired;
    } else {
      change(now, memory, value, result);
    }
  }

  bool is_lost(const Memory& memory) const { return memory.chance < fault_.size.value_or(0.5); }
  static const Value& onset(const Value& value, const Memory& memory) {
    return memory.begun ? memory.onset : value;
  }

  /// What was true `size` seconds before, or at the first tick.
  const Value& before(const Value& value, const Memory& memory) const {
    if (fault_.kind != FaultKind::delayed) return value;
    const auto wanted = static_cast<std::size_t>((from_seconds(*fault_.size) + tick_ / 2) / tick_);
    const std::size_t ticks = std::min(wanted, memory.ticks);
    return ticks == 0 ? value : memory.past[(memory.ticks - ticks) % memory.past.size()];
  }

  const Value& arrived(const Value& value, const Memory& memory) const {
    if (fault_.kind == FaultKind::delayed) return before(value, memory);
    return fault_.kind == FaultKind::off || is_lost(memory) ? memory.delivered : value;
  }

  /// A motor without current is still there; a reading is not.
  void switch_off(Value& value) const {
    if constexpr (std::is_same_v<Value, TorqueCommand>) {
      for_each_touched(value, [](double& number, std::size_t, std::size_t) { number = 0.0; });
    } else if constexpr (std::is_same_v<Value, JointReading>) {
      (fault_.signal == FaultSignal::encoder ? value.valid : value.passive_valid) = false;
    } else if constexpr (!std::is_same_v<Value, BrakeCommand>) {
      value.valid = false;
    }
  }

  template <class Change>
  void for_each_touched(Value& value, Change&& change_number) const {
    const FaultyNumbers parts = touched_numbers(value, fault_.signal);
    for (std::size_t part = 0; part < parts.size(); ++part) {
      for (std::size_t i = 0; i < parts[part].size(); ++i) {
        if (!fault_.index || static_cast<std::size_t>(*fault_.index) == i) {
          change_number(parts[part][i], part, i);
        }
      }
    }
  }

  /// Of the past, the numbers come; the stamps are those of now.
  void change(Time now, const Memory& memory, const Value& value, Value& result) const {
    if constexpr (std::is_same_v<Value, ImuReading>) {
      if (fault_.kind == FaultKind::turned) return turn(result);
    }
    Value at_onset = onset(value, memory);
    Value earlier = before(value, memory);
    const FaultyNumbers first_numbers = touched_numbers(at_onset, fault_.signal);
    const FaultyNumbers old_numbers = touched_numbers(earlier, fault_.signal);
    for_each_touched(result, [&](double& number, std::size_t part, std::size_t i) {
      if (i >= first_numbers[part].size() || i >= old_numbers[part].size()) return;
      number = changed(number, {.first = first_numbers[part][i],
                                .earlier = old_numbers[part][i],
                                .normal = memory.normal[max_dof * part + i],
                                .time = to_seconds(now - fault_.begin)});
    });
  }

  void turn(ImuReading& reading) const {
    Eigen::Vector3d axis = Eigen::Vector3d::Ones().normalized();
    if (fault_.index) axis = Eigen::Vector3d::Unit(*fault_.index);
    const Eigen::Matrix3d turned = Eigen::AngleAxisd(-fault_.size.value_or(0.0), axis).toRotationMatrix();
    reading.angular_velocity = turned * reading.angular_velocity;
    reading.specific_force = turned * reading.specific_force;
  }

  struct Circumstances {
    double first = 0.0, earlier = 0.0, normal = 0.0, time = 0.0;
  };

  double changed(double number, const Circumstances& is) const {
    const double size = fault_.size.value_or(0.0);
    const bool counts =
        fault_.signal == FaultSignal::encoder || fault_.signal == FaultSignal::passive_encoder;
    const double zero = counts ? is.first : 0.0;
    switch (fault_.kind) {
      case FaultKind::stuck:
        if (fault_.signal == FaultSignal::drive) return fault_.size.value_or(is.first);
        return is.first + size * is.normal;
      case FaultKind::noise:
        return number + size * is.normal;
      case FaultKind::wrong:
        return number + size;
      case FaultKind::drifting:
        return number + size * is.time;
      case FaultKind::scaled:
        return zero + size * (number - zero);
      case FaultKind::reversed:
        return zero - (number - zero);
      case FaultKind::delayed:
        return is.earlier;
      case FaultKind::saturated:
        return std::clamp(number, -size, size);
      case FaultKind::off:
      case FaultKind::intermittent:
      case FaultKind::turned:
        break;
    }
    return number;
  }

  RequestedFault fault_;
  Time tick_;
};

/// The faults of a station, as they are wired.
struct RequestedFaults {
  std::vector<RequestedFault> all;
  Time tick = 1ms;         ///< of the diagram
  std::uint64_t seed = 0;  ///< of the run

  /// Adds a block for each fault of such values; returns what is left of them.
  template <class Value>
  OutputPort<Value> add(DiagramBuilder& builder, const std::string& name, OutputPort<Value> value) const {
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!touches<Value>(all[i])) continue;
      const std::string block = "fault_" + std::to_string(i + 1) + "_" + name;
      auto& faulty = builder.add<FaultyValue<Value>>(block, all[i], tick, derive_seed(seed, block));
      builder.connect(value, faulty.healthy);
      value = faulty.spoilt;
    }
    return value;
  }

  /// The same for what comes in: returns the input that stands before the faults.
  template <class Value>
  InputPort<Value> add_before(DiagramBuilder& builder, const std::string& name,
                              InputPort<Value> wanted) const {
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!touches<Value>(all[i])) continue;
      const std::string block = "fault_" + std::to_string(i + 1) + "_" + name;
      auto& faulty = builder.add<FaultyValue<Value>>(block, all[i], tick, derive_seed(seed, block));
      builder.connect(faulty.spoilt, wanted);
      wanted = faulty.healthy;
    }
    return wanted;
  }
};

}  // namespace flinch
