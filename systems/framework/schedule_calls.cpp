// The second half of Scheduler: a checked, ordered diagram becomes lists of calls.
#include <algorithm>

#include "systems/framework/scheduler.h"

namespace flinch {

namespace {

const System::StateVariable& variable(PortId state) {
  return state.owner->states()[static_cast<std::size_t>(state.index)];
}

}  // namespace

void Scheduler::find_kept_outputs() {
  const Every tick{root_.tick(), Time::zero()};
  for (const Leaf& leaf : leaves_) {
    for (const System::Change& update : leaf.block->updates()) {
      if (update.function != nullptr) continue;
      const PortId kept = source(update.reads.front());
      if (kept.kind != PortId::Kind::output) continue;
      const bool each_tick = update.every.value_or(tick) == tick;
      const bool follows = each_tick || !is_held(nodes_[node_of_.at(kept)]);
      if (follows) kept_.try_emplace(kept, Kept{update.state, {}});  // the first one
    }
  }
  for (const Node& node : nodes_) {
    if (is_held(node)) kept_.try_emplace(node.port, Kept{});
  }
}

void Scheduler::lay_out() {
  find_kept_outputs();
  lay_out_inputs();
  lay_out_outputs();
  lay_out_states();
  for (const auto& [block, unused] : paths_) {
    for (std::size_t i = 0; i < block->inputs().size(); ++i) {
      const PortId port{block, PortId::Kind::input, static_cast<int>(i)};
      if (block != &root_) root_.layout_.put(port, root_.layout_.place(source(port)));
    }
    for (std::size_t i = 0; i < block->outputs().size(); ++i) {
      const PortId port{block, PortId::Kind::output, static_cast<int>(i)};
      if (!root_.layout_.contains(port)) root_.layout_.put(port, root_.layout_.place(source(port)));
    }
  }
}

void Scheduler::lay_out_inputs() {
  Layout& layout = root_.layout_;
  for (std::size_t i = 0; i < root_.inputs().size(); ++i) {
    const ValueType& type = *root_.inputs()[i].type;
    layout.put({&root_, PortId::Kind::input, static_cast<int>(i)},
               Place::fixed(layout.add(type, make_value(type))));
  }
}

// In the order of computation: neighbours in time are neighbours in memory.
void Scheduler::lay_out_outputs() {
  Layout& layout = root_.layout_;
  for (const std::size_t node : order_) {
    const PortId port = nodes_[node].port;
    const ValueType& type = *output_of(nodes_[node]).type;
    const auto kept = kept_.find(port);
    if (kept == kept_.end()) {
      layout.put(port, Place::fixed(layout.add(type, make_value(type))));
    } else {
      auto& [state, turns] = kept->second;
      turns = layout.add_turns(type, state ? variable(*state).initial : make_value(type), make_value(type));
      layout.put(port, Place::moving(turns.next));
      if (!state) continue;
      layout.put(*state, Place::moving(turns.now));
      root_.state_cells_.push_back({*state, &type, Place::moving(turns.now), std::nullopt, turns});
    }
  }
}

void Scheduler::lay_out_states() {
  for (const Leaf& leaf : leaves_) {
    for (const System::Change& update : leaf.block->updates()) {
      if (update.function != nullptr) lay_out_state(update.state, is_read_by_updates(update.state));
      if (update.function == nullptr && !root_.layout_.contains(update.state))
        lay_out_state(update.state, false);
    }
    for (const System::Change& derivative : leaf.block->derivatives()) lay_out_state(derivative.state, true);
  }
}

// All that is due is written at once. What no update reads, not even its own, can as well be written where it
// lies: so a long history is not copied at each tick.
bool Scheduler::is_read_by_updates(PortId state) const {
  return std::any_of(leaves_.begin(), leaves_.end(), [&](const Leaf& leaf) {
    const auto& updates = leaf.block->updates();
    return std::any_of(updates.begin(), updates.end(), [&](const System::Change& update) {
      return std::any_of(update.reads.begin(), update.reads.end(),
                         [&](const PortId& read) { return source(read) == state; });
    });
  });
}

void Scheduler::lay_out_state(PortId port, bool is_computed) {
  const System::StateVariable& state = variable(port);
  const auto add = [&] { return Place::fixed(root_.layout_.add(*state.type, state.initial)); };
  const Place now = add();
  const std::optional<Place> next = is_computed ? std::optional(add()) : std::nullopt;
  root_.layout_.put(port, now);
  root_.state_cells_.push_back({port, state.type, now, next, std::nullopt});
}

Diagram::Call Scheduler::make_call(const System& block, BlockFunction function,
                                   const std::vector<PortId>& reads, Place result) {
  const auto first = static_cast<std::uint32_t>(root_.places_.size());
  for (const PortId& read : reads) root_.places_.push_back(root_.layout_.place(source(read)));
  root_.places_.push_back(result);
  return {&block, function, first};
}

void Scheduler::add_line(const std::string& what, const std::vector<PortId>& reads,
                         const std::string& target) {
  std::string line = what + " " + target + "  <- ";
  for (const PortId& read : reads) line += (line.ends_with("<- ") ? "" : ", ") + path(source(read));
  root_.schedule_lines_.push_back(line);
}

void Scheduler::add_outputs() {
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const Node& node = nodes_[order_[i]];
    const System::Output& output = output_of(node);
    root_.outputs_in_order_.push_back(
        make_call(*node.port.owner, output.function, output.reads, root_.layout_.place(node.port)));
    add_line("output    ", output.reads, path(node.port) + describe(node.occasion));
    const auto kept = kept_.find(node.port);
    if (is_held(node)) {
      const bool goes_on = i > 0 && nodes_[order_[i - 1]].occasion == node.occasion;
      if (!goes_on) hold_from(i, node.occasion);
      root_.held_outputs_.back().end = i + 1;
      root_.held_outputs_.back().turns.push_back(kept->second.turns);
    } else if (kept != kept_.end()) {
      root_.kept_outputs_.push_back(kept->second.turns);
    }
  }
}

