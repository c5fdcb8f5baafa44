// expect: keep
// A state that keeps a value of another type than its own.
#include "systems/framework/system.h"

class Block final : public flinch::System {
#ifdef FLINCH_CONTROL_CASE
  flinch::State<double> last_ = state<double>("last");
#else
  flinch::State<float> last_ = state<float>("last");
#endif
 public:
  flinch::InputPort<double> in = input<double>("in");

 private:
  flinch::Update keep_ = keep(last_, in);
};
