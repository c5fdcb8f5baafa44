#pragma once

namespace flinch {

class Context;

/// Brings values into a running diagram and takes others away: the control thread's side of whatever talks to
/// the world, usually by TripleBuffer from and to other threads. What it does may not allocate, lock, block
/// or throw.
class Exchange {
 public:
  virtual ~Exchange() = default;

  /// Before a tick: sets inputs of the diagram. One that is not set keeps its value.
  virtual void set_inputs(Context&) {}

  /// As soon as all outputs of the tick are computed, before any state changes: takes away what shall leave.
  virtual void take_outputs(const Context&) {}
};

}  // namespace flinch
