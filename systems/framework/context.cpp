#include "systems/framework/context.h"

#include <cassert>
#include <new>
#include <utility>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram.h"
#include "systems/framework/layout.h"

namespace flinch {
namespace {

std::byte* allocate(std::size_t size) {
  return static_cast<std::byte*>(::operator new (size, std::align_val_t{Layout::alignment}));
}

}  // namespace

void Context::FreeMemory::operator()(std::byte* memory) const {
  ::operator delete (memory, std::align_val_t{Layout::alignment});
}

Context::Context(const Diagram& diagram) : diagram_(&diagram), memory_(allocate(diagram.layout().size())) {
  for (const Layout::Cell& cell : diagram.layout().cells()) {
    cell.type->copy_construct(memory_.get() + cell.offset, cell.initial.get());
  }
}

Context::Context(const Context& other)
    : diagram_(other.diagram_), memory_(allocate(diagram_->layout().size())) {
  for (const Layout::Cell& cell : diagram_->layout().cells()) {
    cell.type->copy_construct(memory_.get() + cell.offset, other.memory_.get() + cell.offset);
  }
}

Context::Context(Context&& other) noexcept = default;

Context& Context::operator=(const Context& other) {
  if (this == &other) return *this;
  if (diagram_ != other.diagram_ || !memory_) return *this = Context(other);
  for (const Layout::Cell& cell : diagram_->layout().cells()) {
    cell.type->copy_assign(memory_.get() + cell.offset, other.memory_.get() + cell.offset);
  }
  return *this;
}

Context& Context::operator=(Context&& other) noexcept {
  std::swap(diagram_, other.diagram_);
  std::swap(memory_, other.memory_);
  return *this;
}

Context::~Context() { destroy_values(); }

bool Context::at_first_tick() const { return last_update() == Layout::never; }

bool Context::due(const Every& every) const {
  return every.due(time(), at_first_tick() ? Time::zero() : time() - last_update());
}

Time Context::last_update() const { return *reinterpret_cast<const Time*>(Layout::last_update.in(memory())); }

void Context::complete_tick() { *reinterpret_cast<Time*>(Layout::last_update.in(memory())) = time(); }

void Context::destroy_values() {
  if (!memory_) return;
  for (const Layout::Cell& cell : diagram_->layout().cells()) cell.type->destroy(memory_.get() + cell.offset);
}

Place Context::place_of(PortId port) const { return diagram_->place(port); }

Place Context::place_of_external(PortId port) const {
  if (port.owner != diagram_ || port.kind != PortId::Kind::input) {
    throw SetupError("only the inputs of the diagram '" + diagram_->name() +
                     "' itself can be set from outside");
  }
  return diagram_->place(port);
}

void Context::set_state(PortId state, const void* value) {
  for (const Diagram::StateCell& cell : diagram_->state_cells()) {
    if (cell.state != state) continue;
    if (cell.turns) cell.turns->part(memory());
    cell.type->copy_assign(cell.now.in(memory()), value);
    if (cell.next) cell.type->copy_assign(cell.next->in(memory()), value);
    return;
  }
  throw SetupError("the diagram '" + diagram_->name() + "' has no such state");
}

}  // namespace flinch
