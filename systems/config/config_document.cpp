#include "systems/config/config_document.h"

#include <algorithm>
#include <set>
#include <utility>

#include "systems/config/key_error.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

// "mass" asked for and "mass", "mass_m" or "mass_g" written: the same value, whatever its unit.
bool is_same_value(const WantedKey& wanted, std::string_view written) {
  if (written == wanted.name) return true;
  if (!written.starts_with(wanted.name + "_")) return false;
  return find_key_unit(written.substr(wanted.name.size() + 1)) != nullptr;
}

// What was meant by a key that nobody asked for: the longest name of a value not found so far.
WantedKey* meant_by(std::string_view written, std::vector<WantedKey>& wanted) {
  WantedKey* meant = nullptr;
  for (WantedKey& candidate : wanted) {
    if (candidate.found || !is_same_value(candidate, written)) continue;
    if (meant == nullptr || candidate.name.size() > meant->name.size()) meant = &candidate;
  }
  return meant;
}

std::vector<std::string> known_keys(const std::vector<WantedKey>& wanted) {
  std::vector<std::string> keys;
  for (const WantedKey& key : wanted) keys.push_back(key.with_si_unit());
  return keys;
}

// The value that a misspelt key stands for, which then is not missing; the key itself if there is none.
std::string mistaken_for(const std::string& written, std::vector<WantedKey>& wanted) {
  const std::string nearest = nearest_name(written, known_keys(wanted));
  for (WantedKey& candidate : wanted) {
    if (candidate.found || candidate.with_si_unit() != nearest) continue;
    candidate.found = true;
    return candidate.name;
  }
  return written;
}

// Where other keys depend on a word, it is the word that is wrong or missing: so they are told as well.
std::vector<std::string> known_keys_with_words(const std::vector<WantedKey>& wanted) {
  std::vector<std::string> keys;
  for (const WantedKey& key : wanted)
    keys.push_back(key.with_si_unit() + (key.words.empty() ? "" : " (" + listed(key.words) + ")"));
  return keys;
}

std::string complaint_about_key(const std::string& written, const std::vector<WantedKey>& wanted) {
  const std::vector<std::string> known = known_keys(wanted);
  if (std::find(known.begin(), known.end(), written) != known.end())
    return "has no effect here; leave it out";
  const bool is_near = !nearest_name(written, known).empty();
  return "is not a known key" +
         (is_near ? did_you_mean(written, known) : known_names(known_keys_with_words(wanted)));
}

std::string complaint_about_unit(std::string_view written, const WantedKey& meant) {
  const std::string right = "; write " + possible_keys(meant.name, meant.unit);
  if (written == meant.name) return "has no unit" + right;
  const std::string unit(written.substr(meant.name.size() + 1));
  if (meant.unit == unit::none) return "has a unit, " + unit + right;
  return "has the wrong unit, " + unit + right;
}

// A key may be asked for more than once.
void note_wanted(std::vector<WantedKey>& wanted, WantedKey key) {
  const auto known = std::find_if(wanted.begin(), wanted.end(), [&key](const WantedKey& earlier) {
    return earlier.name == key.name && earlier.unit == key.unit;
  });
  if (known == wanted.end()) {
    wanted.push_back(std::move(key));
  } else {
    known->required = known->required || key.required;
    if (!key.words.empty()) known->words = std::move(key.words);
  }
}

std::string parent_of(const std::string& key) {
  const std::size_t end = key.find_last_of(".[");
  return end == std::string::npos ? "" : key.substr(0, end);
}

/// Whether one of `keys` begins so.
bool has_beginning(const std::set<std::string>& keys, const std::string& begin) {
  const auto first = keys.lower_bound(begin);
  return first != keys.end() && first->starts_with(begin);
}

