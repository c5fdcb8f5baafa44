#include "systems/config/yaml_text.h"

#include <algorithm>
#include <charconv>
#include <cstdio>

#include "systems/config/config_node.h"
#include "systems/config/unit.h"
#include "systems/foundation/setup_error.h"
#include "systems/foundation/visible_text.h"

namespace flinch {
namespace {

using Kind = ConfigNode::Kind;

bool is_plain(const std::string& scalar) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.' || c == '/' || c == '+' || c == '-';
  };
  return !scalar.empty() && std::all_of(scalar.begin(), scalar.end(), plain);
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\x%02x", static_cast<unsigned>(c));
      result += escape;
    } else {
      result += c;
    }
  }
  return result + "\"";
}

std::string scalar_text(const ConfigNode& node) {
  return !node.quoted && is_plain(node.scalar) ? node.scalar : quoted(node.scalar);
}

std::string key_text(const std::string& key) { return is_plain(key) ? key : quoted(key); }

void write_mapping(const ConfigNode& mapping, const std::string& indent, std::string& text) {
  for (const ConfigNode::Entry& entry : mapping.entries) {
    text += indent + key_text(entry.key) + ":";
    const ConfigNode& value = *entry.value;
    const bool has_sections =
        value.kind == Kind::list && !value.items.empty() && value.items.front()->kind == Kind::mapping;
    if (value.kind == Kind::mapping && !value.entries.empty()) {
      text += "\n";
      write_mapping(value, indent + "  ", text);
    } else if (has_sections) {
      text += "\n";
      for (const auto& item : value.items) text += indent + "  - " + yaml_line(*item) + "\n";
    } else {
      text += " " + yaml_line(value) + "\n";
    }
  }
}

/// "radius_mm" without its unit.
std::string_view without_unit(std::string_view key) {
  for (std::size_t end = key.find('_'); end != std::string_view::npos; end = key.find('_', end + 1)) {
    if (find_key_unit(key.substr(end + 1)) != nullptr) return key.substr(0, end);
  }
  return key;
}

/// "control.momentum_observer." of "control.momentum_observer.gain_per_s".
std::string_view sections_of(std::string_view path) { return path.substr(0, path.find_last_of(".]") + 1); }

[[noreturn]] void complain(std::string_view path, const std::string& complaint) {
  throw SetupError(std::string(path) + ": " + complaint);
}

/// Puts a value into copies of the nodes along a path.
class Replacement {
 public:
  Replacement(std::string_view path, std::shared_ptr<const ConfigNode> value)
      : path_(path), value_(std::move(value)) {}

  /// `done`: how much of the path led to `node`.
  std::shared_ptr<const ConfigNode> in(const ConfigNode* node, std::size_t done) const {
    if (done == path_.size()) return value_;
    return path_[done] == '[' ? in_list(node, done) : in_mapping(node, done + (done > 0 ? 1U : 0U));
  }

 private:
  std::shared_ptr<const ConfigNode> in_mapping(const ConfigNode* node, std::size_t begin) const {
    const std::size_t end = std::min(path_.find_first_of(".[", begin), path_.size());
    const std::string key(path_.substr(begin, end - begin));
    if (key.empty()) complain(path_, "is no path of keys, as in control.contact_detector.reaction_force_N");
    const auto result =
        node != nullptr ? std::make_shared<ConfigNode>(*node) : std::make_shared<ConfigNode>();
    if (node == nullptr) {  // made for the value, so it stands where that does
      result->file = value_->file;
      result->line = value_->line;
    }
    if (result->kind == Kind::empty) result->kind = Kind::mapping;
    if (result->kind != Kind::mapping) {
      complain(path_, "'" + std::string(path_.substr(0, begin)) + "' has no keys in this file");
    }
    auto& entries = result->entries;
    auto entry = std::find_if(entries.begin(), entries.end(), [&](const auto& e) { return e.key == key; });
    if (entry == entries.end() && end == path_.size()) {
      entry = std::find_if(entries.begin(), entries.end(),
                           [&](const auto& e) { return without_unit(e.key) == without_unit(key); });
    }
    if (entry == entries.end()) {
      entries.push_back({key, result->line, in(nullptr, end)});
    } else {
      entry->key = key;
      entry->value = in(entry->value.get(), end);
    }
    return result;
  }

  std::shared_ptr<const ConfigNode> in_list(const ConfigNode* node, std::size_t begin) const {
    const std::size_t close = path_.find(']', begin);
    std::size_t index = 0;
    const char* const digits = path_.data() + begin + 1;
    const char* const end = path_.data() + std::min(close, path_.size());
    const auto [rest, error] = std::from_chars(digits, end, index);
    if (close == std::string_view::npos || error != std::errc{} || rest != end) {
      complain(path_, "'[' must be followed by the number of an entry, from 0, and ']'");
    }
    const std::size_t length = node != nullptr && node->kind == Kind::list ? node->items.size() : 0;
    if (index >= length) {
      complain(path_, "the list has " + std::to_string(length) + " entries in this file, counted from 0");
    }
    const auto result = std::make_shared<ConfigNode>(*node);
    result->items[index] = in(node->items[index].get(), close + 1);
    return result;
  }

  std::string_view path_;
  std::shared_ptr<const ConfigNode> value_;
};

}  // namespace

std::string yaml_line(const ConfigNode& node) {
  std::string text;
  switch (node.kind) {
    case Kind::scalar:
      return scalar_text(node);
    case Kind::list:
      for (const auto& item : node.items) text += (text.empty() ? "" : ", ") + yaml_line(*item);
      return "[" + text + "]";
    case Kind::mapping:
      for (const ConfigNode::Entry& entry : node.entries)
        text += (text.empty() ? "" : ", ") + key_text(entry.key) + ": " + yaml_line(*entry.value);
      return "{" + text + "}";
    case Kind::empty:
      break;
  }
  return "null";
}

std::string yaml_text(const ConfigNode& mapping) {
  std::string text;
  write_mapping(mapping, "", text);
  return text;
}

std::shared_ptr<const ConfigNode> scalar_node(std::string scalar) {
  auto node = std::make_shared<ConfigNode>();
  node->kind = Kind::scalar;
  node->scalar = std::move(scalar);
  return node;
}

std::shared_ptr<const ConfigNode> with_value(const ConfigNode& root, std::string_view path,
                                             std::shared_ptr<const ConfigNode> value) {
  if (path.empty()) complain("the empty path", "is no key");
  return Replacement(path, std::move(value)).in(&root, 0);
}

std::string comment_text(std::string_view text) {
  std::string line = visible_text(text);
  for (std::size_t at = line.find('\n'); at != std::string::npos; at = line.find('\n', at))
    line.replace(at, 1, "\\n");
  return line;
}

bool name_one_value(std::string_view path, std::string_view other) {
  const std::string_view sections = sections_of(path);
  return sections == sections_of(other) &&
         without_unit(path.substr(sections.size())) == without_unit(other.substr(sections.size()));
}

}  // namespace flinch
