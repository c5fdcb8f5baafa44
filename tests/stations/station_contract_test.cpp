// What every station owes the pipeline, whatever stands behind it: the same script is played with each.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <tuple>

#include "tests/stations/contract_ends.h"
#include "tests/stations/contract_station.h"

namespace flinch {
namespace {

using test::contract_robot;
using test::contract_stations;
using test::contract_torque_constant;
using test::ContractStation;
using test::Damage;
using test::Harm;
using test::longest_age;
using test::Moment;
using test::Order;
using test::Script;
using test::Source;
using test::StationRun;
using test::Trace;

constexpr FaultMask no_angles = fault_bit(GateFault::joints_invalid) | fault_bit(GateFault::joints_stale) |
                                fault_bit(GateFault::velocity_invalid);
constexpr FaultMask no_currents = fault_bit(GateFault::drives_invalid) | fault_bit(GateFault::drives_stale);
constexpr FaultMask no_status = fault_bit(GateFault::station_silent);

JointAngles home() {
  return contract_robot()
      ->inverse_kinematics(contract_robot()->home_pose(), contract_robot()->home_working_mode())
      .joints;
}

Order torque_of(const JointVector& torque) {
  return {.by_test = true,
          .torque = {.computed = {}, .valid = true, .torque = torque},
          .age = Time::zero(),
          .brake = {.engage = false}};
}

Order pipeline() { return {}; }

const Moment& at(const Trace& trace, Time time) { return trace.at(static_cast<std::size_t>(time / 1ms)); }

Trace part(const Trace& trace, Time begin, Time end) {
  return {trace.begin() + begin / 1ms, trace.begin() + end / 1ms};
}

/// For who reads why a test failed.
std::string fault_of(const Moment& moment) {
  return "the gate has closed by the fault " + std::to_string(static_cast<int>(moment.gate.fault));
}

bool nothing_valid(const Moment& moment) {
  return !moment.joints.valid && !moment.joints.passive_valid && !moment.drives.valid && !moment.imu.valid &&
         !moment.status.valid;
}

class StationContract : public testing::TestWithParam<ContractStation> {
 protected:
  StationRun run(const Script& script) const { return GetParam().run(script); }
  const test::StationTraits& traits() const { return GetParam().traits; }
};

template <class Wanted>
std::vector<ContractStation> stations_that(Wanted wanted) {
  std::vector<ContractStation> stations;
  for (const ContractStation& station : contract_stations()) {
    if (wanted(station.traits)) stations.push_back(station);
  }
  return stations;
}

std::string name_of(const testing::TestParamInfo<ContractStation>& station) { return station.param.name; }

INSTANTIATE_TEST_SUITE_P(All, StationContract, testing::ValuesIn(contract_stations()), name_of);

// ---------------------------------------------------------------- ports, units, signs

TEST_P(StationContract, HasThePortsAndFieldsOfTheSimulatedOne) {
  const StationRun result = run({.duration = 1ms});
  EXPECT_EQ(result.inputs, (std::vector<std::string>{"station/torque_command", "station/brake"}));
  const std::vector<Signal>& ports = result.outputs;
  const std::vector<Signal> expected = test::run_simulated({.duration = 1ms}).outputs;
  ASSERT_EQ(ports.size(), expected.size());
  for (std::size_t i = 0; i < ports.size(); ++i) {
    EXPECT_EQ(ports[i].path, expected[i].path);
    ASSERT_EQ(ports[i].layout.fields.size(), expected[i].layout.fields.size());
    for (std::size_t k = 0; k < ports[i].layout.fields.size(); ++k) {
      EXPECT_EQ(ports[i].layout.fields[k].name, expected[i].layout.fields[k].name);
      EXPECT_EQ(ports[i].layout.fields[k].unit, expected[i].layout.fields[k].unit);
      EXPECT_EQ(ports[i].layout.fields[k].frame, expected[i].layout.fields[k].frame);
    }
  }
}

TEST_P(StationContract, TellsAtRestWhereTheRobotStandsAndThatItIsBraked) {
  const auto braked = [](Time) { return Order{.by_test = true}; };
  const Trace trace = run({.duration = 60ms, .order = braked}).trace;
  for (const Moment& moment : part(trace, 30ms, 60ms)) {
    ASSERT_TRUE(moment.joints.valid && moment.joints.passive_valid && moment.drives.valid &&
                moment.imu.valid && moment.status.valid);
    EXPECT_LT((moment.joints.active - home().active).norm(), 1e-3);
    EXPECT_LT((moment.joints.passive - home().passive).norm(), 0.012) << "0.1 degrees each, times four";
    EXPECT_LT(moment.drives.current.norm(), 0.2);
    EXPECT_TRUE(moment.status.enabled);
    EXPECT_TRUE(moment.status.braked);
    EXPECT_FALSE(moment.status.fault);
  }
}

/// Specific force is acceleration minus gravity: at rest it points up.
TEST_P(StationContract, FeelsTheGroundPushUpInTheAxesOfTheSensor) {
  constexpr double degree = std::numbers::pi / 180.0;
  const Eigen::Quaterniond platform_from_imu = Eigen::AngleAxisd(2.8 * degree, Eigen::Vector3d::UnitX()) *
                                               Eigen::AngleAxisd(-5.2 * degree, Eigen::Vector3d::UnitY()) *
                                               Eigen::AngleAxisd(2.3 * degree, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d up = platform_from_imu.conjugate() * Eigen::Vector3d(0.0, 0.0, 9.80665);
  const auto braked = [](Time) { return Order{.by_test = true}; };
  const Trace trace = run({.duration = 60ms, .order = braked}).trace;
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), rate = Eigen::Vector3d::Zero();
  for (const Moment& moment : part(trace, 30ms, 60ms)) {
    force += moment.imu.specific_force / 30.0;
    rate += moment.imu.angular_velocity / 30.0;
  }
  EXPECT_LT((force - up).lpNorm<Eigen::Infinity>(), 0.04 * 9.80665 + 0.03) << "bias and averaged noise";
  EXPECT_LT(rate.lpNorm<Eigen::Infinity>(), 3.0 * degree + 2e-3);
}

TEST_P(StationContract, ShowsThatPositiveTorqueTurnsItsDriveForwardsAndIsPositiveCurrent) {
  constexpr double torque = 6.0;
  for (Eigen::Index drive = 0; drive < 3; ++drive) {
    for (const double sign : {1.0, -1.0}) {
      const JointVector push = sign * torque * JointVector::Unit(3, drive);
      const Trace trace =
          run({.duration = 80ms,
               .order = [push](Time now) { return now < 20ms ? Order{.by_test = true} : torque_of(push); }})
              .trace;
      const Moment& end = trace.back();
      const JointVector moved = sign * (end.joints.active - home().active);
      EXPECT_GT(moved[drive], 2e-3);
      EXPECT_EQ(moved.lpNorm<Eigen::Infinity>(), moved[drive]) << "most of all drives";
      EXPECT_NEAR(end.drives.current[drive], sign * torque / contract_torque_constant, 0.1);
      EXPECT_NEAR(end.drives.current.norm(), torque / contract_torque_constant, 0.1);
      EXPECT_FALSE(end.status.braked);
    }
  }
}

// ---------------------------------------------------------------- time

TEST_P(StationContract, StampsReadingsInOrderAndNeverInTheFuture) {
  const StationRun result = run({.duration = 150ms});
  const auto check = [](Time now, const auto& reading, Time& last) {
    if (!reading.valid) return;
    EXPECT_LE(reading.acquired, now);
    EXPECT_GE(reading.acquired, now - longest_age);
    EXPECT_GE(reading.acquired, last);
    last = reading.acquired;
  };
  Time joints = -1h, drives = -1h, imu = -1h, status = -1h;
  int valid = 0;
  for (const Trace& trace : {result.before, result.trace}) {
    for (const Moment& moment : trace) {
      check(moment.now, moment.joints, joints);
      check(moment.now, moment.drives, drives);
      check(moment.now, moment.imu, imu);
      check(moment.now, moment.status, status);
      valid += moment.joints.valid && moment.drives.valid && moment.imu.valid && moment.status.valid;
    }
  }
  EXPECT_GT(valid, 140);
}

// ---------------------------------------------------------------- what is not there

TEST_P(StationContract, TellsNothingBeforeItsFirstReading) {
  const StationRun result = run({.duration = 100ms});
  EXPECT_EQ(!result.before.empty(), traits().waits);
  if (traits().waits) {
    EXPECT_TRUE(nothing_valid(result.before.front()));
    EXPECT_EQ(result.before.front().gate.phase, GatePhase::waiting);
  }
  EXPECT_EQ(result.trace.back().gate.phase, GatePhase::open) << fault_of(result.trace.back());
}

struct Case {
  Source source;
  FaultMask found;  ///< one of these, as long as it lasts
};

class StationHarm : public testing::TestWithParam<std::tuple<ContractStation, Harm>> {
 protected:
  static constexpr Time begin = 80ms;
  static constexpr Time end = begin + longest_age + 30ms;

