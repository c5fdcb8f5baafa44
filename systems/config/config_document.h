#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "systems/config/config_node.h"
#include "systems/config/read_value.h"
#include "systems/config/unit.h"

namespace flinch {

/// A key that a reader asked for.
struct WantedKey {
  std::string name;
  Unit unit;
  bool required = false;
  bool found = false;
  std::vector<std::string> words = {};  ///< one of which must stand there; none: it is no such choice

  std::string with_si_unit() const { return key_with_unit(name, unit.key); }
};

/// Where something stands: a file, or what else gave it, and a line; 0: none.
struct SourceLocation {
  const std::string* file = nullptr;  ///< Lives as long as the document.
  int line = 0;

  std::string text() const { return line > 0 ? *file + ":" + std::to_string(line) : *file; }
};

/// A mapping while it is read: what was asked for, and which entries that took.
struct ConfigSection {
  const ConfigNode* node = nullptr;  ///< Null: the file does not have it, and nothing in it is required.
  std::string path;                  ///< "legs[1]"; empty for the whole file.
  SourceLocation place;
  std::vector<WantedKey> wanted;
  std::vector<char> taken;  ///< One for each entry: 1 once it was asked for.

  std::string path_of(std::string_view key) const;
};

/// Where the value of a key stands.
struct FoundValue {
  const ConfigNode* node = nullptr;  ///< Null: not in the file.
  const KeyUnit* unit = nullptr;     ///< In which it was written.
  std::string key;                   ///< Path without unit.
  std::string written;               ///< Path as in the file.
  SourceLocation place;
};

/// A file while it is read: its sections, the values that were read, and all problems so far. The engine
/// behind ConfigReader.
class ConfigDocument {
 public:
  ConfigDocument(std::string file, std::shared_ptr<const ConfigNode> root);

  const std::string& file() const { return file_; }
  ConfigSection& root() { return sections_.front(); }
  /// The mapping at a path, null for one that is not in the file. Its address stays the same.
  ConfigSection& add_section(const ConfigNode* node, std::string path, SourceLocation place);

  /// Finds and takes the value called `name`, in any unit of that quantity. Absent and required is a problem.
  /// `words`: those that may stand there, if they are few.
  FoundValue find(ConfigSection& section, std::string_view name, const Unit& unit, bool required,
                  const std::vector<std::string>& words = {});

  /// Whether there is such a key, without a unit; it is known from now on, but not taken.
  bool has(ConfigSection& section, std::string_view name);

  void add_value(const FoundValue& found, std::string value, const Unit& unit);
  /// Where a list of sections stands, for problems of the list.
  void add_list(const FoundValue& found);
  void add_problem(const FoundValue& found, const std::string& complaint);
  /// A problem of the value or section called `key`, told unless that has a problem of its own.
  void add_consequence(const std::string& key, const std::string& complaint);
  void add_foreign(const std::vector<std::string>& problems);

  bool good() const { return problems_.empty() && !incomplete_; }
  /// Throws SetupError with all problems in order of lines, KeyError where keys are among them; otherwise
  /// the values in order of reading.
  std::vector<ReadValue> finish();

 private:
  struct Problem {
    SourceLocation place;
    std::string key;   ///< Without unit.
    std::string text;  ///< With place and key.
    bool consequence = false;
    bool of_key = false;  ///< which no value would mend
  };
  struct Place {
    std::string written;
    SourceLocation at;
  };

  void add(SourceLocation place, std::string key, const std::string& written, const std::string& complaint,
           bool consequence = false);
  void add_wrong_key(SourceLocation place, std::string key, const std::string& written,
                     const std::string& complaint);
  void report_repeated(ConfigSection& section);
  void report_left_over(ConfigSection& section);
  void report_missing(const ConfigSection& section);
  Place place_of(std::string key) const;
  SourceLocation place_of(const ConfigSection& section, const ConfigNode::Entry& entry) const;
  std::set<std::string> keys_of_causes() const;

  std::string file_;
  std::shared_ptr<const ConfigNode> root_;
  std::deque<ConfigSection> sections_;
  std::map<std::string, ConfigSection*> by_path_;
  std::vector<ReadValue> values_;
  std::map<std::string, Place> places_;  ///< By key, without unit: of the first that was read.
  std::vector<Problem> problems_;
  std::vector<std::string> foreign_;
  bool incomplete_ = false;  ///< A required key was not found.
};

}  // namespace flinch
