#pragma once

#include <limits>

#include "systems/framework/system.h"
#include "tests/stations/station_script.h"

namespace flinch::test {

inline void spoil(JointReading& reading, double offset) { reading.active[1] += offset; }
inline void spoil(DriveReading& reading, double offset) { reading.current[1] += offset; }
inline void spoil(ImuReading& reading, double offset) { reading.specific_force[1] += offset; }
inline void spoil(StationStatus&, double) {}

/// Harms the readings of one source.
template <class Reading, Source source>
class ReadingInjector final : public System {
  State<Reading> last_ = System::state<Reading>("last");

 public:
  InputPort<Reading> in = System::input<Reading>("in");
  InputPort<Damage> damage = System::input<Damage>("damage");
  OutputPort<Reading> out = System::output<&ReadingInjector::harm>("out", in, damage, last_);

 private:
  Update keep_ = System::keep(last_, out);

  void harm(const Reading& reading, const Damage& wrong, const Reading& last, Reading& result) const {
    result = reading;
    if (wrong.source != source) return;
    switch (wrong.harm) {
      case Harm::lost:
        result = Reading();
        break;
      case Harm::stale:
        result.acquired -= 300ms;
        break;
      case Harm::not_a_number:
        spoil(result, std::numeric_limits<double>::quiet_NaN());
        break;
      case Harm::jump:
        spoil(result, 0.5);
        break;
      case Harm::frozen:
        result = last;
        result.acquired = reading.acquired;
        break;
    }
  }
};

}  // namespace flinch::test