  Trace run(Source source) const {
    const Harm harm = std::get<1>(GetParam());
    const auto damage = [=](Time now) { return now >= begin && now < end ? Damage{source, harm} : Damage{}; };
    return std::get<0>(GetParam())
        .run({.duration = end + 80ms, .order = [](Time) { return pipeline(); }, .damage = damage})
        .trace;
  }
};

std::string name_of_harm(const testing::TestParamInfo<std::tuple<ContractStation, Harm>>& both) {
  const Harm harm = std::get<1>(both.param);
  return std::get<0>(both.param).name + (harm == Harm::lost    ? "Lost"
                                         : harm == Harm::stale ? "Stale"
                                                               : "NotANumber");
}

INSTANTIATE_TEST_SUITE_P(All, StationHarm,
                         testing::Combine(testing::ValuesIn(contract_stations()),
                                          testing::Values(Harm::lost, Harm::stale, Harm::not_a_number)),
                         name_of_harm);

TEST_P(StationHarm, IsAFaultWhileItLastsAndNoLongerAndClosesTheGate) {
  for (const Case& each : {Case{Source::joints, no_angles}, Case{Source::drives, no_currents},
                           Case{Source::status, no_status}}) {
    if (each.source == Source::status && std::get<1>(GetParam()) == Harm::not_a_number)
      continue;  // no numbers
    const Trace trace = run(each.source);
    EXPECT_EQ(at(trace, begin - 1ms).faults, FaultMask{0});
    EXPECT_EQ(at(trace, begin - 1ms).gate.phase, GatePhase::open) << fault_of(at(trace, begin - 1ms));
    for (const Moment& moment : part(trace, begin + longest_age + 5ms, end)) {
      EXPECT_NE(moment.faults & each.found, FaultMask{0});
      EXPECT_EQ(moment.gate.phase, GatePhase::closed);
    }
    EXPECT_EQ(trace.back().faults & each.found, FaultMask{0});
    EXPECT_EQ(trace.back().gate.phase, GatePhase::closed) << "until a reset";
  }
}

/// A reading that cannot be used says so, by its validity, its stamp or a number that is none.
TEST_P(StationHarm, IsNeverHiddenBehindZeros) {
  const Trace joints = run(Source::joints);
  const Trace imu = run(Source::imu);
  for (const Moment& moment : joints) {
    if (!moment.joints.valid || !moment.joints.active.allFinite()) continue;
    EXPECT_LT((moment.joints.active - home().active).norm(), 0.01);
  }
  for (const Moment& moment : part(imu, begin + longest_age + 5ms, end)) {
    const ImuReading& reading = moment.imu;
    EXPECT_FALSE(reading.valid && reading.specific_force.allFinite() &&
                 reading.acquired >= moment.now - longest_age);
  }
  for (const Moment& moment : imu) {
    const bool usable = moment.imu.valid && moment.imu.specific_force.allFinite();
    EXPECT_TRUE(!usable || moment.imu.specific_force[2] > 9.0);
  }
}

// ---------------------------------------------------------------- encoders that lie

TEST_P(StationContract, LetsAJumpingEncoderBeSeen) {
  const auto damage = [](Time now) { return now >= 80ms ? Damage{Source::joints, Harm::jump} : Damage{}; };
  const Trace trace = run({.duration = 120ms, .damage = damage}).trace;
  EXPECT_EQ(at(trace, 79ms).faults, FaultMask{0});
  FaultMask found = 0;
  for (const Moment& moment : part(trace, 80ms, 120ms)) found |= moment.faults;
  EXPECT_NE(found & fault_bit(GateFault::encoder_jump), FaultMask{0});
  EXPECT_EQ(trace.back().gate.reaction, GateReaction::zero_torque_and_brake);
}

TEST_P(StationContract, LetsFrozenEncodersBeSeenByTheirMissingNoise) {
  const auto order = [](Time now) {
    if (now < 60ms) return Order{.by_test = true};
    return torque_of(now < 100ms ? JointVector(JointVector::Zero(3))
                                 : JointVector(12.0 * JointVector::Unit(3, 1)));
  };
  const auto damage = [](Time now) { return now >= 80ms ? Damage{Source::joints, Harm::frozen} : Damage{}; };
  const Trace trace = run({.duration = 150ms, .order = order, .damage = damage}).trace;
  constexpr FaultMask frozen = fault_bit(GateFault::encoder_frozen);
  for (const Moment& moment : part(trace, 0ms, 79ms)) EXPECT_EQ(moment.faults & frozen, FaultMask{0});
  EXPECT_TRUE(at(trace, 140ms).joints.valid) << "nothing else is wrong with it";
  EXPECT_NE(at(trace, 140ms).faults & frozen, FaultMask{0});
}

// ---------------------------------------------------------------- commands

class ObeyingStation : public StationContract {};
INSTANTIATE_TEST_SUITE_P(Obeying, ObeyingStation,
                         testing::ValuesIn(stations_that([](const auto& traits) { return traits.obeys; })),
                         name_of);

TEST_P(ObeyingStation, BrakesWithoutTorqueOnACommandThatIsInvalidOrOldOrNoNumberOrWithBrakes) {
  const Order good = torque_of(JointVector::Constant(3, 3.0));
  Order invalid = good, old = good, no_number = good, braked = good;
  invalid.torque.valid = false;
  old.age = longest_age + 60ms;
  no_number.torque.torque[1] = std::numeric_limits<double>::quiet_NaN();
  braked.brake.engage = true;
  for (const Order& bad : {invalid, old, no_number, braked}) {
    const auto order = [&](Time now) {
      return now < 20ms ? Order{.by_test = true} : now < 60ms ? good : bad;
    };
    const Trace trace = run({.duration = 130ms, .order = order}).trace;
    EXPECT_FALSE(at(trace, 59ms).status.braked);
    EXPECT_GT(at(trace, 59ms).drives.current.minCoeff(), 0.3);
    const Moment& end = trace.back();
    EXPECT_TRUE(end.status.braked);
    EXPECT_LT(end.drives.current.norm(), 0.2);
    EXPECT_LT((end.joints.active - at(trace, 120ms).joints.active).norm(), 1e-4) << "at rest";
  }
}

class DeafStation : public StationContract {};
INSTANTIATE_TEST_SUITE_P(Deaf, DeafStation,
                         testing::ValuesIn(stations_that([](const auto& traits) { return !traits.obeys; })),
                         name_of);

TEST_P(DeafStation, TellsTheSameWhateverIsCommanded) {
  Script script{.duration = 100ms};
  const Trace one = run(script).trace;
  script.replay_order = torque_of(JointVector::Constant(3, 20.0));
  const Trace two = run(script).trace;
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].joints.active, two[k].joints.active);
    EXPECT_EQ(one[k].drives.current, two[k].drives.current);
  }
}

