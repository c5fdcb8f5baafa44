#include "systems/framework/scheduler.h"

#include <algorithm>

namespace flinch {

void Scheduler::check_and_schedule(std::vector<std::string>& problems) {
  collect(root_, root_.name());
  make_nodes();
  find_loops(problems);
  check_periods(problems);
  check_states(problems);
  if (!problems.empty()) return;
  hold_what_follows();
  lay_out();
  add_outputs();
  add_updates();
  add_continuous();
}

void Scheduler::collect(const Diagram& diagram, const std::string& path) {
  paths_[&diagram] = path;
  for (const Diagram::Wire& wire : diagram.wires()) wired_to_[wire.to] = wire.from;
  for (const auto& child : diagram.children()) {
    const std::string child_path = path + "/" + child->name();
    if (const auto* nested = dynamic_cast<const Diagram*>(child.get())) {
      collect(*nested, child_path);
    } else {
      paths_[child.get()] = child_path;
      leaves_.push_back({child.get(), child_path});
    }
  }
}

void Scheduler::make_nodes() {
  for (const Leaf& leaf : leaves_) {
    for (std::size_t i = 0; i < leaf.block->outputs().size(); ++i) {
      const PortId port{leaf.block, PortId::Kind::output, static_cast<int>(i)};
      node_of_[port] = nodes_.size();
      nodes_.push_back({port, {}, leaf.block->outputs()[i].occasion});
    }
  }
  for (Node& node : nodes_) {
    if (node.occasion.when) node.occasion.when = source(*node.occasion.when);
    node.reads = nodes_read(needed_by(output_of(node)));
  }
}

std::vector<PortId> Scheduler::needed_by(const System::Output& output) {
  std::vector<PortId> needed = output.reads;
  if (output.occasion.when) needed.push_back(*output.occasion.when);
  return needed;
}

// What reads nothing but values that are held on one occasion would compute the same in between: it is held
// as well.
void Scheduler::hold_what_follows() {
  for (const std::size_t node : order_) {
    if (is_held(nodes_[node])) continue;
    nodes_[node].occasion = common_occasion(output_of(nodes_[node]).reads).value_or(System::Occasion());
  }
}

std::optional<System::Occasion> Scheduler::common_occasion(const std::vector<PortId>& reads) const {
  std::optional<System::Occasion> common;
  for (const PortId& read : reads) {
    const auto node = node_of_.find(source(read));
    if (node == node_of_.end()) return std::nullopt;  // a state, an input of the diagram or the clock
    const Node& read_node = nodes_[node->second];
    if (output_of(read_node).reads.empty() && !is_held(read_node)) continue;  // a constant
    if (common && *common != read_node.occasion) return std::nullopt;
    common = read_node.occasion;
  }
  return common;
}

PortId Scheduler::source(PortId port) const {
  while (true) {
    if (port.kind == PortId::Kind::input) {
      const auto wire = wired_to_.find(port);
      if (wire == wired_to_.end()) return port;
      port = wire->second;
    } else if (port.kind == PortId::Kind::output && dynamic_cast<const Diagram*>(port.owner) != nullptr) {
      port = port.owner->outputs()[static_cast<std::size_t>(port.index)].reads.front();
    } else {
      return port;
    }
  }
}

std::vector<std::size_t> Scheduler::nodes_read(const std::vector<PortId>& reads) const {
  std::vector<std::size_t> nodes;
  for (const PortId& read : reads) {
    const auto node = node_of_.find(source(read));
    if (node != node_of_.end()) nodes.push_back(node->second);
  }
  return nodes;
}

std::string Scheduler::path(PortId port) const {
  if (port.kind == PortId::Kind::clock) return "clock";
  return paths_.at(port.owner) + "/" + port.owner->port_name(port);
}

void Scheduler::find_loops(std::vector<std::string>& problems) {
  std::vector<bool> placed(nodes_.size(), false);
  const auto ready = [&](std::size_t node) {
    return std::all_of(nodes_[node].reads.begin(), nodes_[node].reads.end(),
                       [&](std::size_t read) { return placed[read]; });
  };
  for (bool progress = true; progress;) {
    progress = false;
    for (std::size_t node = 0; node < nodes_.size(); ++node) {
      if (placed[node] || !ready(node)) continue;
      placed[node] = progress = true;
      order_.push_back(node);
    }
  }
  std::vector<bool> reported(nodes_.size(), false);
  for (std::size_t node = 0; node < nodes_.size(); ++node) {
    if (placed[node] || reported[node]) continue;
    const std::vector<std::size_t> cycle = cycle_through(node, placed);
    const bool known =
        std::any_of(cycle.begin(), cycle.end(), [&](std::size_t member) { return reported[member]; });
    reported[node] = true;
    for (const std::size_t member : cycle) reported[member] = true;
    if (!known) problems.push_back(describe_cycle(cycle));
  }
}

std::vector<std::size_t> Scheduler::cycle_through(std::size_t start, const std::vector<bool>& placed) const {
  // Every node that could not be placed reads another such node: walking from reader to read must come round.
  std::vector<std::size_t> walk{start};
  while (true) {
    const std::vector<std::size_t>& reads = nodes_[walk.back()].reads;
    const std::size_t next =
        *std::find_if(reads.begin(), reads.end(), [&](std::size_t read) { return !placed[read]; });
    const auto seen = std::find(walk.begin(), walk.end(), next);
    if (seen != walk.end()) {
      std::vector<std::size_t> cycle(seen, walk.end());
      std::reverse(cycle.begin(), cycle.end());
      return cycle;
    }
    walk.push_back(next);
  }
}

std::string Scheduler::describe_cycle(const std::vector<std::size_t>& cycle) const {
  std::string text = "algebraic loop: " + path(nodes_[cycle.front()].port);
  for (std::size_t i = 0; i < cycle.size(); ++i) {
    const Node& reader = nodes_[cycle[(i + 1) % cycle.size()]];
    for (const PortId& read : needed_by(output_of(reader))) {
      if (source(read) != nodes_[cycle[i]].port) continue;
      if (read.kind == PortId::Kind::input) text += " -> " + path(read);
      break;
    }
    text += " -> " + path(reader.port);
  }
  return text + "; let one of these outputs read a state instead of an input";
}

void Scheduler::check_periods(std::vector<std::string>& problems) const {
  for (const Leaf& leaf : leaves_) {
    for (const System::Output& output : leaf.block->outputs()) {
      const std::string who = "the output " + leaf.path + "/" + output.name;
      if (output.occasion.every) check_period(*output.occasion.every, who, problems);
    }
    for (const System::Change& update : leaf.block->updates()) {
      if (update.every) check_period(*update.every, "the update of " + path(update.state), problems);
    }
  }
}

void Scheduler::check_period(const Every& every, const std::string& who,
                             std::vector<std::string>& problems) const {
  const auto nanoseconds = [](Time time) { return std::to_string(time.count()) + " ns"; };
  const std::string but = ", which is no multiple of the tick, " + nanoseconds(root_.tick());
  if (every.period <= Time::zero() || every.period % root_.tick() != Time::zero()) {
    problems.push_back(who + " has the period " + nanoseconds(every.period) + but);
  }
  if (every.offset < Time::zero() || every.offset % root_.tick() != Time::zero()) {
    problems.push_back(who + " has the offset " + nanoseconds(every.offset) + but);
  }
}

void Scheduler::check_states(std::vector<std::string>& problems) const {
  for (const Leaf& leaf : leaves_) {
    std::vector<int> writers(leaf.block->states().size(), 0);
    for (const System::Change& change : leaf.block->updates())
      ++writers[static_cast<std::size_t>(change.state.index)];
    for (const System::Change& change : leaf.block->derivatives())
      ++writers[static_cast<std::size_t>(change.state.index)];
    for (std::size_t i = 0; i < writers.size(); ++i) {
      const std::string state = leaf.path + "/" + leaf.block->states()[i].name;
      if (writers[i] > 1)
        problems.push_back("the state " + state + " has more than one update or derivative");
      if (writers[i] == 0) problems.push_back("the state " + state + " has no update and no derivative");
    }
  }
}

}  // namespace flinch
