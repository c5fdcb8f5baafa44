#include "experiments/dataset/contact_samples.h"

#include <algorithm>
#include <cmath>

#include "experiments/dataset/data_spec.h"
#include "experiments/verdict/recorded_estimate.h"
#include "systems/framework/recorded_values.h"
#include "systems/signals/contact_detection.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/sampling.h"

namespace flinch {
namespace {

constexpr double clamped_for = 5e-3;      // [s]
constexpr double later_after = 10e-3;     // after the detection [s]
constexpr double given_up_after = 60e-3;  // after the early tick, where the other detector sees nothing [s]

/// What of the simulation's contact is looked at.
struct TrueContact {
  struct Touch {
    int body = -1;
    int obstacle = -1;
    CartesianVector force_in_base;
    template <class Self, class Visit>
    static void fields(Self& self, Visit&& visit) {
      visit("body", "", self.body);
      visit("obstacle", "", self.obstacle);
      visit("force_in_base", "N", self.force_in_base, "base");
    }
  };
  bool in_contact = false;
  bool clamping = false;
  Touch strongest, second;
  std::int64_t contacts = 0;
  Time onset{};

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("in_contact", "", self.in_contact);
    visit("clamping", "", self.clamping);
    visit("strongest", "", self.strongest);
    visit("second", "", self.second);
    visit("contacts", "", self.contacts);
    visit("onset", "ns", self.onset);
  }
};

const std::string truth = "contact";

/// What is touched, tick by tick.
class Label {
 public:
  Label(const Recording& recording, const ParallelRobot& robot, const std::optional<GivenContact>& given)
      : classes_(classes_of(robot)), given_(given) {
    if (!given) contacts_.emplace(recording, truth);
  }

  /// To be called for every tick, in order.
  void see(std::size_t tick, double time) {
    if (given_) return;
    const TrueContact now = (*contacts_)[tick];
    begun_ = now.contacts > 0;
    onset_ = to_seconds(now.onset);
    if (!now.in_contact) return;  // what was touched last is what the estimate still tells of
    force_ = now.strongest.force_in_base.norm();
    if (now.clamping) {
      clamped_at_ = time;
      clamped_leg_ = BodyId::from_index(now.strongest.body).leg();
    }
    const bool is_clamped = clamped_leg_ >= 0 && time - clamped_at_ <= clamped_for;
    touched_ = is_clamped ? classes_.clamping(clamped_leg_) : now.strongest.body;
    const bool is_several = now.second.body >= 0 && now.second.body != now.strongest.body;
    if (is_several && !now.clamping) touched_ = -1;
  }

  bool begun() const { return given_ || begun_; }
  int touched() const { return given_ ? given_->touched : touched_; }  ///< -1: no one class
  double onset(double early) const { return given_ ? given_->begin.value_or(early) : onset_; }
  double force() const { return force_; }

 private:
  ContactClasses classes_;
  std::optional<GivenContact> given_;
  std::optional<RecordedValues<TrueContact>> contacts_;
  bool begun_ = false;
  int touched_ = -1, clamped_leg_ = -1;
  double onset_ = 0.0, force_ = 0.0, clamped_at_ = 0.0;
};

/// The ticks of one contact.
struct Stretch {
  std::size_t begin = 0;
  std::size_t end = 0;  ///< the first that is none of it

  Stretch(const Recording& recording, const std::optional<GivenContact>& given) : end(recording.samples()) {
    const auto tick_at = [&](double time) {
      const auto found = std::lower_bound(recording.time_ns.begin(), recording.time_ns.end(),
                                          static_cast<std::int64_t>(std::llround(1e9 * time)));
      return static_cast<std::size_t>(found - recording.time_ns.begin());
    };
    if (given && given->begin) begin = tick_at(*given->begin);
    if (given && given->next) end = tick_at(*given->next);
  }
};

/// First tick at which a detector detects something; none where it never does. What lasts from a contact
/// before is none.
std::optional<std::size_t> first_detection(const Recording& recording, const std::string& path,
                                           const Stretch& within) {
  const auto detections = read<ContactDetection>(recording, path);
  const auto detects = [&](std::size_t tick) {
    return within.begin == 0 ? detections[tick].level != ContactLevel::none
                             : detections[tick].present_level != ContactLevel::none;
  };
  std::size_t tick = within.begin;
  if (tick > 0 && tick < within.end && detects(tick - 1)) {
    while (tick < within.end && detects(tick)) ++tick;
  }
  for (; tick < within.end; ++tick)
    if (detects(tick)) return tick;
  return std::nullopt;
}

/// Where the estimate lies; the followed estimator's is called "wrench".
std::string wrench_of(const SampleChoice& choice, const Recording& recording) {
  if (choice.wrench == "isolation") return "isolation_wrench";
  const std::string own = "wrench_" + choice.wrench;
  return recording.find(own) != nullptr ? own : "wrench";
}
std::string detection_of(const std::string& estimator) {
  return estimator.empty() ? "detection" : "detection_by_" + estimator;
}

/// Ticks of the moments, as far as they come about.
struct Moments {
  Moments(const Recording& recording, const SampleChoice& choice, const Stretch& within)
      : early(first_detection(recording, detection_of(choice.early_by), within)),
        detected(first_detection(recording, detection_of(""), within)) {
    if (!early || (detected && *detected < *early)) early = detected;
    if (!early) return;
    const auto ticks = [&](double time) {
      return static_cast<std::size_t>(time / to_seconds(recording.period) + 0.5);
    };
    if (detected) later = *detected + ticks(later_after);
    end = later.value_or(*early + ticks(given_up_after));
  }

