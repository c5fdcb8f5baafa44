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

std::vector<PortId> System::own(std::vector<PortId> ports) const {
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

Update System::add_keep(std::optional<Every> every, PortId state, PortId kept) {
  updates_.push_back({own({state}).front(), nullptr, own({kept}), every});
  return {};
}

}  // namespace flinch
