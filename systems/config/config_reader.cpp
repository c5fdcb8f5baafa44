#include "systems/config/config_reader.h"

#include <algorithm>
#include <cmath>

#include "systems/config/config_document.h"
#include "systems/config/config_file.h"
#include "systems/config/config_node.h"
#include "systems/config/parsed.h"
#include "systems/config/yaml_text.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"
#include "systems/foundation/standard_input.h"

namespace flinch {
namespace {

using Kind = ConfigNode::Kind;
using Count = std::optional<std::size_t>;

std::string text_of(const std::vector<double>& values) {
  std::string text = "[";
  for (const double value : values) text += (text.size() > 1 ? ", " : "") + exact_text(value);
  return text + "]";
}

std::string text_of(const std::vector<std::string>& words) {
  std::string text = "[";
  for (const std::string& word : words) text += (text.size() > 1 ? ", " : "") + word;
  return text + "]";
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

FoundValue entry_of(const FoundValue& list, std::size_t i) {
  const std::string index = "[" + std::to_string(i) + "]";
  const ConfigNode& node = *list.node->items[i];
  const std::string* const file = node.file ? node.file.get() : list.place.file;
  return {&node, list.unit, list.key + index, list.written + index, {file, node.line}};
}

// What is wrong with a list apart from its entries; without a count it must only not be empty.
std::string complaint_about_list(const ConfigNode& node, Count count, const std::string& things) {
  const std::string wanted = "; it must be a list of " + (count ? std::to_string(*count) + " " : "") + things;
  if (node.kind != Kind::list) return description(node) + wanted;
  if (count ? node.items.size() == *count : !node.items.empty()) return "";
  return (node.items.empty() ? "is an empty list" : "is a list of " + std::to_string(node.items.size())) +
         wanted;
}

// Takes over what was found in the file, or notes what is wrong with it.
template <class T>
void accept(ConfigDocument& document, const FoundValue& found, const Parsed<T>& parsed, T& value) {
  if (parsed.complaint.empty()) {
    value = parsed.value;
  } else {
    document.add_problem(found, parsed.complaint);
  }
}

}  // namespace

ConfigReader ConfigReader::open(const std::filesystem::path& file) {
  return parse(read_config_file(file), file.string());
}

ConfigReader ConfigReader::parse(std::string_view text, const std::string& file) {
  return over(parse_yaml(text, file), file);
}

ConfigReader ConfigReader::over(std::shared_ptr<const ConfigNode> root, const std::string& file) {
  if (root->kind != Kind::mapping) {
    const std::string line = root->kind == Kind::empty ? "" : ":" + std::to_string(root->line);
    throw SetupError(file + line + ": " + description(*root) +
                     "; it must be a mapping, of lines such as 'key: value'");
  }
  auto document = std::make_shared<ConfigDocument>(file, std::move(root));
  ConfigSection& section = document->root();
  return {std::move(document), section};
}

ConfigReader ConfigReader::required() const {
  ConfigReader reader = *this;
  reader.required_ = true;
  return reader;
}

// ---------------------------------------------------------------- values

void ConfigReader::number(std::string_view name, const Unit& unit, double& value, const Range& range) {
  const FoundValue found = document_->find(*section_, name, unit, required_);
  if (found.node != nullptr) accept(*document_, found, parse_number(*found.node, *found.unit, range), value);
  document_->add_value(found, exact_text(value), unit);
}

void ConfigReader::number(std::string_view name, const Unit& unit, std::optional<double>& value,
                          const Range& range) {
  const FoundValue found = document_->find(*section_, name, unit, required_);
  if (found.node != nullptr) {
    const Parsed<double> parsed = parse_number(*found.node, *found.unit, range);
    accept<std::optional<double>>(*document_, found, {parsed.value, parsed.complaint}, value);
  }
  document_->add_value(found, value ? exact_text(*value) : "none", unit);
}

void ConfigReader::numbers(std::string_view name, const Unit& unit, std::span<double> values,
                           const Range& range) {
  std::vector<double> list(values.begin(), values.end());
  read_list(name, unit, list, values.size(), range);
  std::copy(list.begin(), list.end(), values.begin());
}

void ConfigReader::numbers(std::string_view name, const Unit& unit, std::vector<double>& values,
                           const Range& range) {
  read_list(name, unit, values, std::nullopt, range);
}

void ConfigReader::one_or_numbers(std::string_view name, const Unit& unit, std::vector<double>& values,
                                  Count count, const Range& range) {
  const FoundValue found = document_->find(*section_, name, unit, required_);
  if (found.node != nullptr && found.node->kind == Kind::list)
    return read_list(name, unit, values, count, range);
  if (found.node != nullptr) {
    double value = 0.0;
    const Parsed<double> parsed = parse_number(*found.node, *found.unit, range);
    accept(*document_, found, parsed, value);
    if (parsed.complaint.empty()) values = {value};
  }
  document_->add_value(found, values.size() == 1 ? exact_text(values.front()) : text_of(values), unit);
}

void ConfigReader::read_list(std::string_view name, const Unit& unit, std::vector<double>& values,
                             Count count, const Range& range) {
  const FoundValue found = document_->find(*section_, name, unit, required_);
  if (found.node != nullptr) {
    const std::string complaint = complaint_about_list(*found.node, count, "numbers");
    if (complaint.empty()) {
      values.resize(found.node->items.size());
      for (std::size_t i = 0; i < values.size(); ++i) {
        const FoundValue entry = entry_of(found, i);
        accept(*document_, entry, parse_number(*entry.node, *entry.unit, range), values[i]);
      }
    } else {
      document_->add_problem(found, complaint);
    }
  }
  document_->add_value(found, text_of(values), unit);
}

void ConfigReader::duration(std::string_view name, std::chrono::nanoseconds& value, const Range& range) {
  constexpr double longest = 9e9;  // [s] that 64 bits of nanoseconds hold
  double seconds = std::chrono::duration<double>(value).count();
  const FoundValue found = document_->find(*section_, name, unit::s, required_);
  if (found.node != nullptr) {
    Parsed<double> parsed = parse_number(*found.node, *found.unit, range);
    if (parsed.complaint.empty() && std::abs(parsed.value) > longest) {
      parsed.complaint =
          description(*found.node) + "; it must " + between(-longest, longest).requirement(*found.unit);
    }
    accept(*document_, found, parsed, seconds);
    if (parsed.complaint.empty()) value = std::chrono::nanoseconds(std::llround(seconds * 1e9));
  }
  document_->add_value(found, exact_text(seconds), unit::s);
}

void ConfigReader::integer(std::string_view name, int& value, int least, int most) {
  const FoundValue found = document_->find(*section_, name, unit::none, required_);
  if (found.node != nullptr) accept(*document_, found, parse_integer(*found.node, least, most), value);
  document_->add_value(found, std::to_string(value), unit::none);
}

void ConfigReader::seed(std::string_view name, std::uint64_t& value) {
  const FoundValue found = document_->find(*section_, name, unit::none, required_);
  if (found.node != nullptr) accept(*document_, found, parse_seed(*found.node), value);
  document_->add_value(found, std::to_string(value), unit::none);
}

void ConfigReader::flag(std::string_view name, bool& value) {
  const FoundValue found = document_->find(*section_, name, unit::none, required_);
  if (found.node != nullptr) accept(*document_, found, parse_flag(*found.node), value);
  document_->add_value(found, value ? "true" : "false", unit::none);
}

void ConfigReader::text(std::string_view name, std::string& value) {
  const FoundValue found = document_->find(*section_, name, unit::none, required_);
  if (found.node != nullptr) accept(*document_, found, parse_text(*found.node), value);
  document_->add_value(found, value, unit::none);
}

void ConfigReader::word(std::string_view name, std::string& value, const std::vector<std::string>& known) {
  const auto standard = std::find(known.begin(), known.end(), value);
  const auto place = static_cast<std::size_t>(standard - known.begin());
  const auto chosen = choose(name, known, standard == known.end() ? std::nullopt : std::optional(place));
  if (chosen) value = known[*chosen];
}

void ConfigReader::words(std::string_view name, std::vector<std::string>& values,
                         const std::vector<std::string>& known) {
  const FoundValue found = document_->find(*section_, name, unit::none, required_);
  if (found.node != nullptr) {
    const std::string complaint = complaint_about_list(*found.node, std::nullopt, "words");
    if (!complaint.empty()) document_->add_problem(found, complaint);
    std::vector<std::string> words;
    for (std::size_t i = 0; complaint.empty() && i < found.node->items.size(); ++i) {
      const FoundValue entry = entry_of(found, i);
      const std::string& word = entry.node->scalar;
      if (entry.node->kind != Kind::scalar || !contains(known, word)) {
        document_->add_problem(entry, description(*entry.node) + did_you_mean(word, known));
      } else if (contains(words, word)) {
        document_->add_problem(entry, description(*entry.node) + ", as an entry before it");
      } else {
        words.push_back(word);
      }
    }
    if (!words.empty()) values = words;
  }
  document_->add_value(found, text_of(values), unit::none);
}

void ConfigReader::nodes(std::string_view name, std::vector<std::shared_ptr<const ConfigNode>>& values) {
  const FoundValue found = document_->find(*section_, name, unit::none, required_);
  std::string text;
  if (found.node != nullptr) {
    const std::string complaint = complaint_about_list(*found.node, std::nullopt, "values");
    if (complaint.empty()) {
      values = found.node->items;
    } else {
      document_->add_problem(found, complaint);
    }
  }
  for (const auto& value : values) text += (text.empty() ? "" : ", ") + yaml_line(*value);
  document_->add_value(found, "[" + text + "]", unit::none);
}

void ConfigReader::file(std::string_view name, std::filesystem::path& value) {
  const FoundValue found = document_->find(*section_, name, unit::none, required_);
  if (found.node != nullptr) {
    Parsed<std::string> parsed = parse_text(*found.node);
    const std::filesystem::path folder = folder_named_in(document_->file());
    const std::filesystem::path path = (folder / parsed.value).lexically_normal();
    const std::string problem = problem_with_file(path);
    if (parsed.complaint.empty() && !problem.empty())
      parsed.complaint = description(*found.node) + ": " + problem;
    accept<std::filesystem::path>(*document_, found, {path, parsed.complaint}, value);
  }
  document_->add_value(found, value.string(), unit::none);
}

std::optional<std::size_t> ConfigReader::choose(std::string_view name, const std::vector<std::string>& words,
                                                std::optional<std::size_t> standard) {
  const FoundValue found = document_->find(*section_, name, unit::none, required_, words);
  std::optional<std::size_t> chosen = standard;
  if (found.node != nullptr) {
    const auto word = std::find(words.begin(), words.end(), found.node->scalar);
    if (found.node->kind == Kind::scalar && word != words.end()) {
      chosen = static_cast<std::size_t>(word - words.begin());
    } else {
      document_->add_problem(found, description(*found.node) + did_you_mean(found.node->scalar, words));
      chosen.reset();
    }
  }
  document_->add_value(found, chosen ? words[*chosen] : "", unit::none);
  return chosen;
}

// ---------------------------------------------------------------- sections

bool ConfigReader::has(std::string_view name) const { return document_->has(*section_, name); }

bool ConfigReader::has_section(std::string_view name) const {
  const FoundValue found = document_->find(*section_, name, unit::none, false);
  return found.node != nullptr && found.node->kind == Kind::mapping;
}

std::vector<std::string_view> ConfigReader::keys() const {
  std::vector<std::string_view> keys;
  if (section_->node == nullptr) return keys;
  for (const ConfigNode::Entry& entry : section_->node->entries) keys.push_back(entry.key);
  return keys;
}

std::string_view ConfigReader::one_of(std::initializer_list<std::string_view> names) {
  std::string list;
  std::vector<FoundValue> given;
  std::string_view first;
  for (const std::string_view name : names) {
    const FoundValue found = document_->find(*section_, name, unit::none, false);
    list.append(list.empty() ? "" : ", ").append(name);
    if (found.node == nullptr) continue;
    if (given.empty()) first = name;
    given.push_back(found);
  }
  if (section_->node == nullptr) return first;
  FoundValue place = {
      .key = section_->path_of(*names.begin()), .written = section_->path, .place = section_->place};
  if (given.empty()) document_->add_problem(place, "has none of " + list + "; it must have one of them");
  if (given.size() > 1) {
    place.place = given[1].place;
    document_->add_problem(place, "has more than one of " + list + "; it must have only one of them");
  }
  return first;
}

ConfigReader ConfigReader::section(std::string_view name) {
  const FoundValue found = document_->find(*section_, name, unit::none, required_);
  const bool is_mapping = found.node != nullptr && found.node->kind == Kind::mapping;
  if (found.node != nullptr && !is_mapping) {
    document_->add_problem(found, description(*found.node) + "; it must be a mapping");
  }
  return {document_, document_->add_section(is_mapping ? found.node : nullptr, found.key, found.place)};
}

std::vector<ConfigReader> ConfigReader::sections(std::string_view name) {
  return read_sections(name, std::nullopt);
}

std::vector<ConfigReader> ConfigReader::sections(std::string_view name, std::size_t count) {
  return read_sections(name, count);
}

std::vector<ConfigReader> ConfigReader::read_sections(std::string_view name, Count count) {
  const FoundValue found = document_->find(*section_, name, unit::none, required_);
  std::vector<ConfigReader> readers;
  if (found.node == nullptr) return readers;
  document_->add_list(found);
  const std::string complaint = complaint_about_list(*found.node, count, "mappings");
  if (!complaint.empty()) document_->add_problem(found, complaint);

  const std::size_t size = std::min(found.node->items.size(), count.value_or(found.node->items.size()));
  for (std::size_t i = 0; i < size; ++i) {
    const FoundValue entry = entry_of(found, i);
    const bool is_mapping = entry.node->kind == Kind::mapping;
    if (!is_mapping) document_->add_problem(entry, description(*entry.node) + "; it must be a mapping");
    ConfigSection& section =
        document_->add_section(is_mapping ? entry.node : nullptr, entry.key, entry.place);
    readers.push_back({document_, section});
  }
  return readers;
}

void ConfigReader::leave_unread(std::string_view name) {
  document_->find(*section_, name, unit::none, false);
}

void ConfigReader::leave_rest_unread() { std::fill(section_->taken.begin(), section_->taken.end(), char{1}); }

// ---------------------------------------------------------------- the end

int ConfigReader::line() const { return section_->place.line; }

void ConfigReader::problem(std::string_view name, const std::string& complaint) {
  document_->add_consequence(section_->path_of(name), complaint);
}

void ConfigReader::add_problems(const std::vector<std::string>& problems) {
  document_->add_foreign(problems);
}

bool ConfigReader::good() const { return document_->good(); }

std::vector<ReadValue> ConfigReader::finish() { return document_->finish(); }

}  // namespace flinch
