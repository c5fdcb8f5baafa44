#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "systems/config/read_value.h"

namespace flinch {

struct ConfigNode;

/// A key of a scenario and the values that a command line gives it.
struct KeyValues {
  std::string key;
  std::vector<std::shared_ptr<const ConfigNode>> values;  ///< whose file is what was typed
};

/// "KEY=VALUE,VALUE,...", each value as YAML, or a range of numbers: "20..400:20" steps by 20 up to 400 at
/// most, "1..1000:*10" multiplies. Throws SetupError with `--set` and the text where it is not of that form.
KeyValues parse_key_values(const std::string& text);

/// The same as a scenario with the values `read` takes it: a key without its unit is in SI, a number for
/// a list of numbers stands for each of them.
KeyValues as_read(KeyValues given, const std::vector<ReadValue>& read);

/// What a scenario of these nodes reads.
using ValuesOf = std::function<std::vector<ReadValue>(const std::shared_ptr<const ConfigNode>& root)>;

/// The nodes of a scenario file with one value for each key of `set`, "KEY=VALUE", as_read() of what
/// `values_of` says; where that throws, as they are. Throws SetupError with all that is wrong with the file
/// as YAML and with `set`; whether the scenario takes the values, parse_scenario() says.
std::shared_ptr<const ConfigNode> scenario_with(const std::filesystem::path& file,
                                                const std::vector<std::string>& set,
                                                const ValuesOf& values_of);

}  // namespace flinch
