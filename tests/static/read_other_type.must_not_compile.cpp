// expect: names a value of another type than the function takes
// A function that takes another type than the port which its declaration names carries.
#include "systems/framework/system.h"

class Block final : public flinch::System {
 public:
#ifdef FLINCH_CONTROL_CASE
  flinch::InputPort<double> in = input<double>("in");
#else
  flinch::InputPort<float> in = input<float>("in");
#endif
  flinch::OutputPort<double> out = output<&Block::twice>("out", in);

 private:
  double twice(double value) const { return 2.0 * value; }
};
