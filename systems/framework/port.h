#pragma once

#include <cstdint>
#include <type_traits>

#include "systems/framework/time.h"

namespace flinch {

class System;

/// Names one input, output or state of one System.
struct PortId {
  /// A handle that is used before its declaration may be all zeros: that names nothing.
  enum class Kind : std::uint8_t { none, clock, input, output, state };
  const System* owner = nullptr;
  Kind kind = Kind::none;
  int index = 0;

  friend bool operator==(const PortId&, const PortId&) = default;
};

/// Handles: small values, copied at will, valid as long as their System. Only System makes them; the type T
/// is that of the value, so that wiring different types does not compile.
template <class T>
struct InputPort {
  using Value = T;
  PortId id;
};

/// See InputPort.
template <class T>
struct OutputPort {
  using Value = T;
  PortId id;
};

/// A result that other functions of the same block read, computed once a tick. It cannot be connected; graphs
/// leave it out, and it is recorded only where its path is named.
template <class T>
struct Intermediate {
  using Value = T;
  PortId id;
};

/// A value that lasts from tick to tick: written by one update, kept from one port, or integrated along one
/// derivative. Private to its block.
template <class T>
struct State {
  using Value = T;
  PortId id;
};

/// The time of the tick, for functions that read it.
struct Clock {
  using Value = Time;
  PortId id{nullptr, PortId::Kind::clock, 0};
};

/// An input, output or state that is true or false.
template <class Port>
concept Condition = std::is_same_v<typename Port::Value, bool>;

/// When an output is computed: at the ticks at which a condition of the same block is true.
struct When {
  template <Condition Port>
  explicit When(Port port) : condition(port.id) {}

  PortId condition;
};

/// What update<...>(), keep() and derivative<...>() return, so that all can be declared as members.
struct Update {};
struct Derivative {};

/// A port whose value a State<T> can keep.
template <class Port, class T>
concept KeptBy = std::is_same_v<Port, InputPort<T>> || std::is_same_v<Port, OutputPort<T>> ||
    std::is_same_v<Port, Intermediate<T>>;

}  // namespace flinch
