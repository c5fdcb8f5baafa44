// expect: copies may allocate
// A state whose matrix has a size that nothing bounds.
#include "systems/framework/system.h"

#ifdef FLINCH_CONTROL_CASE
using Value = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
#else
using Value = Eigen::VectorXd;
#endif

class Block final : public flinch::System {
  flinch::State<Value> x_ = state<Value>("x");
  flinch::Update keep_ = update<&Block::keep>(x_, x_);
  Value keep(const Value& x) const { return x; }
};
