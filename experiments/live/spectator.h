#pragma once

#include <map>
#include <string>

#include "systems/framework/diagram.h"
#include "systems/framework/recorder.h"
#include "systems/framework/time.h"
#include "systems/framework/unit_table.h"

namespace flinch {

/// Somebody who sees a run while it goes on. What he does changes nothing of what the run computes.
class Spectator {
 public:
  Spectator() = default;
  Spectator(const Spectator&) = delete;
  Spectator& operator=(const Spectator&) = delete;
  virtual ~Spectator() = default;

  /// Called once, before the first tick, by who runs `diagram`. `attributes` say what makes the run. Returns
  /// the recorder that shall see every tick; it lives as long as the spectator. May throw SetupError.
  virtual Recorder& begin(const Diagram& diagram, const UnitTable& units,
                          const std::map<std::string, std::string>& attributes) = 0;

  /// Called between two ticks of a run in simulated time. Returns when the tick at `next` may be computed.
  virtual void before_tick(Time next) = 0;
};

}  // namespace flinch
