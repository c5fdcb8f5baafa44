#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "systems/framework/port.h"
#include "systems/framework/value_type.h"

namespace flinch {

struct PortIdHash {
  std::size_t operator()(const PortId& port) const {
    return std::hash<const void*>()(port.owner) * 31U + static_cast<std::size_t>(port.index) * 4U +
           static_cast<std::size_t>(port.kind);
  }
};

/// Where every value of a diagram lies in the memory of a Context. The time is at offset 0.
class Layout {
 public:
  static constexpr std::size_t alignment = 64;

  struct Cell {
    std::uint32_t offset;
    const ValueType* type;
    std::shared_ptr<const void> initial;
  };

  Layout();

  /// Adds a value that belongs to no port and returns its offset.
  std::uint32_t add(const ValueType& type, std::shared_ptr<const void> initial);
  /// Adds the value of `port`.
  std::uint32_t add(PortId port, const ValueType& type, std::shared_ptr<const void> initial);
  /// Lets `port` share the value at `offset`.
  void alias(PortId port, std::uint32_t offset) { offsets_[port] = offset; }

  bool contains(PortId port) const { return offsets_.contains(port); }
  std::uint32_t offset(PortId port) const { return offsets_.at(port); }
  const std::vector<Cell>& cells() const { return cells_; }
  std::size_t size() const { return size_; }

 private:
  std::vector<Cell> cells_;
  std::unordered_map<PortId, std::uint32_t, PortIdHash> offsets_;
  std::size_t size_ = 0;
};

}  // namespace flinch
