#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "experiments/report/page_samples.h"
#include "systems/framework/recorded_values.h"
#include "systems/signals/operator_command.h"
#include "systems/signals/target_command.h"

namespace flinch {

/// What the operator does, as named states of a page: a button that is down, or a target that is given.
class OperatorLane {
 public:
  OperatorLane(const Recording& recording, PageSamples& page);

  void show(std::size_t sample);

  /// Where nobody did anything.
  void drop_unless_used(Report& report) const;

 private:
  PageSamples& page_;
  std::optional<RecordedValues<OperatorCommand>> buttons_;
  std::optional<RecordedValues<TargetCommand>> target_;
  std::uint32_t number_ = 0;  ///< of the target seen last
  std::size_t lane_ = 0;
  bool was_used_ = false;
};

}  // namespace flinch
