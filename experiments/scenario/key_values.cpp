#include "experiments/scenario/key_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>
#include <utility>

#include "systems/config/config_file.h"
#include "systems/config/config_node.h"
#include "systems/config/unit.h"
#include "systems/config/yaml_text.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using Node = std::shared_ptr<const ConfigNode>;

constexpr double most_values = 10'000;  // of a range

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

// ---------------------------------------------------------------- ranges

std::optional<double> finite_number(std::string_view text) {
  double value = 0.0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_whole = error == std::errc{} && rest == text.data() + text.size();
  return is_whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// "20..400:20", "1..1000:*10".
struct ValueRange {
  double first = 0.0, last = 0.0, step = 0.0;
  bool multiplies = false;

  double at(int i) const { return multiplies ? first * std::pow(step, i) : first + step * i; }
  /// How many there are; a last one that rounding alone takes beyond the end counts.
  double count() const {
    const double steps = multiplies ? std::log(last / first) / std::log(step) : (last - first) / step;
    return std::floor(steps + 1e-9) + 1.0;
  }
};

/// Whether `text` is meant to be a range: two ends with dots between them.
bool looks_like_range(std::string_view text) {
  const std::size_t dots = text.find("..");
  return dots != std::string_view::npos && finite_number(text.substr(0, dots)).has_value();
}

std::optional<ValueRange> range_in(std::string_view text) {
  const std::size_t dots = text.find("..");
  const std::size_t colon = text.find(':', dots);
  if (colon == std::string_view::npos) return std::nullopt;
  std::string_view step = text.substr(colon + 1);
  const bool multiplies = step.starts_with('*');
  if (multiplies) step.remove_prefix(1);
  const auto first = finite_number(text.substr(0, dots));
  const auto last = finite_number(text.substr(dots + 2, colon - dots - 2));
  const auto by = finite_number(step);
  if (!first || !last || !by) return std::nullopt;
  return ValueRange{*first, *last, *by, multiplies};
}

/// What is wrong with it; "" if nothing is.
std::string problem_with(const ValueRange& range) {
  if (range.multiplies) {
    if (range.first * range.last <= 0.0) return "multiplies, so both ends must be above 0, or both below";
    if (range.step <= 0.0 || range.step == 1.0) return "needs a factor above 0 that is not 1";
  } else if (range.step == 0.0) {
    return "needs a step that is not 0";
  }
  if (!(range.count() >= 1.0)) return "leads away from its end";
  if (range.count() > most_values) return "has more than 10000 values";
  return "";
}

/// With twelve digits: 0.3, and not 0.30000000000000004, which is 0.1 + 2 * 0.1.
std::string rounded_text(double value) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 12).ptr;
  return {text, end};
}

std::vector<Node> values_of_range(const std::string& text, const ConfigNode& from) {
  const std::string form = "; a range is FIRST..LAST:STEP, such as 20..400:20, or FIRST..LAST:*FACTOR";
  const std::optional<ValueRange> range = range_in(from.scalar);
  const std::string problem = range ? problem_with(*range) : "is no range";
  if (!problem.empty()) throw SetupError(typed(text) + ": '" + from.scalar + "' " + problem + form);
  std::vector<Node> values;
  for (int i = 0; i < static_cast<int>(range->count()); ++i) {
    ConfigNode value = from;
    value.scalar = rounded_text(range->at(i));
    values.push_back(std::make_shared<const ConfigNode>(std::move(value)));
  }
  return values;
}

// ---------------------------------------------------------------- as a scenario reads them

/// The number of entries of a list of numbers, "[20, 20, 20]"; none for anything else.
std::optional<std::size_t> entries_of(const std::string& value) {
  if (!value.starts_with('[') || value.find_first_of("[{", 1) != std::string::npos) return std::nullopt;
  const auto commas = static_cast<std::size_t>(std::count(value.begin(), value.end(), ','));
  const std::string first = value.substr(1, value.find_first_of(",]") - 1);
  return finite_number(first) ? std::optional(commas + 1) : std::nullopt;
}

/// "gain" of a quantity in 1/s as "gain_per_s".
std::string with_si_unit(const std::string& key, const ReadValue& read) {
  if (key != read.key || read.unit.empty()) return key;
  const KeyUnit* const unit = find_key_unit_of(read.unit);
  return unit == nullptr ? key : key_with_unit(key, unit->key);
}

Node each_of_list(const Node& value, std::size_t entries) {
  if (value->kind != ConfigNode::Kind::scalar || value->quoted || !finite_number(value->scalar)) return value;
  auto list = std::make_shared<ConfigNode>(*value);
  list->kind = ConfigNode::Kind::list;
  list->scalar.clear();
  list->items.assign(entries, value);
  return list;
}

Node with(const Node& root, const std::string& text, const std::vector<ReadValue>& read) {
  const KeyValues given = as_read(parse_key_values(text), read);
  if (given.values.size() > 1) {
    throw SetupError(typed(text) +
                     ": gives several values, and here a run takes one; a list stands in brackets, [1,2]; "
                     "'flinch run' in simulation and 'flinch campaign' try one value after the other");
  }
  try {
    return with_value(*root, given.key, given.values.front());
  } catch (const SetupError& error) {
    throw SetupError(typed(text) + ": " + error.what());
  }
}

std::vector<ReadValue> values_or_none(const ValuesOf& values_of, const Node& root) {
  try {
    return values_of(root);
  } catch (const SetupError&) {  // which will be told of the scenario with the values
    return {};
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
  for (const Node& item : list->items) {
    const Node value = without_lines(*item);
    const bool is_scalar = value->kind == ConfigNode::Kind::scalar && !value->quoted;
    if (is_scalar && looks_like_range(value->scalar)) {
      const std::vector<Node> several = values_of_range(text, *value);
      given.values.insert(given.values.end(), several.begin(), several.end());
    } else {
      given.values.push_back(value);
    }
  }
  return given;
}

KeyValues as_read(KeyValues given, const std::vector<ReadValue>& read) {
  const auto same = std::find_if(read.begin(), read.end(),
                                 [&](const ReadValue& each) { return name_one_value(each.key, given.key); });
  if (same == read.end()) return given;
  given.key = with_si_unit(given.key, *same);
  if (const auto entries = entries_of(same->value)) {
    for (Node& value : given.values) value = each_of_list(value, *entries);
  }
  return given;
}

Node scenario_with(const std::filesystem::path& file, const std::vector<std::string>& set,
                   const ValuesOf& values_of) {
  Node root = parse_yaml(read_config_file(file), file.string());
  const std::vector<ReadValue> read = values_or_none(values_of, root);
  std::vector<std::string> problems;
  for (const std::string& text : set) {
    try {
      root = with(root, text, read);
    } catch (const SetupError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  throw_if_any(std::move(problems));
  return root;
}

}  // namespace flinch
