#pragma once

#include <memory>
#include <string>

#include "systems/framework/diagram_builder.h"
#include "tests/support/blocks.h"

namespace flinch::test {

/// A counter and so many blocks behind it, each of which multiplies by 1.0001: as little work as a block can
/// have.
inline std::unique_ptr<Diagram> chain_of_gains(int blocks) {
  DiagramBuilder builder("chain");
  OutputPort<double> last = builder.add<Counter>("counter").count;
  for (int i = 0; i < blocks; ++i) {
    auto& gain = builder.add<Gain>("gain" + std::to_string(i), 1.0001);
    builder.connect(last, gain.in);
    last = gain.out;
  }
  return builder.build();
}

}  // namespace flinch::test
