#include "plant/rig_plant.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <memory>
#include <utility>
#include <vector>

#include "systems/foundation/setup_error.h"
#include "systems/framework/runge_kutta.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/plant/integrate_rig.h"
#include "tests/plant/random_rig.h"
#include "tests/plant/servoed_station.h"

namespace flinch {
namespace {

SimulatedStationSettings station_with_pylon(double x, double y, double stiffness = 6000.0) {
  SimulatedStationSettings settings = test::rig_station();
  settings.rig.obstacles = {test::fixed_post(x, y, {.stiffness = stiffness})};
  return settings;
}

// ---------------------------------------------------------------- truth

TEST(PlantTruth, ClosesItsLoops) {
  test::ServoedStation station(station_with_pylon(0.32, 0.20));
  double worst = 0.0;
  int in_contact = 0;
  for (int k = 0; k < 3000; ++k) {
    station.step();
    ASSERT_TRUE(station.truth().valid);
    worst = std::max(worst, station.truth().loop_closure_error);
    in_contact += station.contact().in_contact ? 1 : 0;
  }
  std::cout << "loop closure: " << worst << " m, " << in_contact << " ms in contact\n";
  EXPECT_LT(worst, 1e-14);
  EXPECT_GT(in_contact, 100);
}

TEST(PlantTruth, AnglesTurnWithTheRatesOfTheKinematics) {
  test::ServoedStation station(test::rig_station());
  const PlanarRrr robot(rig_robot(RigGeometry::individual, RigFriction::none));
  station.advance_to(500ms);
  PlantTruth before = station.truth();
  for (int k = 0; k < 300; ++k) {
    station.advance_to(station.context().time() + 1ms);
    const PlantTruth& now = station.truth();
    Kinematics start;
    Kinematics end;
    robot.kinematics(before.pose, before.velocity, start);
    robot.kinematics(now.pose, now.velocity, end);
    const auto expect_integral = [](const JointVector& from, const JointVector& to,
                                    const JointVector& first_rate, const JointVector& last_rate) {
      const JointVector turned = ParallelRobot::passive_difference(to, from);
      EXPECT_NEAR((turned - 0.5e-3 * (first_rate + last_rate)).norm(), 0.0, 1e-6);  // trapezoidal rule
    };
    expect_integral(before.active, now.active, start.rates.active, end.rates.active);
    expect_integral(before.passive, now.passive, start.rates.passive, end.rates.passive);
    expect_integral(before.coupling, now.coupling, start.rates.coupling, end.rates.coupling);
    before = now;
  }
}

TEST(PlantTruth, AccelerationIsThatOfTheTorqueWhichActedUntilNow) {
  SimulatedStationSettings settings = station_with_pylon(0.32, 0.20);
  settings.applied_wrench = {
      {.peak_in_base = PlatformVector{{10.0, -5.0, 0.5}}, .start = 0s, .rise = 1s, .hold = 1s, .fall = 1s}};
  test::ServoedStation station(settings);
  const auto shared = std::dynamic_pointer_cast<const PlanarRrr>(settings.rig.robot);
  const PlanarRrr& robot = *shared;
  for (int k = 0; k < 1500; ++k) {
    station.step();
    const PlantTruth& truth = station.truth();
    const PlanarMotion motion = robot.motion(truth.pose, truth.velocity);
    if (k < 2 || station.contact().self_contact) continue;  // until the first command the brakes are closed
    const Eigen::Vector3d expected = robot.acceleration(motion, truth.drive_torque, truth.wrench_in_base);
    EXPECT_NEAR((truth.acceleration - expected).norm(), 0.0, 1e-9);
    EXPECT_NEAR(truth.kinetic_energy, robot.kinetic_energy(motion), 1e-14);
  }
}

TEST(PlantTruth, IsAlsoToldAsPlatformMotion) {
  test::ServoedStation station(test::rig_station());
  station.advance_to(300ms);
  const PlatformMotion& motion = station.get(station.station.platform_truth);
  EXPECT_TRUE(motion.valid());
  EXPECT_EQ(motion.acquired, 300ms);
  EXPECT_EQ(motion.pose, station.truth().pose);
  EXPECT_EQ(motion.velocity, station.truth().velocity);
}

// ---------------------------------------------------------------- instants of contact

/// Follows the rig from one tick to the next in steps of a microsecond.
class Microscope {
 public:
  explicit Microscope(const RigSettings& settings)
      : dynamics_(RigDynamics::make(settings)), equation_(*dynamics_) {}

