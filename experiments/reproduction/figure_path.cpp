#include "experiments/reproduction/figure_path.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

namespace flinch {
namespace {

using Condition = std::pair<std::string, std::string>;

/// A key, and which entries of the list that is there.
struct Step {
  std::string key;
  bool has_choice = false;
  std::optional<std::size_t> index;
  std::vector<Condition> conditions;
};

struct Path {
  enum class Of { first, most, least, sum };
  Of of = Of::first;
  std::vector<Step> steps;
};

std::string_view without_blanks(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

bool is_number(std::string_view text) {
  return !text.empty() && text.size() < 9 &&
         std::all_of(text.begin(), text.end(), [](char letter) { return letter >= '0' && letter <= '9'; });
}

/// What stands in brackets.
bool read_choice(std::string_view text, Step& step) {
  step.has_choice = true;
  if (is_number(text)) {
    step.index = std::stoul(std::string(text));
    return true;
  }
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(','), text.size());
    const std::string_view condition = without_blanks(text.substr(0, end));
    const std::size_t equals = condition.find('=');
    if (equals == std::string_view::npos || equals == 0) return false;
    step.conditions.emplace_back(without_blanks(condition.substr(0, equals)),
                                 without_blanks(condition.substr(equals + 1)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return !step.conditions.empty();
}

/// None where it is no path.
std::optional<Path> parsed(std::string_view text) {
  Path path;
  if (text.starts_with("most ")) path.of = Path::Of::most;
  if (text.starts_with("least ")) path.of = Path::Of::least;
  if (text.starts_with("sum ")) path.of = Path::Of::sum;
  if (path.of != Path::Of::first) text = without_blanks(text.substr(text.find(' ')));
  while (true) {
    Step& step = path.steps.emplace_back();
    const std::size_t end = std::min(text.find_first_of(".["), text.size());
    step.key = std::string(text.substr(0, end));
    if (step.key.empty() || step.key.find_first_of(" ]=,") != std::string::npos) return std::nullopt;
    text.remove_prefix(end);
    if (text.starts_with('[')) {
      const std::size_t close = text.find(']');
      if (close == std::string_view::npos || !read_choice(text.substr(1, close - 1), step))
        return std::nullopt;
      text.remove_prefix(close + 1);
    }
    if (text.empty()) return path;
    if (!text.starts_with('.')) return std::nullopt;
    text.remove_prefix(1);
  }
}

/// A value as one would write it in a path.
std::string written(const nlohmann::json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

bool fits(const nlohmann::json& entry, const std::vector<Condition>& conditions) {
  return std::all_of(conditions.begin(), conditions.end(), [&](const Condition& wanted) {
    if (!entry.is_object()) return false;
    const auto found = entry.find(wanted.first);
    if (found != entry.end()) return written(*found) == wanted.second;
    const auto at = entry.find("at");  // of a group: where it stands in the grid
    return at != entry.end() && at->is_object() && at->contains(wanted.first) &&
           written(at->at(wanted.first)) == wanted.second;
  });
}

/// All numbers that the steps from `step` on lead to.
void collect(const nlohmann::json& here, const std::vector<Step>& steps, std::size_t step,
             std::vector<double>& numbers) {
  if (step == steps.size()) {
    if (here.is_number()) numbers.push_back(here.get<double>());
    return;
  }
  if (!here.is_object() || !here.contains(steps[step].key)) return;
  const nlohmann::json& there = here.at(steps[step].key);
  if (!there.is_array()) {
    if (!steps[step].has_choice) collect(there, steps, step + 1, numbers);
    return;
  }
  for (std::size_t i = 0; i < there.size(); ++i) {
    const bool chosen = steps[step].index ? *steps[step].index == i : fits(there[i], steps[step].conditions);
    if (chosen) collect(there[i], steps, step + 1, numbers);
  }
}

}  // namespace

std::optional<double> figure_at(const nlohmann::json& object, const std::string& path) {
  const std::optional<Path> way = parsed(without_blanks(path));
  if (!way) return std::nullopt;
  std::vector<double> numbers;
  collect(object, way->steps, 0, numbers);
  if (numbers.empty()) return std::nullopt;
  if (way->of == Path::Of::most) return *std::max_element(numbers.begin(), numbers.end());
  if (way->of == Path::Of::least) return *std::min_element(numbers.begin(), numbers.end());
  if (way->of == Path::Of::sum) return std::accumulate(numbers.begin(), numbers.end(), 0.0);
  return numbers.front();
}

std::string problem_with_path(const std::string& path) {
  if (parsed(without_blanks(path))) return "";
  return "is '" + path +
         "'; it must be a path into the JSON of a run or campaign, such as contacts[0].detection_ms or "
         "'most groups[body=platform].removed_max_ms'";
}

}  // namespace flinch
