#include "diagrams/control_stages.h"

#include <gmock/gmock.h>

#include "systems/foundation/setup_error.h"
#include "systems/framework/constant.h"
#include "tests/diagrams/contact_rig.h"

namespace flinch {
namespace {

using enum ReactionMode;
using test::Bench;
using test::collision;
using test::RigExperiment;
using testing::ElementsAre;
using testing::HasSubstr;

/// A momentum observer with a gain of its own.
WrenchEstimator momentum_observer(const std::string& name, double gain) {
  return {name, [gain](const StageContext& site, const AcceleratedPorts& given) {
            MomentumObserverSettings settings = site.settings.momentum_observer;
            settings.gain.setConstant(site.robot->dof(), gain);
            auto& observer = site.builder.add<MomentumObserver>(site.name, site.robot, settings);
            site.builder.connect(given.platform, observer.platform);
            site.builder.connect(given.kinematics, observer.kinematics);
            site.builder.connect(given.dynamics, observer.dynamics);
            site.builder.connect(given.drive_torque, observer.torque);
            return observer.wrench;
          }};
}

const OutputPort<WrenchEstimate>& other_wrench(const Bench& rig, const std::string& name) {
  for (const auto& other : rig.control.others.wrenches) {
    if (other.name == name) return other.port;
  }
  throw SetupError("there is no " + name);
}

// ---------------------------------------------------------------- side by side

TEST(ControlStages, WhatIsNotFollowedChangesNoBit) {
  RigExperiment accompanied = collision(0.5);
  accompanied.control.stages.estimators.add(momentum_observer("fast", 200.0));
  accompanied.control.stages.reaction_laws.add({"backwards", standard_stages().nominal_laws.all[0].add});
  Bench alone(collision(0.5)), together(accompanied);
  for (int tick = 0; tick < 1500; ++tick) {
    alone.tick(), together.tick();
    ASSERT_EQ(alone.torque().torque, together.torque().torque);
    ASSERT_EQ(alone.state().mode, together.state().mode);
  }
  EXPECT_EQ(together.state().mode, hold);
}

TEST(ControlStages, AnEstimatorSeesTheSameWhetherItIsFollowedOrNot) {
  RigExperiment followed, beside;
  for (RigExperiment* each : {&followed, &beside}) {
    each->station.encoder_noise = test::encoder_noise;
    // The gate opens when the followed estimate is valid: that shall be at the same tick for both robots.
    each->control.momentum_observer.input_settling_time = 250ms;
  }
  followed.control.stages.estimators.follow(momentum_observer("fast", 200.0));
  beside.control.stages.estimators.add(momentum_observer("fast", 200.0));
  Bench first(followed), second(beside);
  for (Bench* rig : {&first, &second}) {
    rig->run(300ms);
    rig->push(Eigen::Vector3d(5.0, 0.0, 0.0));
    rig->run(20ms);
  }
  ASSERT_EQ(first.context.get(first.station.motion), second.context.get(second.station.motion));
  const PlatformVector fast = first.context.get(first.control.wrench_estimate).wrench_in_base;
  const PlatformVector slow = second.context.get(second.control.wrench_estimate).wrench_in_base;
  EXPECT_EQ(fast, second.context.get(other_wrench(second, "wrench_fast")).wrench_in_base);
  EXPECT_EQ(slow, first.context.get(other_wrench(first, "wrench_momentum_observer")).wrench_in_base);
  // The gain's first-order answer to a step of 5 N, behind the filter of the velocity.
  EXPECT_GT(fast[0], 4.0);
  EXPECT_LT(slow[0], 2.0);
}

TEST(ControlStages, TheDetectorActsOnTheFollowedEstimator) {
  const auto detected = [](bool fast) {
    RigExperiment experiment = collision(0.5);
    if (fast) experiment.control.stages.estimators.follow(momentum_observer("fast", 200.0));
    Bench rig(experiment);
    EXPECT_TRUE(rig.run_until(react, 3s));
    return rig.state().since;
  };
  EXPECT_LT(detected(true), detected(false));
}

// ---------------------------------------------------------------- stages of one's own

/// Says as its wrench what it has been given of the things that may be missing.
class Inventory final : public System {
 public:
  InputPort<ImuReading> imu = input<ImuReading>("imu");
  InputPort<PlatformAcceleration> acceleration = input<PlatformAcceleration>("acceleration");
  OutputPort<WrenchEstimate> wrench = output<&Inventory::list>("wrench", imu, acceleration);

  static WrenchEstimator stage() {
    return {"inventory", [](const StageContext& site, const AcceleratedPorts& given) {
              auto& block = site.builder.add<Inventory>(site.name);
              site.builder.connect(given.imu, block.imu);
              site.builder.connect(given.acceleration, block.acceleration);
              return block.wrench;
            }};
  }