void Scheduler::hold_from(std::size_t call, const System::Occasion& occasion) {
  const Place when = occasion.when ? root_.layout_.place(*occasion.when) : Place();
  const auto computed = Place::fixed(root_.layout_.add(value_type<bool>, make_value(value_type<bool>)));
  root_.held_outputs_.push_back({occasion.every, when, call, call, computed, {}});
}

std::string Scheduler::describe(const System::Occasion& occasion) const {
  if (occasion.when) return "  when " + path(*occasion.when);
  if (occasion.every) return "  every " + std::to_string(occasion.every->period.count()) + " ns";
  return "";
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
      if (group == groups.end()) group = groups.insert(groups.end(), {every, {}, {}, {}});
      const Diagram::StateCell cell = cell_of(update.state);
      if (update.function != nullptr) {
        group->calls.push_back(
            make_call(*leaf.block, update.function, update.reads, cell.next.value_or(cell.now)));
        if (cell.next) group->copies.push_back({cell.type, *cell.next, cell.now});
      } else if (cell.turns) {
        group->kept.push_back(*cell.turns);
      } else {
        group->copies.push_back({cell.type, root_.layout_.place(source(update.reads.front())), cell.now});
      }
      add_line(update.function != nullptr ? "update    " : "keep      ", update.reads, path(update.state));
    }
    for (const System::Change& derivative : leaf.block->derivatives()) {
      const Diagram::StateCell cell = cell_of(derivative.state);
      root_.derivative_calls_.push_back(
          make_call(*leaf.block, derivative.function, derivative.reads, *cell.next));
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
    node.varies_in_step = !is_held(node) && (reads_varying(output_of(node).reads) ||
                                             std::any_of(node.reads.begin(), node.reads.end(), varies));
  }
  for (const Leaf& leaf : leaves_) {
    for (const System::Change& derivative : leaf.block->derivatives()) {
      for (const std::size_t read : nodes_read(derivative.reads)) nodes_[read].needed_in_step = true;
    }
  }
  for (auto index = order_.rbegin(); index != order_.rend(); ++index) {
    if (!nodes_[*index].needed_in_step || is_held(nodes_[*index])) continue;
    for (const std::size_t read : nodes_[*index].reads) nodes_[read].needed_in_step = true;
  }
}

void Scheduler::add_continuous() {
  mark_step_nodes();
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const Node& node = nodes_[order_[i]];
    if (!node.needed_in_step || is_held(node)) continue;
    (node.varies_in_step ? root_.varying_in_step_ : root_.constant_in_step_)
        .push_back(root_.outputs_in_order_[i]);
    const auto kept = kept_.find(node.port);
    if (kept != kept_.end()) root_.kept_in_step_.push_back(kept->second.turns);
  }
  for (const Diagram::StateCell& cell : root_.continuous_cells_) {
    const System::StateVariable& state =
        cell.state.owner->states()[static_cast<std::size_t>(cell.state.index)];
    root_.continuous_size_ += cell.type->numbers(const_cast<void*>(state.initial.get())).size();
  }
}

}  // namespace flinch
