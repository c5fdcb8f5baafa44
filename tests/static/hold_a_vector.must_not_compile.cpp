// expect: copies may allocate
// A port whose values are copied by way of the heap.
#include <vector>

#include "systems/framework/system.h"

#ifdef FLINCH_CONTROL_CASE
using Value = double;
#else
using Value = std::vector<double>;
#endif

class Block final : public flinch::System {
  flinch::InputPort<Value> in_ = input<Value>("in");
};
