#include "systems/config/config_node.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using Kind = ConfigNode::Kind;

constexpr std::size_t deepest = 50;         // lists and mappings within one another
constexpr std::size_t most_keys = 1000;     // of one mapping
constexpr std::size_t most_nodes = 50'000;  // aliases counted as what they stand for

/// Builds the nodes of one document from what the parser tells.
class NodeBuilder final : public YAML::EventHandler {
 public:
  explicit NodeBuilder(std::shared_ptr<const std::string> file) : file_(std::move(file)) {}

  std::shared_ptr<const ConfigNode> root() const { return root_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    add(mark, make(Kind::empty, mark, anchor));
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    refuse_zero(mark, value);
    const auto node = make(Kind::scalar, mark, anchor);
    node->scalar = value;
    node->quoted = tag == "!" || tag == "tag:yaml.org,2002:str";
    add(mark, node);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto node = anchored_.at(anchor);
    for (const Open& open : open_) {
      if (open.node == node) throw YAML::ParserException(mark, "an alias inside its own anchor");
    }
    count(mark, *node);
    add(mark, node);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    begin(mark, make(Kind::list, mark, anchor));
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    begin(mark, make(Kind::mapping, mark, anchor));
  }
  void OnSequenceEnd() override { open_.pop_back(); }
  void OnMapEnd() override { open_.pop_back(); }

 private:
  /// A list or mapping whose end has not come yet.
  struct Open {
    std::shared_ptr<ConfigNode> node;
    std::optional<ConfigNode::Entry> entry;  ///< Of a mapping: its key has come, its value has not.
  };

  std::shared_ptr<ConfigNode> make(Kind kind, const YAML::Mark& mark, YAML::anchor_t anchor) {
    auto node = std::make_shared<ConfigNode>();
    node->kind = kind;
    node->file = file_;
    node->line = mark.line + 1;
    count(mark, *node);
    if (anchor != YAML::NullAnchor) anchored_[anchor] = node;
    return node;
  }

  /// What is handed to the system, or to HDF5, would end there.
  void refuse_zero(const YAML::Mark& mark, const std::string& value) const {
    if (value.find('\0') == std::string::npos) return;
    throw SetupError(*file_ + ":" + std::to_string(mark.line + 1) + ": '" +
                     value.substr(0, value.find('\0')) +
                     "' goes on with a character 0, at which names end; leave it out");
  }

  /// Counts a node and all that is in it; what few lines of aliases stand for could fill any memory.
  void count(const YAML::Mark& mark, const ConfigNode& node) {
    if (++nodes_ > most_nodes) throw YAML::ParserException(mark, "too many values for a file of settings");
    for (const auto& item : node.items) count(mark, *item);
    for (const ConfigNode::Entry& entry : node.entries) count(mark, *entry.value);
  }

  void begin(const YAML::Mark& mark, const std::shared_ptr<ConfigNode>& node) {
    if (open_.size() == deepest) throw YAML::ParserException(mark, "nested too deeply");
    add(mark, node);
    open_.push_back({node, std::nullopt});
  }

  void add(const YAML::Mark& mark, const std::shared_ptr<ConfigNode>& node) {
    if (open_.empty()) {
      root_ = node;
      return;
    }
    Open& open = open_.back();
    if (open.node->kind == Kind::list) {
      open.node->items.push_back(node);
    } else if (open.entry) {
      open.entry->value = node;
      open.node->entries.push_back(*std::exchange(open.entry, std::nullopt));
      if (open.node->entries.size() > most_keys) {
        throw YAML::ParserException(mark, "more than " + std::to_string(most_keys) + " keys in one mapping");
      }
    } else if (node->kind == Kind::scalar) {
      open.entry = ConfigNode::Entry{node->scalar, mark.line + 1, nullptr};
    } else {
      throw YAML::ParserException(mark, "a key that is no word");
    }
  }

  std::shared_ptr<const std::string> file_;
  std::shared_ptr<ConfigNode> root_ = std::make_shared<ConfigNode>();
  std::vector<Open> open_;
  std::size_t nodes_ = 0;
  std::map<YAML::anchor_t, std::shared_ptr<ConfigNode>> anchored_;
};

std::string position(const YAML::Mark& mark) {
  if (mark.is_null()) return "";
  return ":" + std::to_string(mark.line + 1) + ":" + std::to_string(mark.column + 1);
}

}  // namespace

std::shared_ptr<const ConfigNode> parse_yaml(std::string_view text, const std::string& file) {
  std::istringstream stream{std::string(text)};
  const auto name = std::make_shared<const std::string>(file);
  try {
    YAML::Parser parser(stream);
    NodeBuilder first(name);
    if (!parser.HandleNextDocument(first)) return first.root();
    NodeBuilder second(name);
    if (!parser.HandleNextDocument(second)) return first.root();
    throw SetupError(file + ":" + std::to_string(second.root()->line) +
                     ": a second YAML document begins; a file must hold only one, without '---' inside");
  } catch (const YAML::Exception& error) {
    throw SetupError(file + position(error.mark) + ": is not valid YAML: " + error.msg +
                     "; check indentation, colons, quotes and brackets here and just above");
  }
}

}  // namespace flinch
