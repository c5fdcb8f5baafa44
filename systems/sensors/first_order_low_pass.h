#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "systems/robot/vectors.h"

namespace flinch {

/// Both forms have the pole (2 - w T) / (2 + w T); they differ in what they feed it.
enum class LowPassForm : std::uint8_t {
  tustin,  ///< The last mean. As velocity filter: bilinear transform of w s / (s + w), lag 1 / w.
  backward_difference,  ///< The mean of the last two means, [PAR]: half a sample later.
};

struct LowPassSettings {
  double cutoff_frequency = 30.0;  ///< w / (2 pi) [Hz]. [ICRA23] III-A
  LowPassForm form = LowPassForm::tustin;

  friend bool operator==(const LowPassSettings&, const LowPassSettings&) = default;
};

/// All that is wrong with `settings`, one sentence each.
std::vector<std::string> problems(const LowPassSettings& settings);

/// What a low pass remembers.
struct LowPassMemory {
  bool started = false;
  JointVector mean;    ///< of the last interval
  JointVector output;  ///< at its end
};

/// First-order low pass w / (s + w) of a signal whose means m_k over the sampling intervals (t_{k-1}, t_k]
/// are known. Those of a velocity are differences of positions, (q_k - q_{k-1}) / T; that of a torque which a
/// drive holds for an interval is the torque itself. With a = (2 - w T) / (2 + w T):
///   y_k = a y_{k-1} + (1 - a) m_k                       tustin
///   y_k = a y_{k-1} + (1 - a) (m_k + m_{k-1}) / 2       backward_difference
class FirstOrderLowPass {
 public:
  explicit FirstOrderLowPass(const LowPassSettings& settings);

  /// The memory after an interval of length `interval` > 0 [s]. The first mean starts the filter in steady
  /// state, as if the signal had never been different.
  LowPassMemory next(const LowPassMemory& memory, const JointVector& mean, double interval) const noexcept;

 private:
  double w_;  // [rad/s]
  LowPassForm form_;
};

}  // namespace flinch
