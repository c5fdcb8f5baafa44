// The second half of Scheduler: a checked, ordered diagram becomes lists of calls.
#include <algorithm>

#include "systems/framework/scheduler.h"

namespace flinch {

void Scheduler::lay_out() {
  Layout& layout = root_.layout_;
  for (std::size_t i = 0; i < root_.inputs().size(); ++i) {
    const System::Input& input = root_.inputs()[i];
    layout.add({&root_, PortId::Kind::input, static_cast<int>(i)}, *input.type, input.type->make_default());
  }
  for (const std::size_t node :
       order_) {  // in the order of computation: neighbours in time are neighbours in memory
    const System::Output& output = output_of(nodes_[node]);
    layout.add(nodes_[node].port, *output.type, output.type->make_default());
  }
  for (const Leaf& leaf : leaves_) {
    for (std::size_t i = 0; i < leaf.block->states().size(); ++i) {
      const System::StateVariable& state = leaf.block->states()[i];
      const PortId port{leaf.block, PortId::Kind::state, static_cast<int>(i)};
      const std::uint32_t current = layout.add(port, *state.type, state.initial);
      const std::uint32_t next = layout.add(*state.type, state.initial);
      root_.state_cells_.push_back({port, state.type, current, next});
    }
  }
  for (const auto& [block, unused] : paths_) {
    for (std::size_t i = 0; i < block->inputs().size(); ++i) {
      const PortId port{block, PortId::Kind::input, static_cast<int>(i)};
      if (block != &root_) layout.alias(port, layout.offset(source(port)));
    }
    for (std::size_t i = 0; i < block->outputs().size(); ++i) {
      const PortId port{block, PortId::Kind::output, static_cast<int>(i)};
      if (!layout.contains(port)) layout.alias(port, layout.offset(source(port)));
    }
  }
}

Diagram::Call Scheduler::make_call(const System& block, BlockFunction function,
                                   const std::vector<PortId>& reads, std::uint32_t result) {
  const auto first = static_cast<std::uint32_t>(root_.offsets_.size());
  for (const PortId& read : reads) root_.offsets_.push_back(root_.layout_.offset(source(read)));
  root_.offsets_.push_back(result);
  return {&block, function, first};
}

void Scheduler::add_line(const std::string& what, const std::vector<PortId>& reads,
                         const std::string& target) {
  std::string line = what + " " + target + "  <- ";
  for (const PortId& read : reads) line += (line.ends_with("<- ") ? "" : ", ") + path(source(read));
  root_.schedule_lines_.push_back(line);
}

void Scheduler::add_outputs() {
  for (const std::size_t node : order_) {
    const PortId port = nodes_[node].port;
    const System::Output& output = output_of(nodes_[node]);
    root_.outputs_in_order_.push_back(
        make_call(*port.owner, output.function, output.reads, root_.layout_.offset(port)));
    add_line("output    ", output.reads, path(port));
  }
}

void Scheduler::add_updates() {
  const auto cell_of = [this](PortId state) {
    return *std::find_if(root_.state_cells_.begin(), root_.state_cells_.end(),
                         [state](const Diagram::StateCell& cell) { return cell.state == state; });
  };
  for (const Leaf& leaf : leaves_) {
    for (const System::Change& update : leaf.block->updates()) {
      const Every every = update.every.value_or(Every{root_.tick(), Time::zero()});
      auto& groups = root_.update_groups_;
      auto group =
          std::find_if(groups.begin(), groups.end(), [&](const auto& each) { return each.every == every; });
      if (group == groups.end()) group = groups.insert(groups.end(), {every, {}, {}});
      const Diagram::StateCell cell = cell_of(update.state);
      group->calls.push_back(make_call(*leaf.block, update.function, update.reads, cell.next));
      group->written.push_back(cell);
      add_line("update    ", update.reads, path(update.state));
    }
    for (const System::Change& derivative : leaf.block->derivatives()) {
      const Diagram::StateCell cell = cell_of(derivative.state);
      root_.derivative_calls_.push_back(
          make_call(*leaf.block, derivative.function, derivative.reads, cell.next));
      root_.continuous_cells_.push_back(cell);
      add_line("derivative", derivative.reads, path(derivative.state));
    }
  }
}

bool Scheduler::reads_varying(const std::vector<PortId>& reads) const {
  return std::any_of(reads.begin(), reads.end(), [this](const PortId& read) {
    if (read.kind == PortId::Kind::clock) return true;
    return std::any_of(root_.continuous_cells_.begin(), root_.continuous_cells_.end(),
                       [&read](const Diagram::StateCell& cell) { return cell.state == read; });
  });
}

void Scheduler::mark_step_nodes() {
  for (const std::size_t index : order_) {
    Node& node = nodes_[index];
    const auto varies = [this](std::size_t read) { return nodes_[read].varies_in_step; };
    node.varies_in_step =
        reads_varying(output_of(node).reads) || std::any_of(node.reads.begin(), node.reads.end(), varies);
  }
  for (const Leaf& leaf : leaves_) {
    for (const System::Change& derivative : leaf.block->derivatives()) {
      for (const std::size_t read : nodes_read(derivative.reads)) nodes_[read].needed_in_step = true;
    }
  }
  for (auto index = order_.rbegin(); index != order_.rend(); ++index) {
    if (!nodes_[*index].needed_in_step) continue;
    for (const std::size_t read : nodes_[*index].reads) nodes_[read].needed_in_step = true;
  }
}

void Scheduler::add_continuous() {
  mark_step_nodes();
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const Node& node = nodes_[order_[i]];
    if (!node.needed_in_step) continue;
    (node.varies_in_step ? root_.varying_in_step_ : root_.constant_in_step_)
        .push_back(root_.outputs_in_order_[i]);
  }
  for (const Diagram::StateCell& cell : root_.continuous_cells_) {
    const System::StateVariable& state =
        cell.state.owner->states()[static_cast<std::size_t>(cell.state.index)];
    root_.continuous_size_ += cell.type->numbers(const_cast<void*>(state.initial.get())).size();
  }
}

}  // namespace flinch
