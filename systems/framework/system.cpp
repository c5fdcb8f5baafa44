#include "systems/framework/system.h"

#include "systems/foundation/setup_error.h"

namespace flinch {

const std::string& System::port_name(PortId port) const {
  static const std::string clock_name = "clock";
  const auto index = static_cast<std::size_t>(port.index);
  switch (port.kind) {
    case PortId::Kind::input:
      return inputs_.at(index).name;
    case PortId::Kind::output:
      return outputs_.at(index).name;
    case PortId::Kind::state:
      return states_.at(index).name;
    default:
      break;
  }
  return clock_name;
}

bool System::declared(PortId port) const {
  if (port.kind == PortId::Kind::clock) return port.owner == nullptr;
  if (port.owner != this || port.index < 0) return false;
  const auto index = static_cast<std::size_t>(port.index);
  switch (port.kind) {
    case PortId::Kind::input:
      return index < inputs_.size();
    case PortId::Kind::output:
      return index < outputs_.size();
    case PortId::Kind::state:
      return index < states_.size();
    default:
      return false;
  }
}

std::vector<PortId> System::own(PortIds ports) const {
  for (const PortId& port : ports) {
    if (!declared(port)) {
      throw SetupError(std::string("a function of block type ") + typeid(*this).name() +
                       " reads or writes a port or state that is declared below it or in another block; "
                       "declare ports and states above the functions that name them");
    }
  }
  return ports;
}

void System::refuse_function_of(const std::type_info& other) const {
  throw SetupError(std::string("block type ") + typeid(*this).name() + " declares a function of block type " +
                   other.name() + "; name functions of the block itself");
}

PortId System::add_input(std::string_view name, const ValueType& type) {
  inputs_.push_back({std::string(name), &type});
  return {this, PortId::Kind::input, static_cast<int>(inputs_.size()) - 1};
}

PortId System::add_state(std::string_view name, const ValueType& type, const void* initial) {
  states_.push_back({std::string(name), &type, make_value(type, initial)});
  return {this, PortId::Kind::state, static_cast<int>(states_.size()) - 1};
}

PortId System::add_output(std::string_view name, const ValueType& type, BlockFunction function, PortIds reads,
                          bool intermediate, const Occasion& occasion) {
  if (occasion.when) own({*occasion.when});
  outputs_.push_back({std::string(name), &type, function, own(reads), intermediate, occasion});
  return {this, PortId::Kind::output, static_cast<int>(outputs_.size()) - 1};
}

Update System::add_update(PortId written, BlockFunction function, PortIds reads,
                          const std::optional<Every>& every) {
  own({written});
  updates_.push_back({written, function, own(reads), every});
  return {};
}

Update System::add_keep(const std::optional<Every>& every, PortId state, PortId kept) {
  return add_update(state, nullptr, {kept}, every);
}

Derivative System::add_derivative(PortId integrated, BlockFunction function, PortIds reads) {
  own({integrated});
  derivatives_.push_back({integrated, function, own(reads), std::nullopt});
  return {};
}

}  // namespace flinch
