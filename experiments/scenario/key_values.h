#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace flinch {

struct ConfigNode;

/// A key of a scenario and the values that a command line gives it.
struct KeyValues {
  std::string key;
  std::vector<std::shared_ptr<const ConfigNode>> values;  ///< whose file is what was typed
};

/// "KEY=VALUE,VALUE,...", each value as YAML. Throws SetupError naming `--set` and the text where it is not
/// of that form.
KeyValues parse_key_values(const std::string& text);

/// The nodes of a scenario file with one value for each key of `set`, "KEY=VALUE". Throws SetupError with
/// all that is wrong with the file as YAML and with `set`; whether the scenario takes the values,
/// parse_scenario() says.
std::shared_ptr<const ConfigNode> scenario_with(const std::filesystem::path& file,
                                                const std::vector<std::string>& set);

}  // namespace flinch
