#include "experiments/comparison/signal_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "export/exported_signal.h"
#include "systems/signals/platform_motion.h"

namespace flinch {
namespace {

using internal::Number;

constexpr std::size_t most_samples = 4000;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

constexpr std::array charted = {
    ChartedField{"contact", "peak_force", "True contact force, largest so far"},
    ChartedField{"wrench", "wrench_in_base", "Estimated external wrench"},
    ChartedField{"detection", "level", "Detected level, largest so far"},
    ChartedField{"detection", "present_level", "Detected level"},
    ChartedField{"force_torque", "wrench", "Measured wrench"},
    ChartedField{"force_torque", "force", "Measured force"},
    ChartedField{"reaction", "mode", "Mode"},
    ChartedField{"motion", "pose", "Pose"},
    ChartedField{"motion", "velocity", "Velocity of the platform"},
    ChartedField{"joints", "active", "Drives, positions"},
    ChartedField{"joints", "passive", "Joints without drives"},
    ChartedField{"drives", "current", "Drives, currents"},
    ChartedField{"torque_command", "torque", "Drives, commanded"},
    ChartedField{"imu", "angular_velocity", "IMU, angular velocity"},
    ChartedField{"imu", "specific_force", "IMU, specific force"},
    ChartedField{"measures", "sigma_kappa", "Condition number"},
    ChartedField{"measures", "sigma_sc", "Self-collision distance"},
};

bool is_charted(const std::string& signal, const std::string& field) {
  return std::any_of(charted.begin(), charted.end(),
                     [&](const ChartedField& what) { return what.signal == signal && what.field == field; });
}

/// What tells whether a field of a signal is known.
struct Validity {
  const ExportedField* flag = nullptr;  ///< "valid" or alike; null: always known
  bool is_status = false;               ///< The flag is a PlatformMotion::Status.
  bool is_pose = false;                 ///< The field needs no velocity.

