#include "plant/simulated_instrument.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "systems/foundation/setup_error.h"
#include "systems/framework/constant.h"
#include "systems/framework/diagram_builder.h"
#include "tests/plant/rig_scene.h"

namespace flinch {
namespace {

const std::vector<RopePull> pulls = {RopePull{
    .body = 1, .peak_in_base = {30.0, -20.0, 0.0}, .start = 0s, .rise = 0s, .hold = 10s, .fall = 0s}};

/// What the instrument tells of the robot at home at the time `now`.
ForceTorqueReading reading_at(Time now, const SimulatedInstrumentSettings& settings) {
  const auto robot = test::individual_rig();
  DiagramBuilder builder("test", 1ms);
  PlantTruth truth;
  truth.valid = true;
  truth.pose = robot->home_pose();
  truth.velocity.setZero(3);
  auto& source = builder.add<Constant<PlantTruth>>("truth", truth);
  auto& instrument = builder.add<SimulatedInstrument>("instrument", settings, pulls, robot, 7);
  builder.connect(source.value, instrument.truth);
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  context.set_time(now);
  diagram->evaluate(context);
  return context.get(instrument.force_torque);
}

const std::vector<InstrumentMounting> mountings = {{.body = 1, .start = 1s}, {.body = 2, .start = 5s}};

TEST(SimulatedInstrument, TellsThePullAtTheBodyOnWhichItSits) {
  const SimulatedInstrumentSettings ideal{.ideal = true, .mountings = mountings};
  EXPECT_FALSE(reading_at(500ms, ideal).valid) << "it is not mounted yet";
  EXPECT_EQ(reading_at(2s, ideal).force_in_base, pulls[0].peak_in_base);
  EXPECT_TRUE(reading_at(6s, ideal).force_in_base.isZero()) << "it sits on another body";
}

TEST(SimulatedInstrument, ThatIsMountedAskewTurnsTheForce) {
  const SimulatedInstrumentSettings askew{
      .mountings = mountings, .force_noise = 0.0, .moment_noise = 0.0, .misalignment = 0.1};
  const SimulatedInstrument instrument(askew, pulls, test::individual_rig(), 7);
  const double angle = instrument.misalignments()[0].z();
  EXPECT_GT(std::abs(angle), 1e-4);
  EXPECT_LE(std::abs(angle), 0.1);
  const Eigen::Vector3d expected =
      Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitZ()) * pulls[0].peak_in_base;
  EXPECT_LT((reading_at(2s, askew).force_in_base - expected).norm(), 1e-9);
}

TEST(SimulatedInstrument, HasNoiseAndAZeroThatIsOff) {
  const SimulatedInstrumentSettings real{.mountings = mountings, .zero_offset = 1.0};
  const Eigen::Vector3d error = reading_at(2s, real).force_in_base - pulls[0].peak_in_base;
  EXPECT_GT(error.norm(), 1e-3);
  EXPECT_LT(error.norm(), 2.0);
}

TEST(SimulatedInstrument, RefusesABodyThatIsNotThere) {
  EXPECT_THROW(SimulatedInstrument({.mountings = {{.body = 9}}}, pulls, test::individual_rig(), 7),
               SetupError);
}

}  // namespace
}  // namespace flinch