/// Whether one of `causes` is the key, in its section or around it.
bool explain(const std::set<std::string>& causes, std::string key) {
  if (key.empty()) return !causes.empty();
  if (has_beginning(causes, key + ".") || has_beginning(causes, key + "[")) return true;
  for (; !key.empty(); key = parent_of(key)) {
    if (causes.count(key) > 0) return true;
  }
  return causes.count("") > 0;
}

}  // namespace

std::string ConfigSection::path_of(std::string_view key) const {
  if (path.empty()) return std::string(key);
  return key.empty() ? path : path + "." + std::string(key);
}

ConfigDocument::ConfigDocument(std::string file, std::shared_ptr<const ConfigNode> root)
    : file_(std::move(file)), root_(std::move(root)) {
  add_section(root_.get(), "", {&file_, root_->line});
}

ConfigSection& ConfigDocument::add_section(const ConfigNode* node, std::string path, SourceLocation place) {
  ConfigSection*& known = by_path_[path];
  if (known != nullptr) return *known;
  places_.emplace(path, Place{path, place});
  ConfigSection& section = sections_.emplace_back();
  known = &section;
  section.node = node;
  section.path = std::move(path);
  section.place = place;
  if (node != nullptr) section.taken.resize(node->entries.size());
  report_repeated(section);
  return section;
}

FoundValue ConfigDocument::find(ConfigSection& section, std::string_view name, const Unit& unit,
                                bool required, const std::vector<std::string>& words) {
  FoundValue found;
  found.key = section.path_of(name);
  found.written = found.key;
  found.place = section.place;
  if (section.node == nullptr) return found;

  const auto& entries = section.node->entries;
  for (const KeyUnit& written : key_units(unit)) {
    const std::string key = key_with_unit(name, written.key);
    const auto entry =
        std::find_if(entries.begin(), entries.end(), [&](const auto& e) { return e.key == key; });
    if (entry == entries.end()) continue;
    const bool is_new =
        !std::exchange(section.taken[static_cast<std::size_t>(entry - entries.begin())], true);
    if (found.node == nullptr) {
      found = {entry->value.get(), &written, found.key, section.path_of(key), place_of(section, *entry)};
    } else if (is_new) {
      add(place_of(section, *entry), found.key, section.path_of(key),
          "means the same as " + found.written + " on line " + std::to_string(found.place.line) +
              "; keep one of them");
    }
  }
  note_wanted(section.wanted, {std::string(name), unit, required, found.node != nullptr, words});
  if (required && found.node == nullptr) incomplete_ = true;
  return found;
}

bool ConfigDocument::has(ConfigSection& section, std::string_view name) {
  if (section.node == nullptr) return false;
  const auto& entries = section.node->entries;
  const bool there =
      std::any_of(entries.begin(), entries.end(), [name](const auto& entry) { return entry.key == name; });
  note_wanted(section.wanted, {std::string(name), unit::none, false, there});
  return there;
}

void ConfigDocument::add_value(const FoundValue& found, std::string value, const Unit& unit) {
  places_.emplace(found.key, Place{found.written, found.place});
  values_.push_back({found.key, std::move(value), std::string(unit.symbol), found.node != nullptr});
}

void ConfigDocument::add_list(const FoundValue& found) {
  places_.emplace(found.key, Place{found.written, found.place});
}

void ConfigDocument::add_problem(const FoundValue& found, const std::string& complaint) {
  add(found.place, found.key, found.written, complaint);
}

void ConfigDocument::add_consequence(const std::string& key, const std::string& complaint) {
  const Place place = place_of(key);
  add(place.at, key, place.written, complaint, true);
}

void ConfigDocument::add_foreign(const std::vector<std::string>& problems) {
  foreign_.insert(foreign_.end(), problems.begin(), problems.end());
  incomplete_ = incomplete_ || !problems.empty();
}

