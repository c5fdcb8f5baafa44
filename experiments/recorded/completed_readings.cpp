#include "experiments/recorded/completed_readings.h"

#include <algorithm>
#include <functional>
#include <map>
#include <string>

#include "systems/foundation/setup_error.h"
#include "systems/framework/recorded_values.h"
#include "systems/signals/drive_reading.h"
#include "systems/signals/force_torque_reading.h"
#include "systems/signals/imu_reading.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/operator_command.h"
#include "systems/signals/station_status.h"

namespace flinch {
namespace {

template <class Vector>
void mix(const Vector& a, const Vector& b, double share, Vector& between) {
  if (a.size() == b.size()) between = (1.0 - share) * a + share * b;
}

void interpolate(const JointReading& a, const JointReading& b, double share, JointReading& between) {
  mix(a.active, b.active, share, between.active);
  mix(a.passive, b.passive, share, between.passive);
  between.passive_valid = a.passive_valid && b.passive_valid;
}
void interpolate(const DriveReading& a, const DriveReading& b, double share, DriveReading& between) {
  mix(a.current, b.current, share, between.current);
}
void interpolate(const ImuReading& a, const ImuReading& b, double share, ImuReading& between) {
  mix(a.angular_velocity, b.angular_velocity, share, between.angular_velocity);
  mix(a.specific_force, b.specific_force, share, between.specific_force);
}
void interpolate(const ForceTorqueReading& a, const ForceTorqueReading& b, double share,
                 ForceTorqueReading& between) {
  mix(a.force_in_base, b.force_in_base, share, between.force_in_base);
  mix(a.moment_in_base, b.moment_in_base, share, between.moment_in_base);
}

class CompletedRows final : public RowSource {
 public:
  CompletedRows(std::shared_ptr<const Recording> readings, Recording& completed)
      : readings_(std::move(readings)), ticks_(completed.time_ns), is_same_(ticks_ == readings_->time_ns) {
    add<JointReading>("joints", completed);
    add<DriveReading>("drives", completed);
    add<ImuReading>("imu", completed);
    if (readings_->find("force_torque") != nullptr) add<ForceTorqueReading>("force_torque", completed);
    add_default<StationStatus>("status", completed, [](Time now, StationStatus& status) {
      status.acquired = now;
      status.valid = status.enabled = true;
    });
    add_default<OperatorCommand>("operator", completed, [](Time, OperatorCommand&) {});
  }

  void read(const std::string& path, std::size_t first, std::size_t count,
            internal::Number* rows) const override {
    readers_.at(path)(first, count, rows);
  }

 private:
  using Reader = std::function<void(std::size_t first, std::size_t count, internal::Number* rows)>;

  /// Rows of the recording as they are. False: it has no such signal, or other ticks.
  template <class T>
  bool add_as_it_is(const char* path, Recording& completed) {
    const Signal* const signal = readings_->find(path);
    if (signal == nullptr || !is_same_) return false;
    completed.signals.push_back({path, signal->layout, {}});
    readers_[path] = [this, signal](std::size_t first, std::size_t count, internal::Number* rows) {
      readings_->read_rows(*signal, first, count, rows);
    };
    return true;
  }

  template <class T, class Fill>
  void add_default(const char* path, Recording& completed, Fill fill) {
    if (add_as_it_is<T>(path, completed)) return;
    completed.signals.push_back({path, row_layout<T>(), {}});
    const std::size_t numbers = row_layout<T>().numbers;
    readers_[path] = [this, fill, numbers](std::size_t first, std::size_t count, internal::Number* rows) {
      for (std::size_t k = 0; k < count; ++k) {
        T value{};
        fill(Time(ticks_[first + k]), value);
        write_row(value, rows + k * numbers);
      }
    };
  }

  template <class T>
  void add(const char* path, Recording& completed) {
    if (readings_->find(path) == nullptr) return add_default<T>(path, completed, [](Time, T&) {});
    if (add_as_it_is<T>(path, completed)) return;
    completed.signals.push_back({path, row_layout<T>(), {}});
    const std::size_t numbers = row_layout<T>().numbers;
    const auto values = std::make_shared<RecordedValues<T>>(*readings_, path);
    readers_[path] = [this, values, numbers](std::size_t first, std::size_t count, internal::Number* rows) {
      for (std::size_t k = 0; k < count; ++k) write_row(at(*values, ticks_[first + k]), rows + k * numbers);
    };
  }

  /// The reading at a tick: a sample of it, or what lies between two.
  template <class T>
  T at(const RecordedValues<T>& values, std::int64_t tick) const {
    const std::vector<std::int64_t>& times = readings_->time_ns;
    const auto later = std::upper_bound(times.begin(), times.end(), tick);
    if (later == times.begin()) return T{};
    const auto k = static_cast<std::size_t>(later - times.begin()) - 1;
    const T a = values[k];
    if (times[k] == tick || k + 1 == times.size()) return times[k] == tick ? a : T{};
    T between = values[k + 1];
    const double share = static_cast<double>(tick - times[k]) / static_cast<double>(times[k + 1] - times[k]);
    interpolate(a, T(between), share, between);
    between.valid = a.valid && between.valid;
    between.acquired = Time(tick);
    return between;
  }

  std::shared_ptr<const Recording> readings_;
  std::vector<std::int64_t> ticks_;
  bool is_same_;
  std::map<std::string, Reader> readers_;
};

}  // namespace

Recording completed_readings(const std::shared_ptr<const Recording>& readings, Time tick) {
  readings->signal("joints");
  Recording completed;
  completed.period = tick;
  completed.attributes = readings->attributes;
  if (readings->period == tick) {
    completed.time_ns = readings->time_ns;
  } else if (!readings->time_ns.empty()) {
    for (std::int64_t now = readings->time_ns.front(); now <= readings->time_ns.back(); now += tick.count())
      completed.time_ns.push_back(now);
  }
  completed.source = std::make_shared<const CompletedRows>(readings, completed);
  return completed;
}

}  // namespace flinch
