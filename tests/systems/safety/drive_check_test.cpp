#include "systems/safety/drive_check.h"
#include "systems/robot/decompositions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram_builder.h"
#include "tests/support/allocations.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

using Phase = DriveCheckStatus::Phase;

/// A robot that is held at rest, whose drives make so much of their torques, integrated in steps of a
/// hundredth of a tick by itself.
class Trial {
 public:
  explicit Trial(const Eigen::Vector3d& gain, const DriveCheckSettings& settings = {})
      : gain_(gain), block_(builder_.add<DriveCheck>("check", test::planar_rig(), settings)) {}

  void tick() {
    JointReading reading = here_.joints;
    reading.active += displacement_;
    ticking_.set(joints_, reading);
    ticking_.set(command_, TorqueCommand{.computed = {}, .valid = true, .torque = holding_});
    ticking_.set(kinematics_, here_.kinematics);
    ticking_.set(dynamics_, here_.dynamics);
    ticking_.set(reaction_, ReactionState{.mode = mode, .previous = ReactionMode::stopped, .since = {}});
    ticking_.set(reference_, PlatformReference{true, rests, {}, {}, {}});
    ticking_.tick();
    move(torque() - holding_);
    if (mode != ReactionMode::nominal) rate_.setZero();  // whatever leads there brings it to rest
  }

  DriveCheckStatus ends_after(int ticks) {
    for (int k = 0; k < ticks; ++k) tick();
    return status();
  }

  Eigen::Vector3d torque() const { return ticking_.get(block_.torque).torque; }
  DriveCheckStatus status() const { return ticking_.get(block_.status); }

  ReactionMode mode = ReactionMode::nominal;
  bool rests = true;
  double friction = 0.0;  ///< Coulomb's, of each drive [Nm]

 private:
  void move(const Eigen::Vector3d& torque) {
    const Eigen::Matrix3d to_drives = here_.kinematics.J_qa_x;
    const Eigen::Matrix3d mass = here_.dynamics.M_x;
    const Eigen::Matrix3d inverse = to_drives * mass.inverse() * to_drives.transpose();
    for (int step = 0; step < 100; ++step) {
      const Eigen::Vector3d held = friction * (rate_.array() / 1e-3).tanh();
      rate_ += 1e-5 * inverse * (gain_.cwiseProduct(torque) - held);
      displacement_ += 1e-5 * rate_;
    }
  }

  Eigen::Vector3d gain_, rate_ = Eigen::Vector3d::Zero(), displacement_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d holding_{1.0, -2.0, 0.5};
  test::Posture here_{*test::planar_rig()};
  DiagramBuilder builder_;
  DriveCheck& block_;
  InputPort<TorqueCommand> command_ = builder_.export_input("command", block_.command);
  InputPort<JointReading> joints_ = builder_.export_input("joints", block_.joints);
  InputPort<Kinematics> kinematics_ = builder_.export_input("kinematics", block_.kinematics);
  InputPort<Dynamics> dynamics_ = builder_.export_input("dynamics", block_.dynamics);
  InputPort<ReactionState> reaction_ = builder_.export_input("reaction", block_.reaction);
  InputPort<PlatformReference> reference_ = builder_.export_input("reference", block_.reference);
  test::Ticking ticking_{builder_};
};

constexpr int whole = 150;  // ticks that three drives need

TEST(DriveCheck, PassesDrivesThatDoWhatTheyAreToldAndTellsTheirGains) {
  const DriveCheckStatus status = Trial({1.0, 1.0, 1.0}).ends_after(whole);
  EXPECT_EQ(status.phase, Phase::passed);
  EXPECT_FALSE(status.holds_motion());
  EXPECT_TRUE(status.gain.isApprox(Eigen::Vector3d::Ones(), 0.02)) << status.gain.transpose();
}

TEST(DriveCheck, FindsTheGainOfEachDrive) {
  const Eigen::Vector3d gain(0.6, 1.3, 0.9);
  const DriveCheckStatus status = Trial(gain).ends_after(whole);
  EXPECT_EQ(status.phase, Phase::passed);
  EXPECT_TRUE(status.gain.isApprox(gain, 0.03)) << status.gain.transpose();
}

