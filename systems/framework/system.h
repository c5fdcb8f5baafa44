#pragma once

#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "systems/framework/block_function.h"
#include "systems/framework/port.h"
#include "systems/framework/time.h"
#include "systems/framework/value_type.h"

namespace flinch {

/// A block: pure functions between typed ports. A block declares its ports and states as members; every
/// output, update and derivative is a const member function that takes exactly the values which its
/// declaration names, in that order, and nothing else:
///
///   class LowPass final : public System {
///     State<double> filtered_ = state<double>("filtered", 0.0);  // above its readers
///
///    public:
///     InputPort<double> raw = input<double>("raw");
///     OutputPort<double> smooth = output<&LowPass::read>("smooth", filtered_);
///
///    private:
///     Update filter_ = update<&LowPass::filter>(filtered_, filtered_, raw);  // writes the first
///
///     double read(double filtered) const { return filtered; }
///     double filter(double filtered, double newest) const { return 0.9 * filtered + 0.1 * newest; }
///   };
///
/// A function returns its result or takes it as last argument, `Result&`. There an update finds the present
/// value of its state; other functions find any earlier value, and write all of it. So what an output depends
/// on is its argument list, and a block is tested by calling a function. Nothing that a function of a block
/// does may allocate, lock, throw or block; what it cannot compute it says in its result (`valid`).
class System {
 public:
  virtual ~System() = default;
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  /// The name under which it was added to a diagram; unique there.
  const std::string& name() const { return name_; }

  struct Input {
    std::string name;
    const ValueType* type;
    std::unique_ptr<System> (*stand_in)() = nullptr;  ///< of an optional input: what feeds it if nobody does
  };
  /// When an output is computed: none of both stands for every tick.
  struct Occasion {
    std::optional<Every> every;
    std::optional<PortId> when;
    friend bool operator==(const Occasion&, const Occasion&) = default;
  };
  struct Output {
    std::string name;
    const ValueType* type;
    BlockFunction function;     ///< null for the outputs of a diagram
    std::vector<PortId> reads;  ///< its arguments; for a diagram the one inner output which it exports
    bool intermediate = false;  ///< read by functions of the same block only
    Occasion occasion;
  };
  struct StateVariable {
    std::string name;
    const ValueType* type;
    std::shared_ptr<const void> initial;
  };
  struct Change {  ///< an update or a derivative
    PortId state;
    BlockFunction function;  ///< null: the state keeps the value of the one port that is read
    std::vector<PortId> reads;
    std::optional<Every> every;  ///< none: at every tick (updates), always (derivatives)
  };

  const std::vector<Input>& inputs() const { return inputs_; }
  const std::vector<Output>& outputs() const { return outputs_; }
  const std::vector<StateVariable>& states() const { return states_; }
  const std::vector<Change>& updates() const { return updates_; }
  const std::vector<Change>& derivatives() const { return derivatives_; }

  /// The name of a port or state of this block.
  const std::string& port_name(PortId port) const;

  /// Whether the continuous states change too fast for equal steps from tick to tick.
  bool needs_adaptive_steps() const { return needs_adaptive_steps_; }

 protected:
  System() = default;

  /// Declares an input.
  template <PortValue T>
  InputPort<T> input(std::string_view name) {
    return {add_input(name, value_type<T>)};
  }

  /// Declares a state with its value at time zero.
  template <PortValue T>
  State<T> state(std::string_view name, const T& initial = T{}) {
    return {add_state(name, value_type<T>, &initial)};
  }

  /// Declares an output that `function` computes from `reads`: inputs, states, other outputs, `clock`.
  template <auto function, class... Reads>
  auto output(std::string_view name, Reads... reads) {
    using Value = typename internal::Signature<function>::Result;
    return OutputPort<Value>{add_output<function, typename Reads::Value...>({}, name, {reads.id...}, false)};
  }

  /// The same, but computed only at the first tick and when due; in between it holds its value. Outputs that
  /// read nothing but what is held for the same reason need not say so: they are held as well.
  template <auto function, class... Reads>
  auto output(Every every, std::string_view name, Reads... reads) {
    using Value = typename internal::Signature<function>::Result;
    return OutputPort<Value>{
        add_output<function, typename Reads::Value...>({every, std::nullopt}, name, {reads.id...}, false)};
  }

  /// The same, but computed only at the first tick and when a condition is true.
  template <auto function, class... Reads>
  auto output(When when, std::string_view name, Reads... reads) {
    using Value = typename internal::Signature<function>::Result;
    return OutputPort<Value>{add_output<function, typename Reads::Value...>({std::nullopt, when.condition},
                                                                            name, {reads.id...}, false)};
  }

  /// Declares a result that only functions of this block read.
  template <auto function, class... Reads>
  auto intermediate(std::string_view name, Reads... reads) {
    using Value = typename internal::Signature<function>::Result;
    return Intermediate<Value>{add_output<function, typename Reads::Value...>({}, name, {reads.id...}, true)};
  }

