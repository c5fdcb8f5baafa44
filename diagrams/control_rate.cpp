#include "diagrams/control_rate.h"

#include <array>
#include <charconv>
#include <numbers>

#include "diagrams/contact_control_settings.h"

namespace flinch {
namespace {

std::string written(double number) {
  std::array<char, 32> text{};
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), number, std::chars_format::general, 4);
  return {text.data(), error == std::errc{} ? end : text.data()};
}

}  // namespace

std::vector<TooFast> too_fast_for_rate(const ContactControlSettings& settings) {
  const double period = to_seconds(settings.control_period);
  std::vector<TooFast> found;
  const auto require = [&](double value, double most, const char* unit, const char* section,
                           const char* key) {
    if (value <= most) return;
    found.push_back({section, key,
                     "is " + written(value) + " " + unit + "; with a control period of " +
                         written(1e6 * period) + " us it must be at most " + written(most) + " " + unit +
                         ", half of the rate; lower it, or shorten control_period_us"});
  };
  const double half = 0.5 / period, fastest = std::numbers::pi / period;  // [Hz], [1/s]
  require(settings.velocity_filter.low_pass.cutoff_frequency, half, "Hz", "velocity_filter",
          "cutoff_frequency");
  const PlatformVector& gain = settings.momentum_observer.gain;
  if (gain.size() > 0) require(gain.maxCoeff(), fastest, "1/s", "momentum_observer", "gain");
  require(settings.sliding_mode_observer.damping, fastest, "1/s", "sliding_mode_observer", "damping");
  require(settings.disturbance_filter.pole, fastest, "1/s", "disturbance_filter", "pole");
  require(settings.imu_residual.gyroscope_gain, fastest, "1/s", "imu_residual", "gyroscope_gain");
  require(settings.isolation.observer_gain, fastest, "1/s", "isolation", "observer_gain");
  return found;
}

std::vector<std::string> problems_of_rate(const ContactControlSettings& settings) {
  std::vector<std::string> found;
  for (const TooFast& filter : too_fast_for_rate(settings))
    found.push_back(filter.section + "." + filter.key + " " + filter.complaint);
  return found;
}

}  // namespace flinch
