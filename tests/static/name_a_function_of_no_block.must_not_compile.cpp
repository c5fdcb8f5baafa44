// expect: a function of a class that is no block
// A block that declares as its own what another class computes.
#include "systems/framework/system.h"

struct Other {
  double half(double value) const { return 0.5 * value; }
};

class Block final : public flinch::System {
 public:
  flinch::InputPort<double> in = input<double>("in");
#ifdef FLINCH_CONTROL_CASE
  flinch::OutputPort<double> out = output<&Block::half>("out", in);
#else
  flinch::OutputPort<double> out = output<&Other::half>("out", in);
#endif
  double half(double value) const { return 0.5 * value; }
};