  int at(std::size_t tick) const {
    return (tick == early ? Moment::early : 0) | (tick == detected ? Moment::detected : 0) |
           (tick == later ? Moment::later : 0);
  }

  std::optional<std::size_t> early, detected, later;
  std::size_t end = 0;
};

/// How far a recording has come towards samples.
struct Progress {
  bool begun = false, detected = false;
  bool labelled = false;   ///< At some tick after that one thing touched.
  bool estimated = false;  ///< At one of those the wrench was known.
  bool chosen = false;     ///< One of those was asked for.

  std::string lacks() const {
    if (!begun) return "nothing touched";
    if (!detected) return "not detected";
    if (!labelled) return "detected, but at no tick did one thing touch";
    if (estimated && !chosen) return "detected, but at no tick that 'samples' asks for";
    return "detected, but wrench or motion were not known";
  }
};

/// None where something was not known at one of its moments.
std::optional<ContactMoments> course_at(std::size_t tick, Time period,
                                        const RecordedValues<RecordedEstimate>& estimates,
                                        const RecordedValues<PlatformMotion>& motions) {
  ContactMoments course;
  for (std::size_t i = 0; i < window_ages.size(); ++i) {
    const auto age = static_cast<std::size_t>((window_ages[i] + period - Time{1}) / period);
    if (age > tick) return std::nullopt;
    const RecordedEstimate estimate = estimates[tick - age];
    const PlatformMotion motion = motions[tick - age];
    if (!estimate.valid || !motion.valid()) return std::nullopt;
    course[i] = {estimate.wrench_in_base, motion.velocity};
    const Time later = static_cast<Time::rep>(age) * period - window_ages[i];
    if (period <= 1ms || later == Time::zero()) continue;  // as ContactWindowBuffer: between two long ticks
    const RecordedEstimate next = estimates[tick - age + 1];
    const PlatformMotion moved = motions[tick - age + 1];
    if (!next.valid || !moved.valid()) return std::nullopt;
    const double share = to_seconds(later) / to_seconds(period);
    course[i].wrench_in_base += share * (next.wrench_in_base - course[i].wrench_in_base);
    course[i].velocity += share * (moved.velocity - course[i].velocity);
  }
  return course;
}

}  // namespace

std::vector<std::string> sampled_signals(const SampleChoice& choice) {
  std::vector<std::string> signals = {
      truth, "motion", "wrench", "isolation_wrench", "wrench_" + choice.wrench, detection_of("")};
  if (!choice.early_by.empty()) signals.push_back(detection_of(choice.early_by));
  return signals;
}

ContactSamples contact_samples(const Recording& recording, const ParallelRobot& robot,
                               const SampleChoice& choice, const std::optional<GivenContact>& given) {
  const Stretch within(recording, given);
  const Moments moments(recording, choice, within);
  Label label(recording, robot, given);
  const auto motions = read<PlatformMotion>(recording, "motion");
  const auto estimates = read<RecordedEstimate>(recording, wrench_of(choice, recording));
  const double period = to_seconds(recording.period);
  ContactSamples result;
  Progress progress{.detected = moments.early.has_value()};
  const double start = recording.time_ns.empty() ? 0.0 : 1e-9 * static_cast<double>(recording.time_ns[0]);
  for (std::size_t tick = 0; tick < within.end; ++tick) {
    const double time = start + static_cast<double>(tick) * period;
    label.see(tick, time);
    if (moments.early && tick == *moments.early && !label.begun())
      return {{}, "detected before anything touched"};
    if (!moments.early || tick < *moments.early) continue;
    if (label.touched() < 0) continue;
    progress.labelled = true;
    const RecordedEstimate estimate = estimates[tick];
    if (!estimate.valid) continue;
    progress.estimated = true;
    const int moment = moments.at(tick);
    const auto every = static_cast<std::size_t>(periods_in(choice.every * 1ms, recording.period));
    const bool is_due = (tick - *moments.early) % every == 0;
    const double force = estimate.wrench_in_base.head(robot.space().translations()).norm();
    const bool is_chosen = choice.from_force ? force >= *choice.from_force && is_due
                                             : tick <= moments.end && (moment != 0 || is_due);
    if (!is_chosen) continue;
    progress.chosen = true;
    const auto course = course_at(tick, recording.period, estimates, motions);
    if (!course) continue;
    const double early = start + static_cast<double>(*moments.early) * period;
    result.samples.push_back({0, 0, moment, label.touched(), time - label.onset(early), time - early,
                              label.force(), motions[tick].pose, *course});
  }
  progress.begun = label.begun();
  if (result.samples.empty()) result.left_out = progress.lacks();
  return result;
}

}  // namespace flinch
