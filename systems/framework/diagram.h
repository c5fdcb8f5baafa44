#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "systems/framework/block_function.h"
#include "systems/framework/context.h"
#include "systems/framework/layout.h"
#include "systems/framework/system.h"

namespace flinch {

class BlockProfile;

/// Blocks wired together, checked and put in order by DiagramBuilder::build(). A diagram is itself a System:
/// it exports ports and nests. It never changes; what changes lives in Contexts, so threads may share it.
///
/// Its meaning, tick by tick, with tick period T and t_k = k T:
///
///   x     := initial value of every state
///   for k = 0, 1, 2, ...
///     u   := the diagram's input ports, as set from outside before the tick
///     y   := every output, from x, u and t_k, each once, in an order in which what is read comes first;
///            one that has an occasion only if k = 0 or that is due, otherwise its value stays as it was
///     recorders see y and u
///     x_d := every update that is due at t_k, all computed from the old x and from y,
///            then all written at once
///     x_c := the continuous states integrated from t_k to t_{k+1}, with u and the new x_d held;
///            inside that step only the outputs that a derivative depends on are computed again
///
/// So a state that an update writes at t_k acts from t_k on: a value held by it is a zero-order hold without
/// delay in continuous time, and one tick of delay between discrete blocks.
///
/// The occasion of an output, and that of an update, is an Every or a When. An Every is due at t_k when one
/// of its instants lies in (t_{k-1}, t_k], so that none is lost where the clock skips periods; at k = 0 when
/// it is t_0. A When is due if its condition, computed at this very tick, is true. A held output is there
/// without delay at the tick that computes it, and costs nothing in between; outputs that read nothing but
/// what is held on one occasion are held as well. Derivatives see held outputs as they are at t_k.
///
/// What a Context shows: outputs show y from one evaluate() to the next, also after update(); states show x,
/// the old one until update() and the new one after it. A state that keeps an output takes turns with it: its
/// new value is y itself, and the next tick's y is written where its old value was. So the place of both
/// changes, and is asked for anew at every access (Place).
class Diagram : public System {
 public:
  ~Diagram() override;

  /// A Context with every state at its initial value. Outputs are valid after the first evaluate().
  Context make_context() const { return Context(*this); }

  /// The time from one tick to the next.
  Time tick() const { return tick_; }

  /// y: computes every output. Never allocates. A `profile`, here and below, times each block.
  void evaluate(Context& context, BlockProfile* profile = nullptr) const;
  /// x_d: runs the updates that are due at the context's time. Needs evaluate() before. Never allocates.
  void update(Context& context, BlockProfile* profile = nullptr) const;

  /// How many numbers the continuous states have together.
  std::size_t continuous_size() const { return continuous_size_; }
  /// The path of the first block inside that needs adaptive steps; "" where none does.
  std::string needing_adaptive_steps() const;
  void get_continuous(const Context& context, std::span<double> numbers) const;
  void set_continuous(Context& context, std::span<const double> numbers) const;
  /// Computes what the derivatives depend on and what stays constant during a step: once before
  /// derivatives().
  void begin_step(Context& context, BlockProfile* profile = nullptr) const;
  /// The time derivative [per second] of the continuous states in `context`.
  void derivatives(Context& context, std::span<double> rates, BlockProfile* profile = nullptr) const;

  /// Where the value of `port` lies, for repeated access.
  template <class Port>
  Slot<typename Port::Value> slot(Port port) const {
    return {place(port.id)};
  }

  /// The blocks directly inside, in the order in which they were added.
  const std::vector<std::unique_ptr<System>>& children() const { return children_; }

  /// A port of any block inside, by its path: "station/encoders/joints"; inputs and outputs, exported ones as
  /// well.
  struct Tap {
    std::string path;
    PortId port;
    const ValueType* type;
    Place place;
    bool intermediate;  ///< whether only the block itself reads it
  };
  /// All output ports and inputs of the diagram itself, in the order in which they are declared.
  std::vector<Tap> taps() const;
  /// The tap called `path`. Throws SetupError naming the nearest existing path.
  Tap tap(const std::string& path) const;

  /// The diagram drawn in Graphviz' DOT language: nested diagrams as clusters, ports as rows of their blocks.
  std::string graphviz() const;
  /// The order in which everything runs, one line a function: for people who debug a diagram.
  std::string schedule() const;

  // For Context and tools: the memory plan.
  struct Wire {
    PortId from;
    PortId to;
  };
  struct StateCell {
    PortId state;
    const ValueType* type;
    Place now;
    std::optional<Place> next;          ///< where an update writes its next value, or a derivative its rate
    std::optional<DoubleBuffer> turns;  ///< with the output that it keeps
  };
  const Layout& layout() const { return layout_; }
  const std::vector<Wire>& wires() const { return wires_; }
  const std::vector<StateCell>& state_cells() const { return state_cells_; }
  Place place(PortId port) const;

 private:
  friend class DiagramBuilder;
  friend class Scheduler;
  Diagram() = default;

  struct Call {
    const System* block;
    BlockFunction function;
    std::uint32_t first_place;  ///< into places_
  };
  struct Copy {
    const ValueType* type;
    Place from;
    Place to;
  };
  /// Neighbours among the outputs in order that are computed on the same occasion, and hold their values
  /// otherwise.
  struct HeldOutputs {
    std::optional<Every> every;
    Place when;  ///< without `every`: the condition
    std::size_t begin;
    std::size_t end;
    Place computed;                   ///< whether they have been, since the tick before
    std::vector<DoubleBuffer> turns;  ///< each of the value held and the one computed
  };
  struct UpdateGroup {
    Every every;
    std::vector<Call> calls;
    std::vector<Copy> copies;        ///< to the states that the calls compute, and from inputs that are kept
    std::vector<DoubleBuffer> kept;  ///< of the states that keep an output
  };

  void run(std::span<const Call> calls, std::byte* memory, BlockProfile* profile) const;
  void run_timed(std::span<const Call> calls, std::byte* memory, BlockProfile& profile) const;
  bool is_due(const HeldOutputs& held, const Context& context) const;
  void collect_taps(const Diagram& diagram, const std::string& prefix, std::vector<Tap>& taps) const;

  Time tick_{};
  std::vector<std::unique_ptr<System>> children_;
  std::vector<Wire> wires_;

  Layout layout_;
  std::vector<Place> places_;
  std::vector<Call> outputs_in_order_;
  std::vector<HeldOutputs> held_outputs_;
  std::vector<DoubleBuffer> kept_outputs_;  ///< of those that are not held
  std::vector<UpdateGroup> update_groups_;
  std::vector<Call> constant_in_step_;
  std::vector<DoubleBuffer> kept_in_step_;  ///< those kept outputs that are computed again in a step
  std::vector<Call> varying_in_step_;
  std::vector<Call> derivative_calls_;
  std::vector<StateCell> state_cells_;
  std::vector<StateCell> continuous_cells_;
  std::size_t continuous_size_ = 0;
  std::vector<std::string> schedule_lines_;
};

}  // namespace flinch
