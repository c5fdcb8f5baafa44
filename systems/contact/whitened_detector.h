#pragma once

#include <memory>
#include <optional>

#include "systems/contact/contact_detector.h"
#include "systems/contact/onset_ratio.h"
#include "systems/contact/residual_errors.h"
#include "systems/framework/system.h"
#include "systems/signals/drive_load.h"

namespace flinch {

/// Above which Mahalanobis distance a residual is a contact, and what makes it one.
struct MahalanobisThreshold {
  double threshold = 0.0;  ///< of the length of the whitened residual
  ResidualErrors errors;
};

/// Above which Mahalanobis distance a likelihood ratio of onsets is a contact, and how the errors go on.
struct OnsetThreshold {
  double threshold = 0.0;
  AutoregressiveError course;
};

struct WhitenedDetectorSettings {
  MahalanobisThreshold level;   ///< of the residual itself
  MahalanobisThreshold change;  ///< of what is new of it: slow errors of the model are gone
  std::optional<MahalanobisThreshold> smoothed{};  ///< of what lasts: noise is gone
  std::optional<OnsetThreshold> onset{};           ///< in place of the threshold of the change
  ResidualTracking tracking;
  WrenchThreshold hard{60.0, 3.0};  ///< of the estimate, as of `ContactDetector`
};

/// Says that the robot is touched when what an estimator holds for the effort at the drives is larger than
/// its errors explain. Each drive's is divided by the deviation that its error has under its speed, torque,
/// friction, inertia and rest, as late as the estimator shows them (`ResidualErrors`, of motion without
/// contact); the length of what is left is compared with a threshold. The same is done with the change of
/// late, from which slow errors are gone, or with how the change has come about (`OnsetRatio`), and with the
/// smoothed residual, from which noise is gone: small forces that last show there. (Derived.)
///
/// The level latches as that of `ContactDetector`. In a tick whose estimate is not new nothing is detected;
/// where none has come for the longest hold, or it has fallen back to another estimator, the detection is
/// not valid.
class WhitenedDetector final : public System {
  State<LoadHistory> past_ = state<LoadHistory>("past");
  State<ResidualMemory> memory_ = state<ResidualMemory>("memory");
  State<OnsetMemory> onsets_ = state<OnsetMemory>("onsets");
  State<ContactDetection> previous_ = state<ContactDetection>("previous");

 public:
  /// Throws SetupError for thresholds and deviations that are not positive.
  WhitenedDetector(const std::shared_ptr<const ParallelRobot>& robot,
                   const WhitenedDetectorSettings& settings);

  InputPort<WrenchEstimate> wrench = input<WrenchEstimate>("wrench");
  InputPort<DriveLoad> load = input<DriveLoad>("load");
  InputPort<ResetCommand> reset = input<ResetCommand>("reset");

 private:
  Intermediate<ResidualMemory> next_ =
      intermediate<&WhitenedDetector::follow>("next", wrench, load, past_, memory_, clock);
  Intermediate<OnsetMemory> next_onsets_ =
      intermediate<&WhitenedDetector::follow_onsets>("next_onsets", next_, onsets_);

 public:
  OutputPort<ContactDetection> contact =
      output<&WhitenedDetector::detect>("contact", next_, next_onsets_, wrench, reset, previous_, clock);

 private:
  Update remember_ = update<&WhitenedDetector::remember>(past_, load);

  void follow(const WrenchEstimate& estimate, const DriveLoad& fresh, const LoadHistory& past,
              const ResidualMemory& memory, Time now, ResidualMemory& next) const {
    track_residual(estimate, fresh, past, now, settings_.tracking, memory, next);
  }
  void follow_onsets(const ResidualMemory& next, const OnsetMemory& onsets, OnsetMemory& result) const;
  void remember(const DriveLoad& fresh, LoadHistory& past) const {
    if (fresh.valid) past.push(fresh);
  }
  void detect(const ResidualMemory& next, const OnsetMemory& onsets, const WrenchEstimate& estimate,
              const ResetCommand& command, const ContactDetection& previous, Time now,
              ContactDetection& result) const;
  bool is_touched(const ResidualSample& seen, const OnsetMemory& onsets) const;

  WhitenedDetectorSettings settings_;
  std::optional<OnsetRatio> onset_;
  PlatformVector hard_;
};

}  // namespace flinch
