#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/verdict/recorded_run.h"
#include "experiments/verdict/verdict.h"

namespace flinch {

/// Finds the contacts and pushes of a run, sample by sample.
class ContactMonitor {
 public:
  /// `estimators`: names of those that `RunSample::detected_by` tells of; `obstacles`: of all.
  ContactMonitor(const ForceLimits& limits, std::vector<std::string> estimators,
                 std::vector<std::string> obstacles)
      : limits_(limits), estimators_(std::move(estimators)), obstacles_(std::move(obstacles)) {}

  /// The next sample; `period` [s].
  void see(const RunSample& now, double period);

  /// All contacts of a run that ended with the sample seen last, in the order of their onsets.
  std::vector<ContactVerdict> contacts() const;

 private:
  /// A contact, and what is known of it while it lasts.
  struct Watched {
    ContactVerdict seen;
    int obstacle = -1;               ///< it is with; -1: with none so far, or nobody saw with which
    double last = 0.0;               ///< sample that was touched [s]
    bool clamps = false;             ///< the contact is with both links of a leg
    std::string pending_clamping{};  ///< seen since the last sample with force; counts if there comes another
    std::vector<bool> alarmed{};  ///< by estimator: has detected something since before there was a contact

    bool lasts(double time) const { return time - last < Verdict::same_contact; }
  };

  Watched* contact_of(const RunLoad& load, double time);
  void see(const RunLoad& load, const RunSample& now, double period);
  Watched& begin(const RunLoad& load, const RunSample& now);
  void note_detections(const RunSample& now, Watched& contact) const;
  void note_classification(const RunSample& now, Watched& contact) const;
  void note_located(const RunSample& now, Watched& contact) const;
  void note_braking(const RunSample& now, ContactVerdict& contact) const;
  void note_task(const RunSample& now, ContactVerdict& contact) const;
  double load_before(int obstacle) const;
  void extend(const RunLoad& load, const RunSample& now, double period, Watched& contact) const;
  void name_body(const RunLoad& load, const RunSample& now, Watched& contact) const;
  void limit_force(ContactVerdict& contact) const;

  ForceLimits limits_;
  std::vector<std::string> estimators_;
  std::vector<std::string> obstacles_;
  std::vector<Watched> contacts_;
  std::optional<RunSample> before_;
};

}  // namespace flinch
