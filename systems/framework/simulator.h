#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "systems/framework/context.h"
#include "systems/framework/integrator.h"

namespace flinch {

class BlockProfile;
class Diagram;
class Recorder;

/// Runs a diagram in simulated time, as fast as it can. What a tick means stands in diagram.h.
/// One Simulator works on one Context at a time; two threads need two Simulators and may share the diagram.
class Simulator {
 public:
  /// The default integrator is RungeKutta with one step a tick. Throws SetupError where a block needs another
  /// one and none is given.
  explicit Simulator(const Diagram& diagram, std::unique_ptr<Integrator> integrator = nullptr);
  ~Simulator();

  /// Lets `recorder` see every tick. It must outlive the Simulator.
  void record(Recorder& recorder) { recorders_.push_back(&recorder); }

  /// Lets `profile` time every block. It must outlive the Simulator.
  void profile(BlockProfile& profile) { profile_ = &profile; }

  /// Runs one tick: from t_k to t_{k+1}.
  void step(Context& context);

  /// The two halves of a tick, for who has something to do between them, as RealtimeRunner: the outputs at
  /// t_k, ...
  void evaluate(Context& context) const;
  /// ... and what follows from them: recorders, updates, integration to t_{k+1}.
  void advance(Context& context);

  /// Runs all ticks before `end`, then evaluates the outputs at `end`.
  void advance_to(Context& context, Time end);

  /// Steps in which the integrator did not reach its own accuracy.
  std::int64_t inaccurate_steps() const { return inaccurate_steps_; }

 private:
  class Step;

  void integrate(Context& context);

  const Diagram& diagram_;
  std::unique_ptr<Integrator> integrator_;
  std::vector<double> continuous_;
  std::vector<Recorder*> recorders_;
  BlockProfile* profile_ = nullptr;
  std::int64_t inaccurate_steps_ = 0;
};

}  // namespace flinch
