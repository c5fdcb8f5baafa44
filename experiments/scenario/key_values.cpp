#include "experiments/scenario/key_values.h"

#include "systems/config/config_file.h"
#include "systems/config/config_node.h"
#include "systems/config/yaml_text.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using Node = std::shared_ptr<const ConfigNode>;

std::string typed(const std::string& text) { return "--set " + text; }

/// A value of the command line, which has no lines.
Node without_lines(const ConfigNode& node) {
  auto copy = std::make_shared<ConfigNode>(node);
  copy->line = 0;
  for (Node& item : copy->items) item = without_lines(*item);
  for (ConfigNode::Entry& entry : copy->entries) {
    entry.line = 0;
    entry.value = without_lines(*entry.value);
  }
  return copy;
}

Node with(const Node& root, const std::string& text) {
  const KeyValues given = parse_key_values(text);
  if (given.values.size() > 1) {
    throw SetupError(typed(text) +
                     ": gives several values, and a run takes one; a list stands in brackets, "
                     "[1,2], and 'flinch campaign' tries one value after the other");
  }
  try {
    return with_value(*root, given.key, given.values.front());
  } catch (const SetupError& error) {
    throw SetupError(typed(text) + ": " + error.what());
  }
}

}  // namespace

KeyValues parse_key_values(const std::string& text) {
  const std::size_t equals = text.find('=');
  const bool has_key = equals != std::string::npos && equals > 0;
  if (!has_key) throw SetupError(typed(text) + ": is not of the form KEY=VALUE");
  const Node list = parse_yaml("[" + text.substr(equals + 1) + "]", typed(text));
  if (list->items.empty()) throw SetupError(typed(text) + ": gives no value; the form is KEY=VALUE");
  KeyValues given{text.substr(0, equals), {}};
  for (const Node& value : list->items) given.values.push_back(without_lines(*value));
  return given;
}

Node scenario_with(const std::filesystem::path& file, const std::vector<std::string>& set) {
  Node root = parse_yaml(read_config_file(file), file.string());
  std::vector<std::string> problems;
  for (const std::string& text : set) {
    try {
      root = with(root, text);
    } catch (const SetupError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  throw_if_any(std::move(problems));
  return root;
}

}  // namespace flinch
