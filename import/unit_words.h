#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace flinch {

/// What the words for a unit mean, in a log or in a mapping: "deg/s", "rpm", "[mA]".
struct UnitWord {
  enum class Quantity {
    angle,
    length,
    angular_velocity,
    velocity,
    acceleration,
    current,
    force,
    moment,
    time
  };
  std::string_view word;
  Quantity quantity;
  double to_si;  ///< factor
};

/// The unit of a word, whatever its brackets; none: it is no unit that is known.
std::optional<UnitWord> unit_word(std::string_view word);

/// Whether a cell below a name can be nothing else than a unit: also those of quantities that nobody reads.
bool is_unit_word(std::string_view word);

/// The unit in a name: "phi [deg]", "phi (deg)", "phi, deg", "phi_deg", "phi/deg"; "" where it has none.
std::string unit_in_name(std::string_view name);

/// All words of a quantity, with commas between them.
std::string unit_words(UnitWord::Quantity quantity);

}  // namespace flinch
