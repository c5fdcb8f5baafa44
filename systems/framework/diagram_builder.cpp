#include "systems/framework/diagram_builder.h"

#include <algorithm>
#include <set>

#include "systems/foundation/setup_error.h"
#include "systems/framework/scheduler.h"

namespace flinch {

DiagramBuilder::DiagramBuilder(std::string name, Time tick) : diagram_(new Diagram) {
  diagram_->name_ = std::move(name);
  diagram_->tick_ = tick;
  if (tick <= Time::zero()) problems_.push_back(diagram_->name_ + ": the tick must be longer than 0 ns");
}

Diagram& DiagramBuilder::add(std::unique_ptr<Diagram> diagram) {
  Diagram& reference = *diagram;
  std::string name = diagram->name();
  add_child(std::move(name), std::move(diagram));
  return reference;
}

void DiagramBuilder::add_child(std::string name, std::unique_ptr<System> block) {
  if (name.empty() || name.find('/') != std::string::npos) {
    problems_.push_back(diagram_->name_ + ": the block name '" + name + "' must not be empty or contain '/'");
  }
  block->name_ = std::move(name);
  diagram_->children_.push_back(std::move(block));
}

bool DiagramBuilder::is_child(const System* block) const {
  return std::any_of(diagram_->children_.begin(), diagram_->children_.end(),
                     [block](const auto& child) { return child.get() == block; });
}

std::string DiagramBuilder::path(PortId port) const {
  const std::string own = diagram_->name_ + "/";
  if (port.owner == diagram_.get()) return own + port.owner->port_name(port);
  return own + port.owner->name() + "/" + port.owner->port_name(port);
}

PortId DiagramBuilder::add_export(std::string_view name, const ValueType& type, PortId inner) {
  diagram_->outputs_.push_back({std::string(name), &type, nullptr, {inner}, false, {}});
  return {diagram_.get(), PortId::Kind::output, static_cast<int>(diagram_->outputs_.size()) - 1};
}

void DiagramBuilder::add_wire(PortId from, PortId to) {
  const bool from_inside = is_child(from.owner) && from.kind == PortId::Kind::output;
  const bool from_outside = from.owner == diagram_.get() && from.kind == PortId::Kind::input;
  if (!from_inside && !from_outside) {
    problems_.push_back(path(from) + " is connected to " + path(to) +
                        ", but is no output of a block directly in '" + diagram_->name_ +
                        "' and no input of it; export it from its diagram");
    return;
  }
  if (!is_child(to.owner)) {
    problems_.push_back(path(from) + " is connected to " + path(to) + ", which is not in '" +
                        diagram_->name_ + "'; export it from its diagram");
    return;
  }
  for (const Diagram::Wire& wire : diagram_->wires_) {
    if (wire.to == to) {
      problems_.push_back(path(to) + " is connected twice: to " + path(wire.from) + " and to " + path(from));
      return;
    }
  }
  diagram_->wires_.push_back({from, to});
}

bool DiagramBuilder::is_wired(PortId to) const {
  return std::any_of(diagram_->wires_.begin(), diagram_->wires_.end(),
                     [&to](const Diagram::Wire& wire) { return wire.to == to; });
}

void DiagramBuilder::feed_open_inputs() {
  const std::size_t children = diagram_->children_.size();
  for (std::size_t i = 0; i < children; ++i) {
    const System& child = *diagram_->children_[i];
    for (std::size_t k = 0; k < child.inputs_.size(); ++k) {
      const System::Input& input = child.inputs_[k];
      const PortId to{&child, PortId::Kind::input, static_cast<int>(k)};
      if (input.stand_in == nullptr || is_wired(to)) continue;
      std::unique_ptr<System> constant = input.stand_in();
      const PortId from{constant.get(), PortId::Kind::output, 0};
      add_child(child.name_ + "_no_" + input.name, std::move(constant));
      add_wire(from, to);
    }
  }
}

void DiagramBuilder::find_unconnected(std::vector<std::string>& problems) const {
  for (const auto& child : diagram_->children_) {
    for (std::size_t i = 0; i < child->inputs_.size(); ++i) {
      const PortId input{child.get(), PortId::Kind::input, static_cast<int>(i)};
      if (!is_wired(input)) problems.push_back(path(input) + " is not connected");
    }
  }
}

void DiagramBuilder::find_duplicates(std::vector<std::string>& problems) const {
  const auto check = [&problems](const std::string& where, const auto& named, const char* what,
                                 const auto& name_of) {
    std::set<std::string> seen;
    for (const auto& each : named) {
      if (!seen.insert(name_of(each)).second) {
        problems.push_back(where + "/" + name_of(each) + ": two " + what + " have this name");
      }
    }
  };
  const auto by_member = [](const auto& each) { return each.name; };
  check(diagram_->name_, diagram_->children_, "blocks", [](const auto& child) { return child->name_; });
  check(diagram_->name_, diagram_->inputs_, "inputs", by_member);
  check(diagram_->name_, diagram_->outputs_, "outputs", by_member);
  for (const auto& child : diagram_->children_) {
    const std::string where = diagram_->name_ + "/" + child->name_;
    check(where, child->inputs_, "inputs", by_member);
    check(where, child->outputs_, "outputs", by_member);
    check(where, child->states_, "states", by_member);
  }
}

void DiagramBuilder::find_foreign_exports(std::vector<std::string>& problems) const {
  for (const System::Output& output : diagram_->outputs_) {
    if (!is_child(output.reads.front().owner)) {
      problems.push_back(diagram_->name_ + "/" + output.name +
                         " exports a port of a block that is not directly in '" + diagram_->name_ + "'");
    }
  }
}

std::unique_ptr<Diagram> DiagramBuilder::build() {
  feed_open_inputs();
  std::vector<std::string> problems = std::move(problems_);
  find_duplicates(problems);
  find_unconnected(problems);
  find_foreign_exports(problems);
  if (diagram_->tick_ > Time::zero()) Scheduler(*diagram_).check_and_schedule(problems);
  throw_if_any(std::move(problems));
  return std::move(diagram_);
}

}  // namespace flinch
