#include "convert/closure_list.h"

#include "systems/config/config_node.h"
#include "systems/config/parsed.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using Kind = ConfigNode::Kind;

class ClosureReader {
 public:
  ClosureReader(const ConfigNode& root, const std::string& file, BodyGraph& graph)
      : root_(root), file_(file), graph_(graph) {}

  void read() {
    if (root_.kind != Kind::mapping)
      refuse(root_, "must be a mapping with the key closed_loop, a list of pairs of frames");
    const ConfigNode* const pairs = find("closed_loop");
    if (pairs == nullptr) refuse(root_, "has no key closed_loop, a list of pairs of frames");
    const std::vector<std::string> types = words("type");
    require_list(*pairs, "closed_loop");
    if (!types.empty() && types.size() != pairs->items.size()) {
      refuse(*pairs, "closed_loop has " + std::to_string(pairs->items.size()) + " pairs, and type " +
                         std::to_string(types.size()) + " entries");
    }
    for (std::size_t i = 0; i < pairs->items.size(); ++i)
      add(*pairs->items[i], types.empty() ? "6d" : types[i], i);
    if (find("name_mot") != nullptr) graph_.set_driven(words("name_mot"));
    read_zeros();
  }

 private:
  [[noreturn]] void refuse(const ConfigNode& node, const std::string& complaint) const {
    throw SetupError(file_ + ":" + std::to_string(node.line) + ": " + complaint);
  }

  const ConfigNode* find(std::string_view key) const {
    for (const ConfigNode::Entry& entry : root_.entries) {
      if (entry.key == key) return entry.value.get();
    }
    return nullptr;
  }

  void require_list(const ConfigNode& node, const std::string& what) const {
    if (node.kind != Kind::list) refuse(node, what + " must be a list");
  }

  std::vector<std::string> words(std::string_view key) const {
    const ConfigNode* const node = find(key);
    std::vector<std::string> result;
    if (node == nullptr) return result;
    require_list(*node, std::string(key));
    for (const auto& item : node->items) {
      if (item->kind != Kind::scalar) refuse(*item, std::string(key) + " must be a list of words");
      result.push_back(item->scalar);
    }
    return result;
  }

  void read_zeros() {
    const ConfigNode* const zeros = find("zeros");
    if (zeros == nullptr) return;
    if (zeros->kind != Kind::mapping)
      refuse(*zeros, "zeros must be a mapping from joints to their positions");
    for (const ConfigNode::Entry& entry : zeros->entries) {
      const Parsed<double> position = parse_number(*entry.value, {}, any_number);
      if (!position.complaint.empty()) refuse(*entry.value, "zeros." + entry.key + " " + position.complaint);
      try {
        graph_.zeros[graph_.joints[graph_.joint(entry.key)].name] = position.value;
      } catch (const SetupError& error) {
        refuse(*entry.value, error.problems().front());
      }
    }
  }

  // A joint stands for the side of it that moves.
  GraphFrame frame(const ConfigNode& node) const {
    if (node.kind != Kind::scalar) refuse(node, "a pair of closed_loop must be two names");
    for (const GraphJoint& joint : graph_.joints) {
      const bool is_link = std::any_of(graph_.frames.begin(), graph_.frames.end(),
                                       [&](const GraphFrame& one) { return one.name == node.scalar; });
      if (joint.name == node.scalar && !is_link) return {joint.name, joint.child, joint.in_child};
    }
    try {
      return graph_.frame(node.scalar);
    } catch (const SetupError& error) {
      refuse(node, error.problems().front());
    }
  }

  void add(const ConfigNode& pair, const std::string& type, std::size_t index) {
    if (pair.kind != Kind::list || pair.items.size() != 2)
      refuse(pair, "an entry of closed_loop must be a pair of names");
    if (type != "3d" && type != "6d" && type != "3D" && type != "6D")
      refuse(pair, "type is '" + type + "'; it must be 3d, which holds a point, or 6d, which holds a frame");
    const GraphFrame a = frame(*pair.items[0]);
    const GraphFrame b = frame(*pair.items[1]);
    if (a.body == b.body)
      refuse(pair, "'" + a.name + "' and '" + b.name + "' are of one link, so that they close no loop");
    GraphJoint closure;
    closure.name = "closed_loop[" + std::to_string(index) + "]";
    closure.kind = type[0] == '3' ? GraphJoint::Kind::spherical : GraphJoint::Kind::fixed;
    closure.parent = a.body;
    closure.in_parent = a.pose;
    closure.child = b.body;
    closure.in_child = b.pose;
    closure.closes = true;
    graph_.joints.push_back(std::move(closure));
  }

  const ConfigNode& root_;
  const std::string& file_;
  BodyGraph& graph_;
};

}  // namespace

void add_closures(std::string_view text, const std::string& file, BodyGraph& graph) {
  const auto root = parse_yaml(text, file);
  ClosureReader(*root, file, graph).read();
}

}  // namespace flinch
