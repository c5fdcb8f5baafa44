#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "systems/framework/diagram.h"

namespace flinch {

/// Flattens a diagram, with all that is nested in it, into lists of function calls in an order that works.
/// Used by DiagramBuilder::build() only.
class Scheduler {
 public:
  explicit Scheduler(Diagram& root) : root_(root) {}

  /// Appends what is wrong to `problems`; when nothing is, and nothing was, completes the diagram's schedule.
  void check_and_schedule(std::vector<std::string>& problems);

 private:
  struct Leaf {
    const System* block;
    std::string path;
  };
  /// One output of one leaf: a node of the graph of what must run before what.
  struct Node {
    PortId port;
    std::vector<std::size_t> reads;  ///< nodes that must run before
    System::Occasion occasion;       ///< when it is computed; a condition is named by its source
    bool varies_in_step = false;     ///< depends on the time or on a continuous state
    bool needed_in_step = false;     ///< a derivative depends on it
  };

  void collect(const Diagram& diagram, const std::string& path);
  void make_nodes();
  /// The leaf output or input of the root that `port` finally shows; an unconnected input shows itself.
  PortId source(PortId port) const;
  std::vector<std::size_t> nodes_read(const std::vector<PortId>& reads) const;
  std::string path(PortId port) const;

  /// What an output reads, and the condition on which it does.
  static std::vector<PortId> needed_by(const System::Output& output);
  void hold_what_follows();
  std::optional<System::Occasion> common_occasion(const std::vector<PortId>& reads) const;

  void find_loops(std::vector<std::string>& problems);
  std::vector<std::size_t> cycle_through(std::size_t start, const std::vector<bool>& placed) const;
  std::string describe_cycle(const std::vector<std::size_t>& cycle) const;
  void check_periods(std::vector<std::string>& problems) const;
  void check_period(const Every& every, const std::string& who, std::vector<std::string>& problems) const;
  void check_states(std::vector<std::string>& problems) const;

  void lay_out();
  void find_kept_outputs();
  bool is_held(const Node& node) const { return node.occasion != System::Occasion(); }
  void hold_from(std::size_t call, const System::Occasion& occasion);
  std::string describe(const System::Occasion& occasion) const;
  void lay_out_inputs();
  void lay_out_outputs();
  void lay_out_states();
  void lay_out_state(PortId state, bool is_computed);
  bool is_read_by_updates(PortId state) const;
  void add_outputs();
  void add_updates();
  void add_continuous();
  void mark_step_nodes();
  bool reads_varying(const std::vector<PortId>& reads) const;
  Diagram::Call make_call(const System& block, BlockFunction function, const std::vector<PortId>& reads,
                          Place result);
  void add_line(const std::string& what, const std::vector<PortId>& reads, const std::string& target);

  const System::Output& output_of(const Node& node) const {
    return node.port.owner->outputs()[static_cast<std::size_t>(node.port.index)];
  }

  Diagram& root_;
  std::vector<Leaf> leaves_;
  std::unordered_map<const System*, std::string> paths_;
  std::unordered_map<PortId, PortId, PortIdHash> wired_to_;  ///< input -> what it is connected to, one level
  std::vector<Node> nodes_;
  std::unordered_map<PortId, std::size_t, PortIdHash> node_of_;
  std::vector<std::size_t> order_;
  /// Output -> the state that keeps it, or none if it merely holds its value, and where both take turns.
  struct Kept {
    std::optional<PortId> state;
    DoubleBuffer turns;
  };
  std::unordered_map<PortId, Kept, PortIdHash> kept_;
};

}  // namespace flinch
