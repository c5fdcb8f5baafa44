// expect: connect
// Connecting ports whose values differ in type.
#include "systems/framework/constant.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/zero_order_hold.h"

void wire(flinch::DiagramBuilder& builder) {
  auto& source = builder.add<flinch::Constant<int>>("source", 1);
#ifdef FLINCH_CONTROL_CASE
  auto& sink = builder.add<flinch::ZeroOrderHold<int>>("sink");
#else
  auto& sink = builder.add<flinch::ZeroOrderHold<double>>("sink");
#endif
  builder.connect(source.value, sink.input);
}
