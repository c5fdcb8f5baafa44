#include "systems/framework/value_type.h"

#include <utility>

namespace flinch {
namespace {

struct Free {
  std::align_val_t alignment;
  void operator()(void* memory) const { ::operator delete(memory, alignment); }
};
using Memory = std::unique_ptr<void, Free>;

Memory memory_for(const ValueType& type) {
  const std::align_val_t alignment{type.alignment};
  return {::operator new(type.size, alignment), Free{alignment}};
}

std::shared_ptr<const void> owner_of(Memory value, const ValueType& type) {
  return {value.release(), [&type](void* owned) {
            type.destroy(owned);
            Free{std::align_val_t{type.alignment}}(owned);
          }};
}

}  // namespace

std::shared_ptr<const void> make_value(const ValueType& type) {
  Memory memory = memory_for(type);
  type.construct(memory.get());
  return owner_of(std::move(memory), type);
}

std::shared_ptr<const void> make_value(const ValueType& type, const void* value) {
  Memory memory = memory_for(type);
  type.copy_construct(memory.get(), value);
  return owner_of(std::move(memory), type);
}

}  // namespace flinch