std::vector<ReadValue> ConfigDocument::finish() {
  for (ConfigSection& section : sections_) {
    report_left_over(section);
    report_missing(section);
  }
  const std::set<std::string> causes = keys_of_causes();
  std::vector<Problem> told;
  std::set<std::string> texts;  // each once, though a value may be read more than once
  for (const Problem& problem : problems_) {
    if (problem.consequence && explain(causes, problem.key)) continue;
    if (texts.insert(problem.text).second) told.push_back(problem);
  }
  std::stable_sort(told.begin(), told.end(),
                   [](const Problem& a, const Problem& b) { return a.place.line < b.place.line; });
  std::vector<std::string> sentences, of_keys;
  for (Problem& problem : told) {
    if (problem.of_key) of_keys.push_back(problem.text);
    sentences.push_back(std::move(problem.text));
  }
  sentences.insert(sentences.end(), foreign_.begin(), foreign_.end());
  if (!of_keys.empty()) throw KeyError(std::move(sentences), std::move(of_keys));
  throw_if_any(std::move(sentences));
  return std::move(values_);
}

// ---------------------------------------------------------------- problems

void ConfigDocument::add(SourceLocation place, std::string key, const std::string& written,
                         const std::string& complaint, bool consequence) {
  std::string text = place.text() + ": ";
  if (!written.empty()) text += written + ": ";
  problems_.push_back({place, std::move(key), text + complaint, consequence});
}

void ConfigDocument::add_wrong_key(SourceLocation place, std::string key, const std::string& written,
                                   const std::string& complaint) {
  add(place, std::move(key), written, complaint);
  problems_.back().of_key = true;
}

void ConfigDocument::report_repeated(ConfigSection& section) {
  if (section.node == nullptr) return;
  const auto& entries = section.node->entries;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto first = std::find_if(entries.begin(), entries.end(), [&](const ConfigNode::Entry& entry) {
      return entry.key == entries[i].key;
    });
    if (first == entries.begin() + static_cast<std::ptrdiff_t>(i)) continue;
    section.taken[i] = true;
    const std::string path = section.path_of(entries[i].key);
    add(place_of(section, entries[i]), path, path,
        "is given already on line " + std::to_string(first->line) + "; keep one of them");
  }
}

void ConfigDocument::report_left_over(ConfigSection& section) {
  for (std::size_t i = 0; i < section.taken.size(); ++i) {
    if (section.taken[i]) continue;
    const ConfigNode::Entry& entry = section.node->entries[i];
    const std::string written = section.path_of(entry.key);
    WantedKey* meant = meant_by(entry.key, section.wanted);
    if (meant != nullptr) {
      meant->found = true;
      add_wrong_key(place_of(section, entry), section.path_of(meant->name), written,
                    complaint_about_unit(entry.key, *meant));
      continue;
    }
    const std::string complaint = complaint_about_key(entry.key, section.wanted);
    add_wrong_key(place_of(section, entry), section.path_of(mistaken_for(entry.key, section.wanted)), written,
                  complaint);
  }
}

void ConfigDocument::report_missing(const ConfigSection& section) {
  for (const WantedKey& wanted : section.wanted) {
    if (!wanted.required || wanted.found) continue;
    add(section.place, section.path_of(wanted.name), section.path_of(wanted.with_si_unit()),
        "is missing; it must be " + (wanted.words.empty() ? "given" : "one of " + listed(wanted.words)));
  }
}

// A value that another file gave stands there; its key, in this file.
SourceLocation ConfigDocument::place_of(const ConfigSection& section, const ConfigNode::Entry& entry) const {
  const auto& given = entry.value->file;
  if (given && *given != *section.place.file) return {given.get(), entry.value->line};
  return {section.place.file, entry.line};
}

// Where a value or section stands, or the nearest section around it that was read.
ConfigDocument::Place ConfigDocument::place_of(std::string key) const {
  for (;; key = parent_of(key)) {
    const auto found = places_.find(key);
    if (found != places_.end()) return found->second;
  }
}

std::set<std::string> ConfigDocument::keys_of_causes() const {
  std::set<std::string> keys;
  for (const Problem& problem : problems_) {
    if (!problem.consequence) keys.insert(problem.key);
  }
  return keys;
}

}  // namespace flinch
