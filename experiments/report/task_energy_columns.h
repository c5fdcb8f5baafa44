#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "experiments/report/page_samples.h"
#include "systems/framework/recorded_values.h"
#include "systems/signals/reaction_state.h"
#include "systems/signals/task_energies.h"

namespace flinch {

/// The columns of the Lyapunov functions of what the law of the mode serves, and how fast they change. A
/// recording of laws that tell none has no such columns.
class TaskEnergyColumns {
 public:
  TaskEnergyColumns(const Recording& recording, PageSamples& page);

  /// `mode`: of the robot at that sample.
  void show(std::size_t sample, ReactionMode mode);

 private:
  /// The law whose tasks are served at a sample, and their energies; none: not valid.
  struct Served {
    std::size_t law = 0;
    TaskEnergies energies;
  };
  Served served_at(std::size_t sample, ReactionMode mode) const;

  PageSamples& page_;
  double period_;  ///< [s]
  std::vector<std::string> names_;  ///< of the signals
  std::vector<RecordedValues<TaskEnergies>> laws_;
  Served before_;
  std::array<std::size_t, TaskEnergies::most> energy_{}, rate_{};  ///< columns
};

}  // namespace flinch
