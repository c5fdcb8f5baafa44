#include "systems/framework/layout.h"

#include <stdexcept>

namespace flinch {

Layout::Layout() {
  add(value_type<Time>, make_value(value_type<Time>));
  add(value_type<Time>, std::make_shared<const Time>(never));
  put(Clock().id, time);
}

std::uint32_t Layout::add(const ValueType& type, std::shared_ptr<const void> initial) {
  const std::size_t offset = (size_ + type.alignment - 1) / type.alignment * type.alignment;
  size_ = offset + type.size;
  if (size_ > Place::limit) throw std::length_error("a diagram holds more than 2 GiB");
  cells_.push_back({static_cast<std::uint32_t>(offset), &type, std::move(initial)});
  return cells_.back().offset;
}

DoubleBuffer Layout::add_turns(const ValueType& type, std::shared_ptr<const void> now,
                               std::shared_ptr<const void> next) {
  const std::uint32_t one = add(type, std::move(now));
  const std::uint32_t other = add(type, std::move(next));
  const auto add_word = [this](std::uint32_t offset) {
    return add(value_type<std::uint32_t>, std::make_shared<const std::uint32_t>(offset));
  };
  return {.now = add_word(one), .next = add_word(other), .cells = one + other};
}

}  // namespace flinch
