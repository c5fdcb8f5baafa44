#include "systems/framework/system.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <new>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/simulator.h"

namespace flinch {
namespace {

#include <comment_examples/system.h>

TEST(System, HasAnExampleInItsCommentThatDoesWhatItSays) {
  DiagramBuilder builder;
  auto& low_pass = builder.add<LowPass>("low_pass");
  const auto raw = builder.export_input("raw", low_pass.raw);
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  context.set(raw, 2.0);
  Simulator(*diagram).advance_to(context, 7ms);
  EXPECT_NEAR(context.get(low_pass.smooth), 2.0 * (1.0 - std::pow(0.9, 7)), 1e-15);
}

// What the compiler warns of, where warnings are on: a member is read that is declared below.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuninitialized"
class Late final : public System {
 public:
  OutputPort<double> out = output<&Late::read>("out", below_);

 private:
  State<double> below_ = state<double>("below");
  double read(double value) const { return value; }
};
#pragma GCC diagnostic pop

TEST(System, RefusesAFunctionThatReadsAStateDeclaredBelowIt) {
  // Whatever stands in the memory of a handle that does not exist yet.
  for (const int byte : {0x00, 0x01, 0x03, 0x7f, 0xff}) {
    alignas(Late) std::array<std::byte, sizeof(Late)> memory;
    std::memset(memory.data(), byte, memory.size());
    EXPECT_THROW(new (memory.data()) Late, SetupError) << byte;
  }
}

TEST(System, RefusesAFunctionThatReadsAPortOfAnotherBlock) {
  class Other final : public System {
   public:
    InputPort<double> in = input<double>("in");
  };
  class Thief final : public System {
   public:
    explicit Thief(const Other& other) { output<&Thief::read>("out", other.in); }
    double read(double value) const { return value; }
  };
  const Other other;
  EXPECT_THROW(Thief{other}, SetupError);
}

TEST(System, RefusesAFunctionOfAnotherBlock) {
  class Other final : public System {
   public:
    double half(double value) const { return 0.5 * value; }
  };
  class Borrower final : public System {
    State<double> state_ = state<double>("state");

   public:
    explicit Borrower(int which) {
      if (which == 0) output<&Other::half>("out", state_);
      if (which == 1) update<&Other::half>(state_, state_);
      if (which == 2) derivative<&Other::half>(state_, state_);
    }
  };
  for (const int which : {0, 1, 2}) EXPECT_THROW(Borrower{which}, SetupError) << which;
  EXPECT_NO_THROW(Borrower{3});
}

}  // namespace
}  // namespace flinch
