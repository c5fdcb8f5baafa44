// expect: connect
// Connecting what only the functions of one block are to read.
#include "systems/framework/diagram_builder.h"

struct Block final : flinch::System {
  flinch::InputPort<double> in = input<double>("in");
#ifdef FLINCH_CONTROL_CASE
  flinch::OutputPort<double> half = output<&Block::halve>("half", in);
#else
  flinch::Intermediate<double> half = intermediate<&Block::halve>("half", in);
#endif
  double halve(double value) const { return 0.5 * value; }
};

void wire(flinch::DiagramBuilder& builder, Block& one, Block& other) { builder.connect(one.half, other.in); }
