#include "systems/safety/fault_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "tests/systems/safety/gated_inputs.h"

namespace flinch {
namespace {

using test::Inputs;
using test::Safety;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double degree = std::numbers::pi / 180.0;
constexpr Time open_for = 10ms;

/// One way in which a fault comes about, and what is as bad as it can be without being that fault, nor
/// another.
struct Way {
  std::function<void(Inputs&)> fault;
  int latency = 0;                             ///< ticks from its first to the gate's reaction
  std::function<void(Inputs&)> just_not = {};  ///< none where the row's other ways show what there is to show
  int lasting = 1;                             ///< ticks for which it is none
};

/// A pose whose legs are about `angle` away from home at most.
PlatformVector pose_at_drive_error(const ParallelRobot& robot, double angle) {
  const auto active = [&robot](double y) {
    return robot.inverse_kinematics(Eigen::Vector3d(0.0, y, 0.0), robot.home_working_mode()).joints.active;
  };
  double y = 0.0;
  while ((active(y) - active(0.0)).lpNorm<Eigen::Infinity>() < angle) y += 1e-4;
  return Eigen::Vector3d(0.0, y, 0.0);
}

/// The tick of an input, counted from the first after open().
int number(const Inputs& in) { return static_cast<int>((in.now - open_for) / 1ms); }

/// The angle of the second drive stays what it is, from the first of these ticks on.
void freeze(Inputs& in) { in.posture.joints.active[1] = 0.44; }

// The ways of several faults that differ in what they look at.

std::vector<Way> bad_samples(const std::function<void(Inputs&)>& invalid,
                             const std::function<JointVector&(Inputs&)>& angles) {
  const auto no_number = [angles](Inputs& in) { angles(in)[0] = nan; };
  const auto infinite = [angles](Inputs& in) { angles(in)[2] = infinity; };
  const auto short_one = [angles](Inputs& in) { angles(in).conservativeResize(2); };
  return {{invalid, 2, invalid, 2},
          {no_number, 2, no_number, 2},
          {infinite, 2, infinite, 2},
          {short_one, 2, short_one, 2}};
}

/// Not renewed any more, or from the future.
std::vector<Way> bad_stamps(const std::function<Time&(Inputs&)>& stamp) {
  return {{[stamp](Inputs& in) { stamp(in) = in.last_seen; }, 3,
           [stamp](Inputs& in) { stamp(in) = in.now - 3ms; }},
          {[stamp](Inputs& in) { stamp(in) = in.now - 3ms - Time(1); }, 0},
          {[stamp](Inputs& in) { stamp(in) = in.now + 3ms + Time(1); }, 0,
           [stamp](Inputs& in) { stamp(in) = in.now + 3ms; }}};
}

std::vector<Way> operator+(std::vector<Way> ways, const std::vector<Way>& others) {
  ways.insert(ways.end(), others.begin(), others.end());
  return ways;
}

/// A measure below its least absolute value, from both sides.
std::vector<Way> too_small(double WorkspaceMeasures::*measure, double least) {
  const auto is = [measure](double value) {
    return [=](Inputs& in) { in.posture.measures.*measure = value; };
  };
  return {{is(least - 1e-4), 0, is(least)}, {is(1e-4 - least), 0, is(-least)}, {is(nan), 0}};
}

std::function<void(Inputs&)> det_A(double value) {
  return [value](Inputs& in) { in.posture.measures.det_A = value; };
}

/// An entry of a vector beyond `most`, or below `least`.
std::vector<Way> beyond(const std::function<double&(Inputs&)>& entry, double least, double most,
                        double step) {
  const auto is = [entry](double value) { return [=](Inputs& in) { entry(in) = value; }; };
  return {{is(least - step), 0, is(least + step)}, {is(most + step), 0, is(most - step)}};
}

std::map<GateFault, std::vector<Way>> ways_of_station_and_sensors() {
  const auto silent = [](Inputs& in) { in.station.valid = false; };
  const auto late = [](Time lateness) {
    return [lateness](Inputs& in) { in.timing.valid = true, in.timing.lateness = lateness; };
  };
  const auto jump = [](double step) { return [step](Inputs& in) { in.posture.joints.active[2] += step; }; };
  const auto current_of_frozen = [](double change) {
    return [change](Inputs& in) { freeze(in), in.drives.current[1] = number(in) > 1 ? change : 0.0; };
  };
  const auto passive_of_frozen = [](double change) {
    return
        [change](Inputs& in) { freeze(in), in.posture.joints.passive[0] += number(in) > 1 ? change : 0.0; };
  };
  return {
      {GateFault::loop_late, {{late(Time(2ms) + Time(1)), 0, late(2ms)}}},
      {GateFault::station_silent, std::vector<Way>{{silent, 2, silent, 2}} +
                                      bad_stamps([](Inputs& in) -> Time& { return in.station.acquired; })},
      {GateFault::station_fault,
       {{[](Inputs& in) { in.station.fault = true; }, 0,
         [](Inputs& in) { in.station.fault = true, in.station.valid = false; }, 2}}},
      {GateFault::station_disabled,
       {{[](Inputs& in) { in.station.enabled = false; }, 0,
         [](Inputs& in) { in.station.enabled = false, in.station.valid = false; }, 2}}},
      {GateFault::joints_invalid,
       bad_samples([](Inputs& in) { in.posture.joints.valid = false; },
                   [](Inputs& in) -> JointVector& { return in.posture.joints.active; })},
      {GateFault::joints_stale, bad_stamps([](Inputs& in) -> Time& { return in.posture.joints.acquired; })},
      {GateFault::encoder_jump, {{jump(-0.01202), 0, jump(-0.01198)}, {jump(0.01202), 0, jump(0.01198)}}},
      {GateFault::encoder_frozen,
       {{current_of_frozen(1.01), 6, current_of_frozen(1.01), 6},
        {current_of_frozen(-1.01), 6, current_of_frozen(1.0), 50},
        {passive_of_frozen(0.251 * degree), 6, passive_of_frozen(0.251 * degree), 6},
        {passive_of_frozen(-0.251 * degree), 6, passive_of_frozen(0.249 * degree), 50}}},
      {GateFault::velocity_invalid,
       {{[](Inputs& in) { in.posture.motion.valid = false; }, 0,
         [](Inputs& in) { in.posture.motion.acquired = in.now - 1h; }},  // its age is that of the readings
        {[](Inputs& in) { in.posture.motion.velocity[1] = nan; }, 0},
        {[](Inputs& in) { in.posture.motion.position.conservativeResize(2); }, 0}}},
      {GateFault::drives_invalid, bad_samples([](Inputs& in) { in.drives.valid = false; },
                                              [](Inputs& in) -> JointVector& { return in.drives.current; })},
      {GateFault::drives_stale, bad_stamps([](Inputs& in) -> Time& { return in.drives.acquired; })},
  };
}

std::map<GateFault, std::vector<Way>> ways_of_pose_and_workspace() {
  using Status = PlatformMotion::Status;
  const auto solved = [](Status status) {
    return [status](Inputs& in) { in.posture.platform.status = status; };
  };
  const auto out = [](double x, double y) {
    return [=](Inputs& in) { in.posture.platform.pose = Eigen::Vector3d(x, y, 0.0); };
  };
  const auto no_measures = [](Inputs& in) { in.posture.measures.valid = false; };
  return {
      {GateFault::forward_kinematics,
       {{solved(Status::not_converged), 0},
        {solved(Status::no_data), 0},
        {[](Inputs& in) { in.posture.platform.pose[2] = nan; }, 0,
         [](Inputs& in) { in.posture.platform.velocity.setConstant(1e300); }},  // no matter how fast
        {[](Inputs& in) { in.posture.platform.velocity.conservativeResize(2); }, 0}}},
      {GateFault::encoders_implausible,
       {{solved(Status::implausible), 0,
         [](Inputs& in) { in.posture.joints.passive.setConstant(3.0); }}}},  // as long as nobody concludes it
      {GateFault::type_1_singularity,
       too_small(&WorkspaceMeasures::det_B, 0.15) + std::vector<Way>{{no_measures, 0}}},
      {GateFault::type_2_singularity,
       {{det_A(-0.2 + 1e-4), 0, det_A(-0.2)},  // home lies where it is negative
        {det_A(0.2), 0, det_A(-0.3)},
        {det_A(nan), 0},
        {solved(Status::singular), 0}}},
      {GateFault::workspace_radius,
       {{out(0.25, 0.246), 0, out(0.25, 0.244)}, {out(-0.351, 0.0), 0, out(-0.349, 0.0)}}},
      {GateFault::orientation, beyond([](Inputs& in) -> double& { return in.posture.platform.pose[2]; },
                                      -29.0 * degree, 29.0 * degree, 0.01 * degree)},
      {GateFault::joint_range, beyond(
                                   [](Inputs& in) -> double& {
                                     in.reference.valid = false;  // or it were far away as well
                                     return in.posture.motion.position[1];
                                   },
                                   -35.0 * degree, 150.0 * degree, 0.01 * degree)},
      {GateFault::joint_speed,
       beyond([](Inputs& in) -> double& { return in.posture.motion.velocity[2]; }, -8.0, 8.0, 0.01) +
           beyond(
               [](Inputs& in) -> double& {
                 in.reaction.mode = ReactionMode::recover;
                 return in.posture.motion.velocity[2];
               },
               -1.2, 1.2, 0.01) +
           beyond(
               [](Inputs& in) -> double& {
                 in.plausibility.passive_lost = true;
                 return in.posture.motion.velocity[2];
               },
               -4.0, 4.0, 0.01)},
      {GateFault::self_collision,
       {{[](Inputs& in) { in.posture.measures.sigma_sc = 0.0499; }, 0,
         [](Inputs& in) { in.posture.measures.sigma_sc = 0.05; }}}},
  };
}

std::map<GateFault, std::vector<Way>> ways_of_laws_and_operator() {
  const auto wanted = [](double angle) {
    return [pose = pose_at_drive_error(*test::planar_rig(), angle)](Inputs& in) { in.reference.pose = pose; };
  };
  constexpr ReactionMode recover = ReactionMode::recover;
  const auto touched = [](ContactLevel level, ReactionMode mode) {
    return [=](Inputs& in) { in.detection.present_level = level, in.reaction.mode = mode; };
  };
  const auto torque = [](double value) { return [value](Inputs& in) { in.command.torque[1] = value; }; };
  return {
      {GateFault::contact_unmonitored,
       {{[](Inputs& in) { in.detection.valid = false; }, 0,
         [](Inputs& in) { in.detection.level = in.detection.present_level = ContactLevel::hard; }},
        {[](Inputs& in) { in.plausibility.valid = in.plausibility.learning = true; }, 0}}},
      {GateFault::control_error,
       {{wanted(25.2 * degree), 0, wanted(24.8 * degree)},
        {[](Inputs& in) { in.reference.pose = Eigen::Vector3d(5.0, 0.0, 0.0); }, 0,  // out of reach
         [](Inputs& in) { in.reference.pose = Eigen::Vector3d(5.0, 0.0, 0.0), in.reference.valid = false; }},
        {[](Inputs& in) { in.reference.pose[0] = nan; }, 0}}},
      {GateFault::command_invalid,
       {{[](Inputs& in) { in.command.valid = false; }, 0, [](Inputs& in) { in.reference.valid = false; }}}},
      {GateFault::command_stale, bad_stamps([](Inputs& in) -> Time& { return in.command.computed; })},
      {GateFault::command_not_finite,
       {{torque(nan), 0,
         [](Inputs& in) {  // as large as a number can be, where it has grown slowly up to 100 Nm
           in.command.torque[1] = number(in) < 3 ? 40.0 * number(in) : std::numeric_limits<double>::max();
         },
         10},
        {torque(-infinity), 0},
        {[](Inputs& in) { in.command.torque.conservativeResize(2); }, 0}}},
      {GateFault::torque_jump, {{torque(-40.01), 0, torque(-40.0)}, {torque(40.01), 0, torque(40.0)}}},
      {GateFault::operator_stop,
       {{[](Inputs& in) { in.buttons.stop = true; }, 0,
         [](Inputs& in) { in.buttons = {.start = true, .reset = true, .stop = false}; }}}},
      {GateFault::touched_in_recovery,
       {{touched(ContactLevel::reaction, recover), 0, touched(ContactLevel::none, recover)},
        {touched(ContactLevel::hard, recover), 0, touched(ContactLevel::hard, ReactionMode::nominal)}}},
  };
}

/// What the plausibility monitor has found is a fault in the same tick; what it says nothing of is none.
std::vector<Way> contradicted(GateFault fault) {
  const auto found = [fault](bool valid) {
    return [=](Inputs& in) { in.plausibility.valid = valid, in.plausibility.present = fault_bit(fault); };
  };
  return {{found(true), 0, found(false)}};
}

std::map<GateFault, std::vector<Way>> ways_of_contradictions() {
  std::map<GateFault, std::vector<Way>> all;
  for (const GateFault fault :
       {GateFault::motion_contradicted, GateFault::drive_not_following, GateFault::drives_without_effect,
        GateFault::stop_ineffective, GateFault::brake_not_holding, GateFault::status_contradicted,
        GateFault::torque_contradicted}) {
    all[fault] = contradicted(fault);
  }
  return all;
}

const std::map<GateFault, std::vector<Way>>& ways() {
  static const auto all = [] {
    auto together = ways_of_station_and_sensors();
    together.merge(ways_of_pose_and_workspace());
    together.merge(ways_of_laws_and_operator());
    together.merge(ways_of_contradictions());
    for (const GateFault fault :
         {GateFault::encoder_jump, GateFault::encoder_frozen, GateFault::encoders_implausible}) {
      together[fault] = together[fault] + contradicted(fault);
    }
    return together;
  }();
  return all;
}

class EveryFault : public testing::TestWithParam<FaultRow> {
 protected:
  const FaultRow& row() const { return GetParam(); }
  const std::vector<Way>& ways_of_row() const { return ways().at(row().fault); }

