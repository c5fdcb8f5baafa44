#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "systems/framework/place.h"
#include "systems/framework/port.h"
#include "systems/framework/value_type.h"

namespace flinch {

struct PortIdHash {
  std::size_t operator()(const PortId& port) const {
    return std::hash<const void*>()(port.owner) * 31U + static_cast<std::size_t>(port.index) * 4U +
           static_cast<std::size_t>(port.kind);
  }
};

/// Where every value of a diagram lies in the memory of a Context. The time of the
/// tick comes first, that of the last update second.
class Layout {
 public:
  static constexpr std::size_t alignment = 64;
  static constexpr Place time = Place::fixed(0);
  static constexpr Place last_update = Place::fixed(sizeof(Time));
  static constexpr Time never = Time::min();  ///< before the first update

  struct Cell {
    std::uint32_t offset;
    const ValueType* type;
    std::shared_ptr<const void> initial;
  };

  Layout();

  /// Adds a value and returns its offset.
  std::uint32_t add(const ValueType& type, std::shared_ptr<const void> initial);
  /// Adds two cells that take turns: the first with the value `now`, the second with `next`.
  DoubleBuffer add_turns(const ValueType& type, std::shared_ptr<const void> now,
                         std::shared_ptr<const void> next);
  /// Says that the value of `port` lies at `place`; several ports may share one.
  void put(PortId port, Place place) { places_[port] = place; }

  bool contains(PortId port) const { return places_.contains(port); }
  Place place(PortId port) const { return places_.at(port); }
  const std::vector<Cell>& cells() const { return cells_; }
  std::size_t size() const { return size_; }

 private:
  std::vector<Cell> cells_;
  std::unordered_map<PortId, Place, PortIdHash> places_;
  std::size_t size_ = 0;
};

}  // namespace flinch