  /// When the least gap to the pylon changes its sign in the tick that begins at `start` [s after it].
  double crossing(const PlantTruth& start, const Eigen::Vector3d& torque) {
    std::vector<double> y(equation_.size(), 0.0);
    std::copy_n(start.pose.data(), 3, y.begin());
    std::copy_n(start.velocity.data(), 3, y.begin() + 3);
    equation_.drives.torque = torque;
    equation_.drives.braked = false;
    RungeKutta one_step(1);
    one_step.prepare(y.size());
    constexpr double h = 1e-6;
    double before = least_gap(y);
    for (int k = 0; k < 1000; ++k) {
      one_step.advance(equation_, h, y);
      const double after = least_gap(y);
      if ((before < 0.0) != (after < 0.0)) return h * (k + before / (before - after));
      before = after;
    }
    return std::nan("");
  }

 private:
  double least_gap(const std::vector<double>& y) const {
    const RigState state = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(y.data());
    RigSnapshot snapshot;
    dynamics_->snapshot(state, equation_.drives, equation_.applied_wrench, equation_.step, 0.0, snapshot);
    const NearPair* const nearest = snapshot.near_pairs.nearest_of(0);
    return nearest == nullptr ? NearPairs::near_distance : nearest->gap;
  }

  std::unique_ptr<const RigDynamics> dynamics_;
  test::RigEquation equation_;
};

TEST(ContactTruth, TellsOnsetAndEndToAMicrosecond) {
  double worst_onset = 0.0;
  double worst_end = 0.0;
  int onsets = 0;
  int ends = 0;
  test::RandomRig random(31);
  for (int trial = 0; trial < 30; ++trial) {
    const Eigen::Vector2d pylon = random.point(0.5);
    const SimulatedStationSettings settings =
        station_with_pylon(pylon.x(), pylon.y(), random.uniform(3e3, 2e4));
    Microscope microscope(settings.rig);
    test::ServoedStation station(settings, {.frequency = {10.0, 8.0, 6.0}});
    PlantTruth before;
    ContactTruth contact_before;
    for (int k = 0; k < 1500; ++k) {
      station.step();
      const ContactTruth& contact = station.contact();
      if (k > 1 && contact.in_contact != contact_before.in_contact) {
        const double reference = microscope.crossing(before, station.truth().drive_torque);
        const Time told = (contact.in_contact ? contact.onset : contact.end) - before.acquired;
        const double error = std::abs(to_seconds(told) - reference);
        (contact.in_contact ? worst_onset : worst_end) =
            std::max(contact.in_contact ? worst_onset : worst_end, error);
        ++(contact.in_contact ? onsets : ends);
      }
      before = station.truth();
      contact_before = contact;
    }
  }
  std::cout << "onset: " << 1e6 * worst_onset << " us in " << onsets << ", end: " << 1e6 * worst_end
            << " us in " << ends << "\n";
  EXPECT_LT(worst_onset, 1e-6);
  EXPECT_LT(worst_end, 1e-6);
  EXPECT_GE(onsets, 30);
  EXPECT_GE(ends, 30);
}

TEST(ContactTruth, SumsUpTheContactsOfAnInstant) {
  const SimulatedStationSettings settings = station_with_pylon(0.32, 0.20);
  test::ServoedStation station(settings);
  double peak = 0.0;
  std::int64_t contacts = 0;
  int in_contact = 0;
  for (int k = 0; k < 3000; ++k) {
    station.step();
    const ContactTruth& contact = station.contact();
    EXPECT_TRUE(contact.valid);
    EXPECT_EQ(contact.acquired, 1ms * k);
    EXPECT_EQ(contact.in_contact, contact.strongest.body >= 0);
    EXPECT_GE(contact.strongest.force_in_base.norm(), contact.second.force_in_base.norm());
    if (contact.contacts > contacts) peak = 0.0;
    contacts = contact.contacts;
    if (!contact.in_contact) continue;
    ++in_contact;
    peak = std::max(peak, contact.strongest.force_in_base.norm());
    EXPECT_EQ(contact.peak_force, peak);
    EXPECT_EQ(contact.end, contact.acquired);
    const Eigen::Vector2d sum = contact.strongest.force_in_base + contact.second.force_in_base;
    if (contact.strongest.body == 0) {
      EXPECT_NEAR((contact.wrench_in_base.head(2) - sum).norm(), 0.0, 1e-9);
    }
    const Eigen::Vector2d from_pylon = contact.strongest.point_in_base - Eigen::Vector2d(0.32, 0.20);
    EXPECT_GT(from_pylon.dot(contact.strongest.force_in_base), 0.0) << "it pushes the robot away";
    EXPECT_NEAR(from_pylon.norm(), 0.04 - 0.5 * contact.strongest.depth, 1e-12);
  }
  EXPECT_GT(in_contact, 100);
}

TEST(ContactTruth, SeesAPylonClampedBetweenTheLinksOfALeg) {
  SimulatedStationSettings settings = test::rig_station();
  const auto shared = std::dynamic_pointer_cast<const PlanarRrr>(settings.rig.robot);
  const PlanarRrr& robot = *shared;
  const PlanarMotion home = robot.motion({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  const PlanarLeg& leg = home.legs[0].leg;
  const Eigen::Vector2d bisector = (leg.u2 - leg.u1).normalized();
  const double half_angle = 0.5 * std::acos(-leg.u1.dot(leg.u2));
  const Eigen::Vector2d at = leg.passive_joint + 0.068 / std::sin(half_angle) * bisector;
  settings.rig.obstacles = {test::fixed_post(at.x(), at.y())};
  test::ServoedStation station(settings, {.amplitude = {0.0, 0.0, 0.0}});
  station.step();
  const ContactTruth& contact = station.contact();
  EXPECT_TRUE(contact.clamping);
  EXPECT_EQ(std::min(contact.strongest.body, contact.second.body), BodyId::link1(0).index());
  EXPECT_EQ(std::max(contact.strongest.body, contact.second.body), BodyId::link2(0).index());
  EXPECT_EQ(contact.onset, 0ms) << "it began before the run";
}

TEST(ContactTruth, WithoutAPylonIsValidAndEmpty) {
  test::ServoedStation station(test::rig_station());
  station.advance_to(200ms);
  EXPECT_TRUE(station.contact().valid);
  EXPECT_FALSE(station.contact().in_contact);
  EXPECT_EQ(station.contact().contacts, 0);
  EXPECT_EQ(station.contact().strongest.body, -1);
}

// ---------------------------------------------------------------- closed brakes

/// With closed brakes and a push that rises to `force` along x within 50 ms and stays for `hold`.
SimulatedStationSettings leaned_upon(double force, Time hold) {
  SimulatedStationSettings settings = test::rig_station();
  settings.applied_wrench = {{.peak_in_base = PlatformVector{{force, 0.0, 0.0}},
                              .start = 100ms,
                              .rise = 50ms,
                              .hold = hold,
                              .fall = 50ms}};
  return settings;
}

struct BrakedRun {
  std::vector<double> ways;  ///< how far the drive that moved most has moved after each tick [rad]
  std::vector<std::int64_t> evaluations;  ///< right-hand sides until then
};

BrakedRun run_braked(const SimulatedStationSettings& settings, Time end) {
  DiagramBuilder builder("test", 1ms);
  const SimulatedStation station = add_simulated_station(builder, settings);
  builder.connect(builder.add<Constant<TorqueCommand>>("torque", TorqueCommand()).value,
                  station.torque_command);
  builder.connect(builder.add<Constant<BrakeCommand>>("brake", BrakeCommand()).value, station.brake);
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  auto integrator = std::make_unique<SundialsIntegrator>();
  const SundialsIntegrator& counting = *integrator;
  Simulator simulator(*diagram, std::move(integrator));
  simulator.step(context);
  const JointVector start = context.get(station.plant_truth).active;
  BrakedRun run;
  for (Time now = 1ms; now < end; now += 1ms) {
    simulator.step(context);
    const JointVector way = context.get(station.plant_truth).active - start;
    run.ways.push_back(way.lpNorm<Eigen::Infinity>());
    run.evaluations.push_back(counting.evaluations());
  }
  return run;
}

/// The rig made of so little that its brakes would be as stiff as no integrator follows.
std::shared_ptr<const Mechanism> rig_of_grams() {
  PlanarRrrParameters robot = rig_robot(RigGeometry::individual, RigFriction::none);
  constexpr double share = 1e-3;
  for (PlanarRrrLeg& leg : robot.legs) {
    for (double* const of_leg : {&leg.inertia.p1, &leg.inertia.p2, &leg.inertia.p3}) *of_leg *= share;
    leg.rotor_inertia *= share;
  }
  robot.platform_mass *= share;
  robot.platform_inertia *= share;
  return std::make_shared<const PlanarRrr>(robot);
}

std::vector<double> ways_of_braked(const SimulatedStationSettings& settings, Time end) {
  return run_braked(settings, end).ways;
}

TEST(ClosedBrakes, HoldARobotThatIsLeanedUponWhereItIs) {
  for (const double force : {50.0, 200.0, -300.0}) {
    const std::vector<double> way = ways_of_braked(leaned_upon(force, 2s), 2s);
    std::cout << force << " N: " << way[300] << " rad after 0.3 s, " << way.back() << " rad after 2 s\n";
    EXPECT_LT(way.back(), 2e-4);              // the brake gives way like a stiff spring ...
    EXPECT_NEAR(way.back(), way[300], 1e-9);  // ... and does not creep
  }
  EXPECT_LT(ways_of_braked(leaned_upon(200.0, 200ms), 1s).back(), 1e-8);  // nor stays where it was pushed
}

TEST(ClosedBrakes, SlideUnderMoreThanTheyHold) {
  const std::vector<double> way = ways_of_braked(leaned_upon(800.0, 40ms), 1s);
  EXPECT_GT(way.back(), 1e-2);
  EXPECT_NEAR(way.back(), way[way.size() - 500], 1e-9);
  EXPECT_GT(*std::max_element(way.begin(), way.end()), way.back());         // it springs back, ...
  EXPECT_LT(*std::max_element(way.begin(), way.end()) - way.back(), 4e-4);  // ... by no more than its give
}

/// Cogging motors pull at the brakes, after half a second so does a push of 200 N, and always `whisper` [N].
SimulatedStationSettings pulled_at(double whisper) {
  SimulatedStationSettings settings = leaned_upon(200.0, 100ms);
  settings.applied_wrench.front().start = 500ms;
  settings.applied_wrench.push_back(
      {.peak_in_base = PlatformVector{{whisper, 0.0, 0.0}}, .start = 0s, .rise = 0s, .hold = 2s, .fall = 0s});
  settings.rig.torque_ripple.assign(
      3, {.cogging = {{.amplitude = 0.5, .rate = 24.0, .phase = 1.0}}, .ripple = {}});
  return settings;
}

// Where anything acts, however small, the stiff motion within the brakes is integrated.
TEST(ClosedBrakes, LetARobotRestWhereItWouldStayAnyway) {
  const BrakedRun resting = run_braked(pulled_at(0.0), 1s), followed = run_braked(pulled_at(1e-30), 1s);
  double apart = 0.0;
  for (std::size_t k = 0; k < resting.ways.size(); ++k)
    apart = std::max(apart, std::abs(resting.ways[k] - followed.ways[k]));
  const auto last_rest = [](const BrakedRun& run) { return run.evaluations[490] - run.evaluations[390]; };
  std::cout << "apart by " << apart << " rad; evaluations in 100 ms: " << last_rest(resting) << ", followed "
            << last_rest(followed) << "\n";
  EXPECT_LT(apart, 1e-10);
  EXPECT_GT(resting.ways[600] - resting.ways[490], 1e-6);  // it yields to the push
  EXPECT_EQ(last_rest(resting), 100 * 6);                  // the stages of one step a tick
  EXPECT_GT(last_rest(followed), 100 * 20);
}

TEST(ClosedBrakes, HoldARobotOfGramsInStepsThatAnIntegratorTakes) {
  SimulatedStationSettings settings = leaned_upon(20.0, 50ms);
  settings.rig.robot = rig_of_grams();
  const BrakedRun run = run_braked(settings, 300ms);
  EXPECT_LT(run.evaluations.back(), 3'000'000) << "ten thousand a tick";
  EXPECT_LT(run.ways.back(), 1e-2);
}

// ---------------------------------------------------------------- set-up

TEST(RigPlant, RefusesADiagramThatTicksMoreSlowlyThanItLooksAhead) {
  EXPECT_THROW(test::ServoedStation(test::rig_station(), {}, std::make_unique<SundialsIntegrator>(), 2ms),
               SetupError);
}

TEST(RigPlant, MovesAlikeInFinerTicksUnderTheSameTorque) {
  SimulatedStationSettings settings = station_with_pylon(0.1, 0.1);
  settings.applied_wrench = {
      {.peak_in_base = PlatformVector{{20.0, 15.0, 1.0}}, .start = 0s, .rise = 1s, .hold = 0s, .fall = 1s}};
  settings.rig.brake.torque = 0.0;
  const auto pose_after = [&](Time tick) {
    DiagramBuilder builder("test", tick);
    SimulatedStation station = add_simulated_station(builder, settings);
    auto& torque = builder.add<Constant<TorqueCommand>>("torque", TorqueCommand());
    auto& brake = builder.add<Constant<BrakeCommand>>("brake", BrakeCommand());
    builder.connect(torque.value, station.torque_command);
    builder.connect(brake.value, station.brake);
    const auto diagram = builder.build();
    Context context = diagram->make_context();
    Simulator simulator(*diagram, std::make_unique<SundialsIntegrator>());
    simulator.advance_to(context, 500ms);
    return Eigen::Vector3d(context.get(station.plant_truth).pose);
  };
  const Eigen::Vector3d coarse = pose_after(1ms);
  EXPECT_GT(coarse.norm(), 0.01);
  EXPECT_NEAR((coarse - pose_after(250us)).norm(), 0.0, 1e-7);
}

}  // namespace
}  // namespace flinch