TEST(DriveCheck, FailsOnADriveOfTheWrongSignOrADeadOneOrOneOfFourTimesTheTorque) {
  for (const double wrong : {-1.0, 0.0, 0.2, 4.0}) {
    for (int drive = 0; drive < 3; ++drive) {
      Eigen::Vector3d gain = Eigen::Vector3d::Ones();
      gain[drive] = wrong;
      const DriveCheckStatus status = Trial(gain).ends_after(whole);
      EXPECT_EQ(status.phase, Phase::failed) << wrong;
      EXPECT_EQ(status.drive, drive);
      EXPECT_NEAR(status.gain[drive], wrong, 0.05 + 0.03 * std::abs(wrong));
      EXPECT_TRUE(status.holds_motion());
    }
  }
}

TEST(DriveCheck, PassesWithFrictionOfAFifthOfItsTorque) {
  Trial trial({1.0, 1.0, 1.0});
  trial.friction = 2.4;
  const DriveCheckStatus status = trial.ends_after(whole);
  EXPECT_EQ(status.phase, Phase::passed) << status.gain.transpose();
}

TEST(DriveCheck, MovesTheRobotLittleAndLeavesTheLawsTorquesAlone) {
  Trial trial({1.0, 1.0, 1.0});
  trial.tick();
  EXPECT_EQ(trial.torque(), Eigen::Vector3d(1.0, -2.0, 0.5));
  double most = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = 0; k < whole; ++k) {
    trial.tick();
    const Eigen::Vector3d added = trial.torque() - Eigen::Vector3d(1.0, -2.0, 0.5);
    most = std::max(most, added.lpNorm<1>());
    sum += added;
  }
  EXPECT_NEAR(most, 12.0, 1e-9);  // one drive at a time
  EXPECT_NEAR(sum.norm(), 0.0, 1e-9);
  EXPECT_EQ(trial.torque(), Eigen::Vector3d(1.0, -2.0, 0.5));
}

TEST(DriveCheck, WaitsUntilTheRobotIsHeldAtRest) {
  Trial trial({1.0, 1.0, 1.0});
  trial.mode = ReactionMode::stopped;
  EXPECT_EQ(trial.ends_after(100).phase, Phase::waiting);
  trial.mode = ReactionMode::nominal;
  trial.rests = false;
  EXPECT_EQ(trial.ends_after(100).phase, Phase::waiting);
  trial.rests = true;
  EXPECT_EQ(trial.ends_after(20).phase, Phase::running);
}

TEST(DriveCheck, TellsNoGainOfADriveThatItHasNotTried) {
  Trial trial({1.0, 0.9, 1.0});
  const DriveCheckStatus status = trial.ends_after(70);
  EXPECT_EQ(status.drive, 1);
  EXPECT_NEAR(status.gain[0], 1.0, 0.02);
  EXPECT_TRUE(std::isnan(status.gain[1]) && std::isnan(status.gain[2]));
}

TEST(DriveCheck, BeginsAnewAfterWhatInterruptedIt) {
  Trial trial({1.0, 1.0, 1.0});
  EXPECT_EQ(trial.ends_after(70).drive, 1);
  trial.mode = ReactionMode::react;
  EXPECT_EQ(trial.ends_after(10).phase, Phase::waiting);
  trial.mode = ReactionMode::nominal;
  EXPECT_EQ(trial.ends_after(20).drive, 0);
  EXPECT_EQ(trial.ends_after(whole).phase, Phase::passed);
}

TEST(DriveCheck, IsToldToHaveFailedUntilTheLawsTorquesAreShutOut) {
  Trial trial({1.0, 0.0, 1.0});
  EXPECT_EQ(trial.ends_after(whole).phase, Phase::failed);
  trial.mode = ReactionMode::stopped;
  EXPECT_EQ(trial.ends_after(2).phase, Phase::waiting);
  EXPECT_NEAR(trial.status().gain[1], 0.0, 0.05);
}

TEST(DriveCheck, RefusesSettingsThatCheckNothing) {
  for (const DriveCheckSettings& settings :
       {DriveCheckSettings{.torque = 0.0}, DriveCheckSettings{.least_gain = 0.0},
        DriveCheckSettings{.most_gain = 1.0}})
    EXPECT_THROW(DriveCheck(test::planar_rig(), settings), SetupError);
}

TEST(DriveCheck, NeverAllocates) {
  Trial trial({1.0, 1.0, 1.0});
  trial.tick();
  const test::AllocationCounter counter;
  for (int k = 0; k < 60; ++k) trial.tick();
  EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace flinch
