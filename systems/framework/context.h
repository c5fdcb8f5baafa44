#pragma once

#include <cstddef>
#include <memory>

#include "systems/framework/place.h"
#include "systems/framework/port.h"
#include "systems/framework/time.h"

namespace flinch {

class Diagram;
class Layout;

/// Where one value lies in every Context of a diagram: Diagram::slot() finds it once, Context::operator[]
/// then is one or two additions.
template <class T>
struct Slot {
  Place place;
};

/// Everything of a running diagram that changes: the time, every port value and every state, in one block of
/// memory, apart from the diagram, which is const and can be shared. Copy it to snapshot, to rewind or to run
/// a thousand trials side by side, each in its own thread. Assigning between Contexts of one diagram does not
/// allocate. The diagram must outlive its Contexts.
class Context {
 public:
  explicit Context(const Diagram& diagram);
  Context(const Context& other);
  Context(Context&& other) noexcept;
  Context& operator=(const Context& other);
  Context& operator=(Context&& other) noexcept;
  ~Context();

  Time time() const { return *reinterpret_cast<const Time*>(memory_.get()); }
  void set_time(Time time) { *reinterpret_cast<Time*>(memory_.get()) = time; }

  /// Whether no tick has been completed yet.
  bool at_first_tick() const;
  /// Whether `every` is due at this tick: now, or skipped since the tick before.
  bool due(const Every& every) const;

  const Diagram& diagram() const { return *diagram_; }

  /// The value of a port or state. Input ports show the value of the output that they are connected to.
  template <class Port>
  const typename Port::Value& get(Port port) const {
    return *reinterpret_cast<const typename Port::Value*>(place_of(port.id).in(memory()));
  }

  /// Sets an input of the diagram itself, before a tick. Throws SetupError for any other input.
  template <class T>
  void set(InputPort<T> input, const T& value) {
    *reinterpret_cast<T*>(place_of_external(input.id).in(memory())) = value;
  }

  /// Overwrites a state.
  template <class T>
  void set(State<T> state, const T& value) {
    set_state(state.id, &value);
  }

  template <class T>
  const T& operator[](Slot<T> slot) const {
    return *reinterpret_cast<const T*>(slot.place.in(memory()));
  }
  template <class T>
  T& operator[](Slot<T> slot) {
    return *reinterpret_cast<T*>(slot.place.in(memory()));
  }

  std::byte* memory() { return memory_.get(); }
  const std::byte* memory() const { return memory_.get(); }

 private:
  friend class Diagram;

  struct FreeMemory {
    void operator()(std::byte* memory) const;
  };

  Place place_of(PortId port) const;
  Place place_of_external(PortId port) const;
  void set_state(PortId state, const void* value);
  void destroy_values();
  Time last_update() const;
  void complete_tick();

  const Diagram* diagram_;
  std::unique_ptr<std::byte, FreeMemory> memory_;
};

}  // namespace flinch
