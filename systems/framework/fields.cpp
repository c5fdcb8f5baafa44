#include "systems/framework/fields.h"

namespace flinch::internal {

std::size_t LayoutBuilder::enter(const char* part) {
  const std::size_t outer = name_.size();
  if (outer > 0) name_ += '.';
  name_ += part;
  return outer;
}

std::size_t LayoutBuilder::enter(std::size_t element) { return enter(std::to_string(element).c_str()); }

void LayoutBuilder::leave(std::size_t entered) { name_.resize(entered); }

void LayoutBuilder::add(Field::Kind kind, int capacity, bool resizable, const char* unit, const char* frame) {
  layout.numbers += static_cast<std::size_t>(capacity) + (resizable ? 2U : 0U);
  layout.fields.push_back({name_.empty() ? "value" : name_, unit, frame, kind, capacity, resizable});
}

}  // namespace flinch::internal
