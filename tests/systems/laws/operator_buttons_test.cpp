#include "systems/laws/operator_buttons.h"

#include <gtest/gtest.h>

#include <array>

#include "systems/framework/diagram_builder.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

struct Panel {
  Panel()
      : buttons(builder.add<OperatorButtons>("buttons")),
        input(builder.export_input("buttons", buttons.buttons)) {}

  DiagramBuilder builder;
  OperatorButtons& buttons;
  InputPort<OperatorCommand> input;
  test::Ticking ticking{builder};
};

TEST(OperatorButtons, AreEventsOnlyAtTheTickAtWhichTheyGoDown) {
  constexpr std::array held{false, true, true, true, false, false, true, false};
  constexpr std::array event{false, true, false, false, false, false, true, false};
  Panel panel;
  for (std::size_t k = 0; k < held.size(); ++k) {
    panel.ticking.set(panel.input, {.start = false, .reset = held[k]});
    panel.ticking.tick();
    EXPECT_EQ(panel.ticking.get(panel.buttons.reset).reset, event[k]) << k;
    EXPECT_FALSE(panel.ticking.get(panel.buttons.start).start) << k;
  }
}

TEST(OperatorButtons, DoNothingWhileHeldSinceTheBeginning) {
  Panel panel;
  for (int k = 0; k < 3; ++k) {
    panel.ticking.set(panel.input, {.start = true, .reset = true});
    panel.ticking.tick();
    EXPECT_FALSE(panel.ticking.get(panel.buttons.start).start);
    EXPECT_FALSE(panel.ticking.get(panel.buttons.reset).reset);
  }
}

TEST(OperatorButtons, AreIndependent) {
  Panel panel;
  panel.ticking.set(panel.input, {.start = false, .reset = false});
  panel.ticking.tick();
  panel.ticking.set(panel.input, {.start = false, .reset = true});
  panel.ticking.tick();
  panel.ticking.set(panel.input, {.start = true, .reset = true});
  panel.ticking.tick();
  EXPECT_TRUE(panel.ticking.get(panel.buttons.start).start);
  EXPECT_FALSE(panel.ticking.get(panel.buttons.reset).reset);
}

}  // namespace
}  // namespace flinch
