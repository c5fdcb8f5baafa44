#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/verdict/recorded_run.h"
#include "experiments/verdict/verdict.h"

namespace flinch {

/// Finds the contacts and pushes of a run, sample by sample.
class ContactWatch {
 public:
  /// `estimators`: names of those that `RunSample::noticed_by` tells of.
  ContactWatch(const ForceLimits& limits, std::vector<std::string> estimators)
      : limits_(limits), estimators_(std::move(estimators)) {}

  /// The next sample; `period` [s].
  void see(const RunSample& now, double period);

  /// All contacts of a run that ended with the sample seen last.
  std::vector<ContactVerdict> contacts() const;

 private:
  void begin(const RunSample& now);
  void note_detections(const RunSample& now);
  void note_classification(const RunSample& now);
  void note_braking(const RunSample& now);
  void note_task(const RunSample& now);
  double onset_share(const RunSample& now) const;
  void extend(const RunSample& now, double period);
  void name_body(const RunSample& now, ContactVerdict& contact);
  void limit_force(ContactVerdict& contact) const;

  ForceLimits limits_;
  std::vector<std::string> estimators_;
  std::vector<ContactVerdict> contacts_;
  bool is_open_ = false;          ///< there was one
  double last_ = 0.0;             ///< sample that was touched [s]
  bool clamps_ = false;           ///< the contact is with both links of a leg
  std::string pending_clamping_;  ///< seen since the last sample with force; counts if there comes another
  std::optional<RunSample> before_;
};

}  // namespace flinch
