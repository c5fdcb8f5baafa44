#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "systems/config/range.h"
#include "systems/config/read_value.h"
#include "systems/config/unit.h"

namespace flinch {

class ConfigDocument;
struct ConfigNode;
struct ConfigSection;

/// A YAML file, or a section of it, that fills a struct of settings and notes all that is wrong:
///
///   Pylon read_pylon(const std::filesystem::path& file) {
///     Pylon pylon;
///     ConfigReader reader = ConfigReader::open(file);
///     reader.required().number("radius", unit::m, pylon.radius, positive);  // radius_m or radius_mm
///     reader.number("stiffness", unit::N_per_m, pylon.stiffness, positive);
///     reader.choice("shape", pylon.shape, {{"round", Shape::round}, {"square", Shape::square}});
///     reader.finish();
///     return pylon;
///   }
///
/// The unit of a quantity ends its key; the value arrives in SI. A function leaves its `value` as it is,
/// which is then the default, where the file is silent or what stands there is wrong. Problems are collected,
/// each as "file:line: key: what was found; what would be right", and thrown by `finish`.
///
/// Copies read the same file and collect into the same list.
class ConfigReader {
 public:
  /// Throws SetupError if there is no such file (the nearest name in its folder is told), if it is not
  /// readable, not YAML, empty, or not a mapping.
  static ConfigReader open(const std::filesystem::path& file);
  /// The same for text that came from `file`.
  static ConfigReader parse(std::string_view text, const std::string& file);
  /// The same for nodes that were read from `file`, or made of such.
  static ConfigReader over(std::shared_ptr<const ConfigNode> root, const std::string& file);

  /// The same section, read by functions to which an absent key is a problem. Not handed on to sections.
  ConfigReader required() const;

  /// A finite number, written in any unit of the quantity whose SI unit is `unit`.
  void number(std::string_view name, const Unit& unit, double& value, const Range& range = any_number);
  /// The same for a quantity that may have no value at all; "none" in the list of values.
  void number(std::string_view name, const Unit& unit, std::optional<double>& value,
              const Range& range = any_number);
  /// A list of exactly as many numbers as `values` has.
  void numbers(std::string_view name, const Unit& unit, std::span<double> values,
               const Range& range = any_number);
  /// A list of one number or more.
  void numbers(std::string_view name, const Unit& unit, std::vector<double>& values,
               const Range& range = any_number);
  /// One number, or a list of `count`, or of one or more where that is not known. `values` has as many.
  void one_or_numbers(std::string_view name, const Unit& unit, std::vector<double>& values,
                      std::optional<std::size_t> count, const Range& range = any_number);
  /// A time, rounded to nanoseconds; `range` in s.
  void duration(std::string_view name, std::chrono::nanoseconds& value, const Range& range = any_number);
  /// A whole number, bounds included.
  void integer(std::string_view name, int& value, int least = std::numeric_limits<int>::min(),
               int most = std::numeric_limits<int>::max());
  /// The seed of a random sequence.
  void seed(std::string_view name, std::uint64_t& value);
  /// true or false.
  void flag(std::string_view name, bool& value);
  void text(std::string_view name, std::string& value);
  /// One of `known`.
  void word(std::string_view name, std::string& value, const std::vector<std::string>& known);
  /// A list of one word or more, each of them one of `known` and none twice.
  void words(std::string_view name, std::vector<std::string>& values, const std::vector<std::string>& known);
  /// A list of one value or more of any kind, as they stand there.
  void nodes(std::string_view name, std::vector<std::shared_ptr<const ConfigNode>>& values);
  /// Name of another file, relative to the folder of this one, which must exist.
  void file(std::string_view name, std::filesystem::path& value);
  /// One of several words. False where there is none to go on with: another word stands there, or nothing and
  /// `value` is none of them. Where other keys depend on it, leave_rest_unread() then.
  template <class Enum>
  bool choice(std::string_view name, Enum& value,
              std::initializer_list<std::pair<std::string_view, std::type_identity_t<Enum>>> words);

  /// Whether the key is there, without a unit: a section, a list of sections or a word.
  bool has(std::string_view name) const;
  /// Whether a mapping stands there, and not one word or number.
  bool has_section(std::string_view name) const;
  /// The keys that are there, as they are written; none of them is asked for by that.
  std::vector<std::string_view> keys() const;
  /// The one key of these that is there. None is a problem and gives "", several are and give the first.
  std::string_view one_of(std::initializer_list<std::string_view> names);

  /// A mapping within this one. Where it is absent or no mapping, all in it reads as absent and optional.
  ConfigReader section(std::string_view name);
  /// A list of mappings, one reader each; empty where it is absent.
  std::vector<ConfigReader> sections(std::string_view name);
  /// The same for exactly `count`; of a longer list the first `count`.
  std::vector<ConfigReader> sections(std::string_view name, std::size_t count);

  /// Lets `name` be, whatever stands there: what it says is for another reader. Nothing is wrong with it.
  void leave_unread(std::string_view name);
  /// The same for all keys of this section that nobody asks for.
  void leave_rest_unread();

  /// Notes that values do not fit together: `complaint` goes on after the name of a value, section or entry
  /// of a list that was read, as in problem("mass", "is 0 kg; it must be positive"); "" names this section.
  /// It is not told where that value itself is missing or wrong.
  void problem(std::string_view name, const std::string& complaint);
  /// Adds problems of another file, told as they are.
  void add_problems(const std::vector<std::string>& problems);

  /// Line on which this section begins.
  int line() const;
  /// No problem so far; keys that nobody asked for only show in `finish`.
  bool good() const;

  /// Call it once, after all has been read, on any copy. Throws SetupError with all problems, those of keys
  /// that nobody asked for included; otherwise every value that was read.
  std::vector<ReadValue> finish();

 private:
  ConfigReader(std::shared_ptr<ConfigDocument> document, ConfigSection& section)
      : document_(std::move(document)), section_(&section) {}

  std::optional<std::size_t> choose(std::string_view name, const std::vector<std::string>& words,
                                    std::optional<std::size_t> standard);
  void read_list(std::string_view name, const Unit& unit, std::vector<double>& values,
                 std::optional<std::size_t> count, const Range& range);
  std::vector<ConfigReader> read_sections(std::string_view name, std::optional<std::size_t> count);

  std::shared_ptr<ConfigDocument> document_;
  ConfigSection* section_;
  bool required_ = false;
};

template <class Enum>
bool ConfigReader::choice(
    std::string_view name, Enum& value,
    std::initializer_list<std::pair<std::string_view, std::type_identity_t<Enum>>> words) {
  std::vector<std::string> names;
  std::optional<std::size_t> standard;
  for (const auto& [word, meaning] : words) {
    if (meaning == value) standard = names.size();
    names.emplace_back(word);
  }
  const std::optional<std::size_t> chosen = choose(name, names, standard);
  if (chosen) value = words.begin()[*chosen].second;
  return chosen.has_value();
}

}  // namespace flinch
