// expect: constraint
// Only numbers and vectors have derivatives.
#include "systems/framework/system.h"

#ifdef FLINCH_CONTROL_CASE
using Value = double;
#else
using Value = bool;
#endif

class Block final : public flinch::System {
  flinch::State<Value> x_ = state<Value>("x");
  flinch::Derivative rate_ = derivative<&Block::rate>(x_, x_);
  Value rate(Value x) const { return x; }
};