 private:
  WrenchEstimate list(const ImuReading& reading, const PlatformAcceleration& rates) const {
    WrenchEstimate found;
    found.valid = true;
    found.wrench_in_base = Eigen::Vector3d(reading.valid ? 1.0 : 0.0, rates.valid ? 1.0 : 0.0, 0.0);
    return found;
  }
};

TEST(ControlStages, WhatAStationHasNotIsNoData) {
  RigExperiment experiment;
  experiment.control.stages.estimators.add(Inventory::stage());
  Bench rig(experiment);  // its station has no IMU, and there is no source of acceleration
  rig.tick();
  EXPECT_EQ(rig.context.get(other_wrench(rig, "wrench_inventory")).wrench_in_base,
            PlatformVector(Eigen::Vector3d::Zero()));
}

TEST(ControlStages, AnAccelerationIsGivenToEstimatorsAndShown) {
  RigExperiment experiment;
  PlatformAcceleration known;
  known.valid = true;
  known.acceleration = Eigen::Vector3d(1.0, 2.0, 3.0);
  experiment.control.stages.accelerations.add(
      {"known", [known](const StageContext& site, const MotionPorts&) {
         return site.builder.add<Constant<PlatformAcceleration>>(site.name, known).value;
       }});
  experiment.control.stages.estimators.add(Inventory::stage());
  Bench rig(experiment);
  rig.tick();
  EXPECT_EQ(rig.context.get(other_wrench(rig, "wrench_inventory")).wrench_in_base[1], 1.0);
  ASSERT_EQ(rig.control.others.accelerations.size(), 1U);
  EXPECT_EQ(rig.control.others.accelerations[0].name, "acceleration");
  EXPECT_EQ(rig.context.get(rig.control.others.accelerations[0].port).acceleration, known.acceleration);
}

/// Stands still and says that it has arrived.
class Freeze final : public System {
 public:
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<JointMotion> joints = input<JointMotion>("joints");
  OutputPort<TorqueCommand> torque = output<&Freeze::brake>("torque", clock, joints);
  OutputPort<PlatformReference> reference = output<&Freeze::stay>("reference", kinematics);

 private:
  TorqueCommand brake(Time now, const JointMotion& motion) const {
    return {.computed = now, .valid = motion.valid, .torque = -20.0 * motion.velocity};
  }
  PlatformReference stay(const Kinematics& at) const {
    const PlatformVector rest = PlatformVector::Zero(at.velocity.size());
    return {.valid = at.valid, .finished = true, .pose = at.pose, .velocity = rest, .acceleration = rest};
  }
};

TEST(ControlStages, AReactionLawOfOnesOwnHasTheTorque) {
  RigExperiment experiment = collision(0.5);
  experiment.control.stages.reaction_laws.follow(
      {"freeze", [](const StageContext& site, const ReactionPorts& given) -> LawPorts {
         auto& freeze = site.builder.add<Freeze>(site.name);
         site.builder.connect(given.kinematics, freeze.kinematics);
         site.builder.connect(given.joint_motion, freeze.joints);
         return {.torque = freeze.torque, .reference = freeze.reference};
       }});
  Bench rig(experiment);
  ASSERT_TRUE(rig.run_until(react, 3s));
  EXPECT_TRUE(rig.run_until(hold, 5ms));  // it arrives at once, where the retraction takes its time
  rig.run(500ms);
  const JointMotion& motion = rig.context.get(rig.control.joint_motion);
  EXPECT_LT((rig.torque().torque + 20.0 * motion.velocity).norm(), 1e-12);
  ASSERT_EQ(rig.control.others.torques.size(), 1U);
  EXPECT_EQ(rig.control.others.torques[0].name, "torque_retraction");
}

/// Detects nothing.
class Numb final : public System {
 public:
  InputPort<WrenchEstimate> wrench = input<WrenchEstimate>("wrench");
  OutputPort<ContactDetection> contact = output<&Numb::ignore>("contact", wrench);

 private:
  ContactDetection ignore(const WrenchEstimate& estimate) const {
    ContactDetection nothing;
    nothing.valid = estimate.valid;
    return nothing;
  }
};

TEST(ControlStages, ADetectorOfOnesOwnDecides) {
  RigExperiment experiment = collision(0.5);
  experiment.control.stages.detectors.follow(
      {"numb", [](const StageContext& site, const EstimatePorts& given) {
         auto& numb = site.builder.add<Numb>(site.name);
         site.builder.connect(given.wrench, numb.wrench);
         return numb.contact;
       }});
  Bench rig(experiment);
  EXPECT_FALSE(rig.run_until(react, 1500ms));
  ASSERT_EQ(rig.control.others.detections.size(), 1U);
  EXPECT_EQ(rig.control.others.detections[0].name, "detection_contact_detector");
  EXPECT_NE(rig.context.get(rig.control.others.detections[0].port).level, ContactLevel::none);
}

// ---------------------------------------------------------------- mistakes

TEST(ControlStages, AreRefusedWithAllThatIsWrong) {
  EXPECT_THAT(problems(standard_stages()), testing::IsEmpty());
  ControlStages stages = standard_stages();
  stages.velocities.all.clear();
  stages.estimators.add(momentum_observer("momentum_observer", 20.0));
  stages.detectors.followed = "contact_detecter";
  stages.nominal_laws.all[0].add = nullptr;
  stages.reaction_laws.all[0].name = "a/b";
  EXPECT_THAT(problems(stages),
              ElementsAre(HasSubstr("there must be a velocity source"), HasSubstr("two wrench estimators"),
                          "the detector to follow is 'contact_detecter', which does not run; did you mean "
                          "'contact_detector'?",
                          HasSubstr("'nominal_impedance' has no function"), HasSubstr("letters, digits")));
  RigExperiment experiment;
  experiment.control.stages = stages;
  EXPECT_THROW(Bench{experiment}, SetupError);
}

}  // namespace
}  // namespace flinch