  /// The same, but computed only at the first tick and when due.
  template <auto function, class... Reads>
  auto intermediate(Every every, std::string_view name, Reads... reads) {
    using Value = typename internal::Signature<function>::Result;
    return Intermediate<Value>{
        add_output<function, typename Reads::Value...>({every, std::nullopt}, name, {reads.id...}, true)};
  }

  /// The same, but computed only at the first tick and when a condition is true.
  template <auto function, class... Reads>
  auto intermediate(When when, std::string_view name, Reads... reads) {
    using Value = typename internal::Signature<function>::Result;
    return Intermediate<Value>{add_output<function, typename Reads::Value...>({std::nullopt, when.condition},
                                                                              name, {reads.id...}, true)};
  }

  /// Declares that at every tick `function`, evaluated from `reads`, becomes the next value of `written`.
  template <auto function, class T, class... Reads>
  Update update(State<T> written, Reads... reads) {
    return add_update<function, T, typename Reads::Value...>(std::nullopt, written.id, {reads.id...});
  }

  /// The same, but only when due.
  template <auto function, class T, class... Reads>
  Update update(Every every, State<T> written, Reads... reads) {
    return add_update<function, T, typename Reads::Value...>(every, written.id, {reads.id...});
  }

  /// Declares that at every tick the value of `kept` becomes the next value of `state`. An output of this
  /// block or another is not copied: the next tick's is computed elsewhere.
  template <class T, KeptBy<T> Port>
  Update keep(State<T> state, Port kept) {
    return add_keep(std::nullopt, state.id, kept.id);
  }

  /// The same, but only when due.
  template <class T, KeptBy<T> Port>
  Update keep(Every every, State<T> state, Port kept) {
    return add_keep(every, state.id, kept.id);
  }

  /// Declares that `function`, evaluated from `reads`, is the time derivative of `integrated` [per second].
  template <auto function, ContinuousValue T, class... Reads>
  Derivative derivative(State<T> integrated, Reads... reads) {
    internal::check_result<function, T>();
    internal::check_arguments<function, typename Reads::Value...>();
    check_owner<function>();
    return add_derivative(integrated.id, internal::call<function>, {reads.id...});
  }

  /// Declares that the continuous states change too fast for equal steps from tick to tick, as those of
  /// bodies that touch do: a Simulator of this block must be given an Integrator.
  void require_adaptive_steps() { needs_adaptive_steps_ = true; }

  /// The time of the tick, as an argument of functions.
  static constexpr Clock clock{};

 private:
  friend class Diagram;
  friend class DiagramBuilder;

  using PortIds = std::initializer_list<PortId>;

  template <auto function, class... Values>
  PortId add_output(const Occasion& occasion, std::string_view name, PortIds reads, bool intermediate) {
    using Value = typename internal::Signature<function>::Result;
    internal::check_arguments<function, Values...>();
    check_owner<function>();
    return add_output(name, value_type<Value>, internal::call<function>, reads, intermediate, occasion);
  }

  template <auto function, class T, class... Values>
  Update add_update(const std::optional<Every>& every, PortId written, PortIds reads) {
    internal::check_result<function, T>();
    internal::check_arguments<function, Values...>();
    check_owner<function>();
    return add_update(written, internal::call<function>, reads, every);
  }

  /// Throws SetupError for a function of another block.
  template <auto function>
  void check_owner() const {
    using Block = typename internal::Signature<function>::Block;
    static_assert(std::is_base_of_v<System, Block>,
                  "the declaration names a function of a class that is no block");
    if (dynamic_cast<const Block*>(this) == nullptr) refuse_function_of(typeid(Block));
  }
  [[noreturn]] void refuse_function_of(const std::type_info& other) const;

  // What the templates above come to. Only these know the lists, so that each declaration of a block compiles
  // to one call.
  PortId add_input(std::string_view name, const ValueType& type);
  PortId add_state(std::string_view name, const ValueType& type, const void* initial);
  PortId add_output(std::string_view name, const ValueType& type, BlockFunction function, PortIds reads,
                    bool intermediate, const Occasion& occasion);
  Update add_update(PortId written, BlockFunction function, PortIds reads, const std::optional<Every>& every);
  Update add_keep(const std::optional<Every>& every, PortId state, PortId kept);
  Derivative add_derivative(PortId integrated, BlockFunction function, PortIds reads);

  /// Returns `ports` when all are declared and of this block; throws SetupError otherwise.
  std::vector<PortId> own(PortIds ports) const;
  bool declared(PortId port) const;

  std::string name_;
  std::vector<Input> inputs_;
  std::vector<Output> outputs_;
  std::vector<StateVariable> states_;
  std::vector<Change> updates_;
  std::vector<Change> derivatives_;
  bool needs_adaptive_steps_ = false;
};

}  // namespace flinch
