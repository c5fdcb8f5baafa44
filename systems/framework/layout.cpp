#include "systems/framework/layout.h"

#include <limits>
#include <stdexcept>

namespace flinch {

Layout::Layout() { add(PortId{}, value_type<Time>, value_type<Time>.make_default()); }

std::uint32_t Layout::add(const ValueType& type, std::shared_ptr<const void> initial) {
  const std::size_t offset = (size_ + type.alignment - 1) / type.alignment * type.alignment;
  size_ = offset + type.size;
  if (size_ > std::numeric_limits<std::uint32_t>::max())
    throw std::length_error("a diagram holds more than 4 GiB");
  cells_.push_back({static_cast<std::uint32_t>(offset), &type, std::move(initial)});
  return cells_.back().offset;
}

std::uint32_t Layout::add(PortId port, const ValueType& type, std::shared_ptr<const void> initial) {
  return offsets_[port] = add(type, std::move(initial));
}

}  // namespace flinch
