#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <memory>

#include "experiments/verdict/verdict.h"
#include "systems/signals/contact_detection.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/reaction_state.h"

namespace flinch {

/// All that a verdict looks at, at one sample. What nobody measured is not a number.
struct RunSample {
  double time = 0.0;     ///< [s]
  bool is_true = false;  ///< body, clamping and loop closure are known
  int body = -1;         ///< that is touched hardest, BodyId::index()
  bool clamping = false;
  Eigen::Vector2d contact_force{0.0, 0.0};  ///< of the hardest touch [N]
  double loop_closure = 0.0;                ///< [m]
  Eigen::Vector3d pose{0.0, 0.0, 0.0};      ///< (x, y, phi) [m, m, rad], as those that follow
  Eigen::Vector3d velocity{0.0, 0.0, 0.0};
  Eigen::Vector3d external{0.0, 0.0, 0.0};  ///< wrench; zero where only an instrument looked on
  bool estimate_valid = false;
  Eigen::Vector3d estimate{0.0, 0.0, 0.0};
  bool reference_valid = false;
  Eigen::Vector3d reference{0.0, 0.0, 0.0};
  ContactDetection detection;
  ReactionMode mode = ReactionMode::stopped;
  GateStatus gate;

  double force() const { return std::hypot(contact_force[0], contact_force[1]); }
  double speed() const { return std::hypot(velocity[0], velocity[1]); }
};

/// The samples of a recording as its best witness saw them: the truth of a simulation, or an instrument. To
/// be read in their order; however many there are, few are in memory.
class RecordedRun {
 public:
  /// Throws SetupError when signals are missing. The recording must outlive the run.
  explicit RecordedRun(const Recording& recording);
  ~RecordedRun();

  Witness witness() const { return witness_; }
  std::size_t size() const;
  double period() const;    ///< [s]
  double duration() const;  ///< of all samples, each one period long [s]
  RunSample operator[](std::size_t sample) const;

 private:
  struct Signals;

  const Recording& recording_;
  Witness witness_;
  std::unique_ptr<Signals> signals_;
};

}  // namespace flinch
