#include "experiments/served/served_bench.h"

#include <gtest/gtest.h>

#include "experiments/simulated/simulated_scenario.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/simulator.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

/// The bench of the square, told a wish and no torque.
class ServedSquare {
 public:
  ServedSquare()
      : bench_(build_served_bench(read_simulated_scenario(test::shipped("scenarios/square.yaml")), 5ms)),
        context_(bench_.diagram->make_context()) {}

  StationStatus after(Time duration, const RequestedDriveState& wish) {
    context_.set(bench_.station.wish, wish);
    Simulator simulator(*bench_.diagram, std::make_unique<SundialsIntegrator>());
    for (const Time end = context_.time() + duration; context_.time() < end;) {
      context_.set(bench_.station.torque_command,
                   {.computed = context_.time(), .valid = true, .torque = JointVector::Zero(3)});
      context_.set(bench_.station.brake, {.engage = false});
      simulator.step(context_);
    }
    return context_.get(bench_.station.status);
  }

 private:
  ServedBench bench_;
  Context context_;
};

TEST(ServedBench, StandsBehindClosedBrakesUntilItsDrivesAreSwitchedOn) {
  ServedSquare square;
  const StationStatus before = square.after(50ms, {});
  EXPECT_TRUE(before.valid && before.braked);
  EXPECT_FALSE(before.enabled);
  const StationStatus enabled =
      square.after(500ms, {.state = RequestedDriveState::State::operation_enabled, .engage_brake = false});
  EXPECT_TRUE(enabled.enabled);
  EXPECT_FALSE(enabled.braked);
  EXPECT_FALSE(square.after(500ms, {}).enabled);
}

}  // namespace
}  // namespace flinch
