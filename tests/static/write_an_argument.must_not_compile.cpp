// expect: only the last argument may be written
// A function that could write to a value which it is to read.
#include "systems/framework/system.h"

class Block final : public flinch::System {
 public:
  flinch::InputPort<double> in = input<double>("in");
  flinch::OutputPort<double> out = output<&Block::spoil>("out", in);

 private:
#ifdef FLINCH_CONTROL_CASE
  void spoil(const double& read, double& result) const { result = read; }
#else
  void spoil(double& read, double& result) const { result = read = 1.0; }
#endif
};