// ---------------------------------------------------------------- restarts

class RestartingStation : public StationContract {};
INSTANTIATE_TEST_SUITE_P(
    Restarting, RestartingStation,
    testing::ValuesIn(stations_that([](const auto& traits) { return traits.ends_may_restart; })), name_of);

TEST_P(RestartingStation, DoesNotMoveUntilARestartedRobotIsKnownAndTheGateReset) {
  const Trace trace = run({.duration = 800ms, .robot_restarts = 100ms}).trace;
  EXPECT_EQ(at(trace, 99ms).gate.phase, GatePhase::open) << fault_of(at(trace, 99ms));
  const Trace after = part(trace, 100ms, 800ms);
  EXPECT_TRUE(
      std::any_of(after.begin(), after.end(), [](const Moment& moment) { return !moment.joints.valid; }));
  EXPECT_EQ(trace.back().gate.phase, GatePhase::closed);
  EXPECT_TRUE(trace.back().joints.valid);
  EXPECT_TRUE(trace.back().status.braked);
  EXPECT_LT((trace.back().joints.active - home().active).norm(), 1e-3);
}

TEST_P(RestartingStation, IsCommandedByARestartedControllerFromWhereTheRobotStands) {
  const Trace trace = run({.duration = 800ms, .controller_restarts = 100ms}).trace;
  const Trace after = part(trace, 100ms, 800ms);
  EXPECT_EQ(after.front().gate.phase, GatePhase::waiting);
  EXPECT_TRUE(std::any_of(after.begin(), after.end(), [](const Moment& moment) {
    return moment.status.valid && moment.status.braked;
  })) << "while nobody commanded";
  EXPECT_EQ(trace.back().gate.phase, GatePhase::open) << fault_of(trace.back());
  EXPECT_FALSE(trace.back().status.braked);
  for (const Moment& moment : after) {
    if (moment.joints.valid) {
      EXPECT_LT((moment.joints.active - home().active).norm(), 2e-3);
    }
  }
}

}  // namespace
}  // namespace flinch
