#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "experiments/campaign/exact_bounds.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "plant/contact_truth.h"
#include "plant/plant_truth.h"
#include "systems/framework/recorded_values.h"
#include "systems/robot/link_contact.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/contact_classes.h"
#include "systems/signals/contact_detection.h"
#include "systems/signals/contact_location.h"

/// Contacts of simulated robots, as the control path isolates them.
namespace flinch::test {

inline std::string sort_of(const ContactClasses& classes, int touched) {
  if (classes.is_clamping(touched)) return "clamping";
  const BodyId body = ContactClasses::body(touched);
  return body.is_platform() ? "platform" : (body.is_link1() ? "first link" : "second link");
}

/// Two-sided exact bounds of a share.
inline std::array<double, 2> bounds(std::size_t events, std::size_t trials, double confidence = 0.95) {
  const double of_a_side = 0.5 * (1.0 + confidence);
  return {1.0 - clopper_pearson_upper(trials - events, trials, of_a_side),
          clopper_pearson_upper(events, trials, of_a_side)};
}

inline std::string share(std::size_t events, std::size_t trials) {
  const auto [low, high] = bounds(events, trials);
  char text[100];
  std::snprintf(text, sizeof text, "%zu of %zu (%.1f to %.1f %%)", events, trials, 100.0 * low, 100.0 * high);
  return text;
}

inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// What was recorded of one contact, sample by sample.
class Touched {
 public:
  /// `more`: signals besides those of classifiers and locators.
  explicit Touched(const SimulatedScenario& scenario, const std::vector<std::string>& more = {})
      : robot(scenario.robot.robot) {
    std::vector<std::string> signals = {"truth",
                                        "contact",
                                        "detection",
                                        "classification",
                                        "location",
                                        "location_particle_filter",
                                        "classification_decision_tree",
                                        "classification_model_classifier"};
    signals.insert(signals.end(), more.begin(), more.end());
    recording_ = run_for_signals(scenario, signals);
  }

  std::size_t samples() const { return recording_.samples(); }
  template <class T>
  T at(const std::string& path, std::size_t sample) const {
    return RecordedValues<T>(recording_, path)[sample];
  }

  /// First sample at which the detector detects something that is there; none: `samples()`.
  std::size_t detection() const {
    const RecordedValues<ContactDetection> detection(recording_, "detection");
    const RecordedValues<PlantTruth> truth(recording_, "truth");
    for (std::size_t k = 0; k < samples(); ++k) {
      const bool touched = truth[k].wrench_in_base.norm() > 1.0;
      if (touched && detection[k].present_level != ContactLevel::none) return k;
    }
    return samples();
  }

  /// Class of what has been touched up to a sample: clamping, once both links of a leg were, else the body
  /// that is touched hardest; -1: nothing is.
  int touched(std::size_t sample) const {
    const ContactClasses classes(robot->body_count(), robot->legs());
    const RecordedValues<ContactTruth> contact(recording_, "contact");
    for (std::size_t k = 0; k <= sample; ++k) {
      const ContactTruth now = contact[k];
      if (now.clamping) return classes.clamping(BodyId::from_index(now.strongest.body).leg());
    }
    return contact[sample].strongest.body;
  }

  std::shared_ptr<const ParallelRobot> robot;

 private:
  Recording recording_;
};

/// Counts of right answers of each class; balanced: the mean of the shares of all classes that occurred.
class Balance {
 public:
  void add(int truth, bool right) {
    const auto place = static_cast<std::size_t>(truth);
    if (place >= counts_.size()) counts_.resize(place + 1);
    ++counts_[place].all;
    counts_[place].right += right;
  }
  double accuracy() const {
    double sum = 0.0;
    int classes = 0;
    for (const Count& count : counts_) {
      if (count.all == 0) continue;
      sum += static_cast<double>(count.right) / count.all;
      ++classes;
    }
    return classes > 0 ? sum / classes : 0.0;
  }
  int count() const {
    int all = 0;
    for (const Count& count : counts_) all += count.all;
    return all;
  }

 private:
  struct Count {
    int right = 0, all = 0;
  };
  std::vector<Count> counts_;
};

}  // namespace flinch::test