  /// Whether a pipeline is open after ten healthy milliseconds.
  void open(Safety& safety) const {
    while (safety.ticking.now() <= open_for) safety.tick();
    ASSERT_EQ(safety.status().phase, GatePhase::open);
  }
  static void tick_with(Safety& safety, const std::function<void(Inputs&)>& change) {
    Inputs inputs(*safety.robot, safety.ticking.now());
    change(inputs);
    safety.tick(inputs);
  }
  void expect_reaction(const Safety& safety) const {
    EXPECT_EQ(safety.status().fault, row().fault);
    EXPECT_EQ(safety.status().reaction, row().reaction());
    const TorqueCommand& torque = safety.ticking.get(safety.gate.torque_command);
    if (row().reaction() == GateReaction::controlled_stop) {
      EXPECT_TRUE(torque.valid);
      EXPECT_EQ(torque.torque, Eigen::Vector3d(7.0, 8.0, 9.0));
    } else {
      EXPECT_FALSE(torque.valid);
      EXPECT_TRUE(safety.ticking.get(safety.gate.brake).engage);
    }
  }

  /// Does it for each way of the row, with a pipeline of its own.
  void for_each_way(const std::function<void(Safety&, const Way&)>& check) const {
    ASSERT_TRUE(ways().contains(row().fault)) << "no test brings this fault about: " << row().description;
    for (const Way& way : ways_of_row()) {
      SCOPED_TRACE("way " + std::to_string(&way - ways_of_row().data()) + " of: " + row().description);
      Safety safety;
      check(safety, way);
    }
  }
};

/// "the laws' torques jump" as TheLawsTorquesJump.
std::string in_one_word(const std::string& sentence) {
  std::string word;
  bool first = true;
  for (const char letter : sentence) {
    const auto code = static_cast<unsigned char>(letter);
    if (std::isalnum(code) != 0) word += static_cast<char>(first ? std::toupper(code) : code);
    first = letter == ' ';
  }
  return word;
}

INSTANTIATE_TEST_SUITE_P(FaultTable, EveryFault,
                         testing::ValuesIn(fault_table().begin(), fault_table().end()),
                         [](const auto& row) { return in_one_word(row.param.description); });

TEST_P(EveryFault, ClosesTheGateInTimeWithItsReaction) {
  int longest = 0;
  for_each_way([&](Safety& safety, const Way& way) {
    open(safety);
    for (int tick = 0; tick < way.latency; ++tick) {
      tick_with(safety, way.fault);
      ASSERT_EQ(safety.status().phase, GatePhase::open) << "earlier than its latency: state the smaller one";
    }
    tick_with(safety, way.fault);
    ASSERT_EQ(safety.status().phase, GatePhase::closed);
    expect_reaction(safety);
    longest = std::max(longest, way.latency);
  });
  EXPECT_EQ(row().latency, longest);
}

TEST_P(EveryFault, LatchesUntilResetAndKeepsTheGateClosedWhileItLasts) {
  for_each_way([&](Safety& safety, const Way& way) {
    open(safety);
    for (int tick = 0; tick <= way.latency; ++tick) tick_with(safety, way.fault);
    safety.tick();
    safety.tick();
    EXPECT_EQ(safety.status().phase, GatePhase::closed) << "latched";
    EXPECT_EQ(safety.status().fault, row().fault);
    safety.tick(true);
    EXPECT_EQ(safety.status().phase, GatePhase::open);
  });
}

TEST_P(EveryFault, IsNotSeenAtItsLimit) {
  int limits = 0;
  for_each_way([&](Safety& safety, const Way& way) {
    if (!way.just_not) return;
    ++limits;
    open(safety);
    for (int tick = 0; tick < way.lasting; ++tick) {
      tick_with(safety, way.just_not);
      EXPECT_EQ(safety.present(), FaultMask{0}) << "tick " << tick;
    }
  });
  EXPECT_GT(limits, 0);
}

TEST_P(EveryFault, KeepsTheGateFromOpeningAtTheStart) {
  const std::set<GateFault> seen_by_comparison{GateFault::encoder_jump, GateFault::encoder_frozen,
                                               GateFault::torque_jump};
  if (seen_by_comparison.contains(row().fault)) return;  // there is nothing yet to compare with
  for_each_way([](Safety& safety, const Way& way) {
    for (int tick = 0; tick < 20; ++tick) {
      tick_with(safety, [&way](Inputs& inputs) {
        inputs.last_seen = -10ms;
        way.fault(inputs);
      });
      ASSERT_EQ(safety.status().phase, GatePhase::waiting);
    }
  });
}

TEST_P(EveryFault, IsDescribedAndPromisesAReaction) {
  EXPECT_NE(std::string(row().description), "");
  EXPECT_NE(row().reaction(), GateReaction::none);
  EXPECT_GE(row().latency, 0);
  EXPECT_EQ(first_fault(fault_bit(row().fault)), row().fault);
  EXPECT_EQ(worst_reaction(fault_bit(row().fault)), row().reaction());
}

// ---------------------------------------------------------------- the table as a whole

TEST(FaultTable, LetsNoTorqueOutWhereWhatWouldSteerItIsInDoubt) {
  for (const FaultRow& row : fault_table()) {
    const bool trusted =
        row.doubt == Doubt::nothing || row.doubt == Doubt::laws || row.doubt == Doubt::currents;
    EXPECT_EQ(row.reaction(), trusted ? GateReaction::controlled_stop : GateReaction::zero_torque_and_brake)
        << row.description;
  }
}

TEST(FaultTable, NamesEveryFaultOnce) {
  std::set<GateFault> named;
  for (const FaultRow& row : fault_table()) named.insert(row.fault);
  EXPECT_EQ(named.size(), fault_table().size());
  EXPECT_EQ(ways().size(), fault_table().size());
  EXPECT_LT(fault_table().size(), 63U)
      << "a set of faults has 64 bits, the first for none, and is recorded signed";
}

TEST(FaultTable, IsEmptyForTheHealthyRobot) {
  Safety safety;
  for (int k = 0; k < 20; ++k) {
    safety.tick();
    EXPECT_EQ(safety.present(), FaultMask{0});
  }
}

TEST(FaultTable, HasNoFirstFaultAndNoReactionForTheEmptySet) {
  EXPECT_EQ(first_fault(0), GateFault::none);
  EXPECT_EQ(worst_reaction(0), GateReaction::none);
}

}  // namespace
}  // namespace flinch
