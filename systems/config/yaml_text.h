#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace flinch {

struct ConfigNode;

/// The value as YAML that parses to the same nodes, on one line: "[20, 20, 20]", "{x_mm: 3}". Comments are
/// not kept.
std::string yaml_line(const ConfigNode& node);

/// A mapping as YAML text of many lines, as people write it.
std::string yaml_text(const ConfigNode& mapping);

/// A word or number, as one writes it without quotes.
std::shared_ptr<const ConfigNode> scalar_node(std::string scalar);

/// The mapping `root` with `value` at `path`, such as "control.momentum_observer.gain_per_s" or
/// "obstacles[0].radius_mm". Sections that are missing are made; the same quantity under another unit gives
/// way. Throws SetupError saying which part of the path fits nothing: a list that has no such entry, a value
/// where a section was meant.
std::shared_ptr<const ConfigNode> with_value(const ConfigNode& root, std::string_view path,
                                             std::shared_ptr<const ConfigNode> value);

/// Whether two such paths name one value, be it in other units.
bool name_one_value(std::string_view path, std::string_view other);

/// What a line of comment may say: `text` without control characters, line feeds included.
std::string comment_text(std::string_view text);

}  // namespace flinch
