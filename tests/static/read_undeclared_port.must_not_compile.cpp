// expect: names more or fewer values than the function takes
// A function that takes a value which its declaration does not name.
#include "systems/framework/system.h"

class Block final : public flinch::System {
 public:
  flinch::InputPort<double> a = input<double>("a");
  flinch::InputPort<double> b = input<double>("b");
#ifdef FLINCH_CONTROL_CASE
  flinch::OutputPort<double> sum = output<&Block::add>("sum", a, b);
#else
  flinch::OutputPort<double> sum = output<&Block::add>("sum", a);
#endif
 private:
  double add(double left, double right) const { return left + right; }
};
