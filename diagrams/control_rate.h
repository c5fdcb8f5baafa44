#pragma once

#include <string>
#include <vector>

namespace flinch {

struct ContactControlSettings;

/// A filter or observer that is faster than the ticks allow, by its key in the section `control`.
struct TooFast {
  std::string section;
  std::string key;
  std::string complaint;  ///< what follows its name: value, limit, way out
};

/// Those of `settings` whose bandwidth is above half of the rate. Of a sampled signal nothing is beyond that;
/// what a filter makes of it is no longer what its gain says.
std::vector<TooFast> too_fast_for_rate(const ContactControlSettings& settings);
/// The same, one sentence each.
std::vector<std::string> problems_of_rate(const ContactControlSettings& settings);

}  // namespace flinch