  bool is_known(const Number* row) const {
    if (flag == nullptr) return true;
    const std::int64_t said = row[flag->first].integer;
    if (!is_status) return said != 0;
    const auto status = static_cast<PlatformMotion::Status>(said);
    return status == PlatformMotion::Status::valid || (is_pose && status == PlatformMotion::Status::singular);
  }
};

/// A detector that is not valid has detected nothing, which is drawn.
Validity validity_of(const ExportedSignal& signal, const std::string& like, const std::string& field) {
  if (like == "detection") return {};
  const std::string name = like == "motion" ? "status" : field == "passive" ? "passive_valid" : "valid";
  for (const ExportedField& flag : signal.fields) {
    if (flag.name == name) return {&flag, like == "motion", field == "pose"};
  }
  return {};
}

}  // namespace

std::span<const ChartedField> charted_fields() { return charted; }

ChartAxis chart_axis(double first, double last, double period) {
  if (!(last >= first)) return {};
  const auto samples = static_cast<std::size_t>(std::llround((last - first) / period)) + 1;
  if (samples <= most_samples) return {first, period, samples, false};
  return {first, (last - first) / static_cast<double>(most_samples - 1), most_samples, true};
}

SignalDrawing::SignalDrawing(std::string path, const ChartAxis& axis, double delay, std::string like)
    : path_(std::move(path)), axis_(axis), delay_(delay), like_(like.empty() ? path_ : std::move(like)) {}

void SignalDrawing::Seen::hold(std::size_t at, double value) {
  if (!(low[at] <= value)) low[at] = value;
  if (!(high[at] >= value)) high[at] = value;
}

SignalDrawing::Seen& SignalDrawing::seen(const std::string& field, const std::string& name,
                                         const std::string& unit) {
  for (Seen& each : seen_) {
    if (each.field == field && each.name == name) return each;
  }
  const std::vector<double> nothing(axis_.count / stride() + 1, none);
  return seen_.emplace_back(Seen{field, name, unit, nothing, nothing});
}

void SignalDrawing::see(const Recording& part) {
  if (part.find(path_) == nullptr) return;
  const ExportedSignal signal = exported_signals(part, {path_}).front();
  std::vector<ExportedField> fields = signal.fields;
  std::erase_if(fields, [&](const ExportedField& field) { return !is_charted(like_, field.name); });
  std::vector<std::size_t> places;
  std::vector<Validity> validities;
  for (const ExportedField& field : fields) {
    validities.push_back(validity_of(signal, like_, field.name));
    for (std::size_t i = 0; i < field.width(); ++i)
      places.push_back(
          static_cast<std::size_t>(&seen(field.name, field.components[i], field.units[i]) - seen_.data()));
  }
  const std::size_t numbers = signal.signal->layout.numbers;
  for_each_block(part, *signal.signal, [&](std::size_t first, std::size_t count, const Number* rows) {
    for (std::size_t k = 0; k < count; ++k) {
      const double time = 1e-9 * static_cast<double>(part.time_ns[first + k]) - delay_;
      const double place = (time - axis_.start) / (axis_.period * static_cast<double>(stride()));
      const auto at =
          static_cast<std::size_t>(std::max(0.0, axis_.has_stretches ? place : std::round(place)));
      if (at > axis_.count / stride()) continue;
      const Number* const row = rows + k * numbers;
      auto component = places.begin();
      auto validity = validities.begin();
      for (const ExportedField& field : fields) {
        const std::size_t there = (validity++)->is_known(row) ? field.numbers_in(row) : 0;
        for (std::size_t i = 0; i < field.width(); ++i, ++component) {
          if (i >= there) continue;
          const Number& number = row[field.first + i];
          const double value =
              field.kind == Field::Kind::real ? number.real : static_cast<double>(number.integer);
          if (std::isfinite(value)) seen_[*component].hold(at, value);
        }
      }
    }
  });
}

std::vector<DrawnComponent> SignalDrawing::components() const {
  std::vector<DrawnComponent> drawn;
  for (const Seen& each : seen_) {
    DrawnComponent& component = drawn.emplace_back(DrawnComponent{each.field, each.name, each.unit, {}});
    for (std::size_t k = 0; k < axis_.count; ++k)
      component.values.push_back(k % stride() == 0 ? each.low[k / stride()] : each.high[k / stride()]);
  }
  return drawn;
}

void add_charts(const ChartedField& what, const std::vector<DrawnSignal>& drawn,
                nlohmann::ordered_json& charts) {
  std::vector<const DrawnComponent*> order;
  std::map<std::string, nlohmann::ordered_json> series;
  for (const DrawnSignal& signal : drawn) {
    for (const DrawnComponent& component : signal.components) {
      if (component.field != what.field) continue;
      const auto [place, is_new] = series.try_emplace(component.name, nlohmann::ordered_json::array());
      if (is_new) order.push_back(&component);
      place->second.push_back({{"run", signal.run}, {"values", short_numbers(component.values)}});
    }
  }
  for (const DrawnComponent* component : order) {
    const std::string& name = component->name;
    charts.push_back({{"id", std::string(what.signal) + "_" + what.field + (name.empty() ? "" : "_" + name)},
                      {"title", what.title + (name.empty() ? "" : ", " + name)},
                      {"unit", component->unit == "1" ? "" : component->unit},
                      {"series", std::move(series.at(name))}});
  }
}

nlohmann::ordered_json short_numbers(const std::vector<double>& values) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const double value : values) {
    if (std::isnan(value)) {
      list.push_back(nullptr);
      continue;
    }
    const double size = std::abs(value);
    const double scale = size > 1e-300 ? std::pow(10.0, 5.0 - std::floor(std::log10(size))) : 0.0;
    list.push_back(std::isfinite(scale) && scale > 0.0 ? std::round(value * scale) / scale : 0.0);
  }
  return list;
}

}  // namespace flinch
