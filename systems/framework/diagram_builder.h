#pragma once

#include <concepts>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "systems/framework/constant.h"
#include "systems/framework/diagram.h"

namespace flinch {

/// Adds blocks, wires them, and builds the Diagram.
///
///   DiagramBuilder builder("loop", 1ms);
///   auto& encoders = builder.add<Encoders>("encoders", settings);
///   auto& observer = builder.add<MomentumObserver>("observer", robot, gains);
///   builder.connect(encoders.joints, observer.joints);   // compiles only where the types are the same
///   auto wrench = builder.export_output("wrench", observer.wrench);
///   std::unique_ptr<Diagram> loop = builder.build();
class DiagramBuilder {
 public:
  /// `tick` is the period at which the outputs are evaluated; every update's period and offset must be
  /// multiples of it. A nested diagram runs at the tick of the outermost one.
  explicit DiagramBuilder(std::string name = "diagram", Time tick = 1ms);

  /// Adds a Block made from `arguments`. The reference lives as long as the diagram.
  template <class Block, class... Arguments>
  Block& add(std::string name, Arguments&&... arguments) {
    auto block = std::make_unique<Block>(std::forward<Arguments>(arguments)...);
    Block& reference = *block;
    add_child(std::move(name), std::move(block));
    return reference;
  }

  /// Nests a diagram, under its own name.
  Diagram& add(std::unique_ptr<Diagram> diagram);

  /// Lets `to`, an input of a block in this diagram, and further ones read `from`, an output of a block in
  /// it.
  template <class T, std::same_as<InputPort<T>>... More>
  void connect(OutputPort<T> from, InputPort<T> to, More... more) {
    add_wire(from.id, to.id);
    (add_wire(from.id, more.id), ...);
  }
  /// The same from an input of the diagram itself, made by input() or export_input().
  template <class T>
  void connect(InputPort<T> from, InputPort<T> to) {
    add_wire(from.id, to.id);
  }

  /// Lets `to`, an input of a block in this diagram, and further ones read `value` for ever.
  template <class T, std::same_as<InputPort<T>>... More>
  void fix(const T& value, InputPort<T> to, More... more) {
    connect(add<Constant<T>>(to.id.owner->name() + "_" + to.id.owner->port_name(to.id), value).value, to,
            more...);
  }

  /// Gives the diagram an input.
  template <PortValue T>
  InputPort<T> input(std::string_view name) {
    return diagram_->input<T>(name);
  }
  /// Gives the diagram an input that may be left open where the diagram is nested: then a Constant of T's
  /// default value feeds it, which says "no data".
  template <PortValue T>
  InputPort<T> optional_input(std::string_view name) {
    const InputPort<T> own = input<T>(name);
    diagram_->inputs_.back().stand_in = []() -> std::unique_ptr<System> {
      return std::make_unique<Constant<T>>(T{});
    };
    return own;
  }
  /// Gives the diagram an input which `inner` reads.
  template <class T>
  InputPort<T> export_input(std::string_view name, InputPort<T> inner) {
    const InputPort<T> own = input<T>(name);
    connect(own, inner);
    return own;
  }
  /// Gives the diagram an output that shows `inner`.
  template <class T>
  OutputPort<T> export_output(std::string_view name, OutputPort<T> inner) {
    return {add_export(name, value_type<T>, inner.id)};
  }

  /// Checks the wiring and fixes the order in which everything runs. Throws SetupError with all that is
  /// wrong, each with full path names: inputs not connected or connected twice, names used twice, algebraic
  /// loops port by port, periods that do not divide. The builder is empty afterwards.
  std::unique_ptr<Diagram> build();

 private:
  void add_child(std::string name, std::unique_ptr<System> block);
  PortId add_export(std::string_view name, const ValueType& type, PortId inner);
  void add_wire(PortId from, PortId to);
  bool is_wired(PortId to) const;
  void feed_open_inputs();
  bool is_child(const System* block) const;
  std::string path(PortId port) const;
  void find_unconnected(std::vector<std::string>& problems) const;
  void find_duplicates(std::vector<std::string>& problems) const;
  void find_foreign_exports(std::vector<std::string>& problems) const;

  std::unique_ptr<Diagram> diagram_;
  std::vector<std::string> problems_;
};

}  // namespace flinch
