#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "systems/framework/place.h"
#include "systems/framework/recording.h"
#include "systems/framework/time.h"
#include "systems/framework/unit_table.h"
#include "systems/framework/value_type.h"

namespace flinch {

class Context;
class Diagram;

/// Copies the values of chosen ports, tick by tick, into memory that it allocates beforehand.
class Recorder {
 public:
  /// `paths` name ports of `diagram` (Diagram::taps() lists them). At most `capacity` samples fit; of later
  /// ones only the number is kept. `units` says what fields mean that give the name of a quantity as their
  /// unit. Throws SetupError for unknown paths, for ports whose type has no fields, and for quantities that
  /// `units` does not have.
  Recorder(const Diagram& diagram, const std::vector<std::string>& paths, std::size_t capacity,
           const UnitTable& units = {}, Every every = Every{});

  /// Records one sample when it is due. Never allocates.
  void record(const Context& context);

  /// Forgets all samples.
  void clear();

  std::size_t samples() const { return time_ns_.size(); }
  /// Samples that did not fit.
  std::int64_t dropped() const { return dropped_; }

  /// All that was recorded, with `attributes` saying what made it.
  Recording recording(std::map<std::string, std::string> attributes = {}) const;

 private:
  struct Channel {
    Place place;
    const ValueType* type;
    Signal signal;
  };

  Every every_;
  std::size_t capacity_;
  std::vector<Channel> channels_;
  std::vector<std::int64_t> time_ns_;
  std::int64_t dropped_ = 0;
};

/// The paths of all ports of `diagram` that can be recorded, its own inputs included; intermediate results
/// are left out.
std::vector<std::string> recordable_paths(const Diagram& diagram);

}  // namespace flinch
