#pragma once

#include <array>
#include <cstddef>
#include <optional>

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
  /// What is served at a sample by the followed law of the mode; nothing: not valid.
  struct Served {
    bool reacts = false;
    TaskEnergies energies;
  };
  bool is_there() const { return nominal_ || reaction_; }
  Served served_at(std::size_t sample, ReactionMode mode) const;

  PageSamples& page_;
  double period_;                                                   ///< [s]
  std::optional<RecordedValues<TaskEnergies>> nominal_, reaction_;  ///< of the followed laws
  Served before_;
  std::array<std::size_t, TaskEnergies::most> energy_{}, rate_{};  ///< columns
};

}  // namespace flinch
