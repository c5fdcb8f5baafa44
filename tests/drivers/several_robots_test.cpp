// Several robots on one bus: whom commands reach. Programs are started once with keys and once without;
// FLINCH_ROBOT_STARTS says how often instead.
#include <dds/dds.h>
#include <drivers/idl/flinch.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

#include "drivers/dds_reader.h"
#include "drivers/dds_writer.h"
#include "drivers/sample_sender.h"
#include "tests/drivers/key_folder.h"
#include "tests/drivers/link_ends.h"
#include "tests/support/free_domain.h"
#include "tests/support/other_program.h"
#include "tests/support/shared_memory.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

using test::FarEnd;
using test::FarThread;
using test::link_robot;
using test::NearEnd;
using testing::HasSubstr;

/// Generous: nothing is learnt from a busy machine.
bool too_long(const NearEnd& near) { return near.time() > 60s; }

std::string name_of(std::size_t k) { return "robot_" + std::to_string(k); }

/// Notes in `last` whom a robot obeys, and in `changes` where it was another one before.
void note_commander(std::uint32_t session, std::atomic<std::uint32_t>& last, std::atomic<int>& changes) {
  if (session == 0) return;
  const std::uint32_t before = last.exchange(session);
  if (before != 0 && session != before) ++changes;
}

/// A robot that notes whom it has obeyed.
struct NotingRobot {
  explicit NotingRobot(const DdsBus& bus, const std::string& name = "")
      : far(bus, link_robot, name), running(far, [this] { note(); }) {}

  void note() {
    const DdsCommander now = far.server().commander();
    note_commander(now.session, commander, changes);
    if (!far.brake()) ++released;
    for_others = now.for_others;
  }

  std::atomic<std::uint32_t> commander = 0;  ///< the last that it has obeyed
  std::atomic<int> changes = 0;
  std::atomic<int> released = 0;  ///< ticks without brakes
  std::atomic<std::uint32_t> for_others = 0;
  FarEnd far;
  FarThread running;  // last
};

/// Starts robots and their stations, one for each, in an order drawn from `seed`; tells for each robot
/// whether it has obeyed its own station and no other.
void expect_each_obeys_its_own(std::size_t robots, unsigned seed) {
  const DdsBus bus({.domain = test::free_domain()});
  std::vector<std::unique_ptr<NotingRobot>> far(robots);
  std::vector<std::unique_ptr<NearEnd>> near(robots);
  std::vector<std::thread> commanding;
  std::atomic<std::size_t> served = 0;
  std::vector<std::size_t> order(2 * robots);
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937(seed));
  for (const std::size_t which : order) {
    const std::size_t k = which / 2;
    if (which % 2 == 0) {
      far[k] = std::make_unique<NotingRobot>(bus, name_of(k));
      continue;
    }
    near[k] = std::make_unique<NearEnd>(bus, link_robot, name_of(k));
    commanding.emplace_back([&served, &end = *near[k], robots] {
      int obeyed = 0;
      end.run([&] {
        if (end.dds().link().commands_obeyed && ++obeyed == 100) ++served;
        return served == robots || too_long(end);
      });
    });
  }
  for (std::thread& thread : commanding) thread.join();
  EXPECT_EQ(served, robots);
  for (std::size_t k = 0; k < robots; ++k) {
    EXPECT_EQ(far[k]->commander, near[k]->dds().session()) << name_of(k);
    EXPECT_EQ(far[k]->changes, 0) << name_of(k);
    EXPECT_EQ(near[k]->dds().link().robot_id, far[k]->far.server().robot_id());
  }
}

TEST(SeveralRobots, ObeyOnlyWhoCommandsThemWhicheverStartsFirst) {
  for (const std::size_t robots : {2u, 3u, 5u})
    expect_each_obeys_its_own(robots, 40 + static_cast<unsigned>(robots));
}

// ---------------------------------------------------------------- each end a program

/// What the programs of a robot and of its station tell while they run.
struct Told {
  std::atomic<std::uint64_t> robot_id = 0;        ///< of the robot
  std::atomic<std::uint32_t> commander = 0;       ///< whom the robot has obeyed last
  std::atomic<int> changes = 0;                   ///< how often it was another one
  std::atomic<std::uint32_t> for_others = 0;      ///< commands that the robot has refused so
  std::atomic<std::uint32_t> session = 0;         ///< of the station
  std::atomic<std::uint64_t> commanded = 0;       ///< the robot that the station commands
  std::atomic<int> obeyed = 0;                    ///< ticks at which the station saw its commands obeyed
  std::atomic<std::uint64_t> commanded_else = 0;  ///< another robot that it commanded before
  std::atomic<int> robots = 0;                    ///< that the station has seen by their names
};
constexpr std::size_t most_robots = 5;
using AllTold = std::array<Told, most_robots>;

/// Bus settings of a program.
using SettingsOf = std::function<BusSettings(BusRole)>;

[[noreturn]] void be_robot(const SettingsOf& settings, std::size_t k, Told& told) {
  const DdsBus bus(settings(BusRole::robot));
  FarEnd far(bus, link_robot, name_of(k));
  told.robot_id = far.server().robot_id();
  for (;;) {
    far.run([&] {
      const DdsCommander now = far.server().commander();
      note_commander(now.session, told.commander, told.changes);
      told.for_others = now.for_others;
      return false;
    });
  }
}

/// How many of the robots a station tells by name.
int named_among(const std::vector<SeenRobot>& seen, std::size_t robots) {
  int named = 0;
  for (std::size_t k = 0; k < robots; ++k) {
    named += std::any_of(seen.begin(), seen.end(),
                         [k](const SeenRobot& robot) { return robot.name == name_of(k); });
  }
  return named;
}

/// Chooses its robot by name, or by the identity that the robot tells once it has begun.
[[noreturn]] void be_station(const SettingsOf& settings, std::size_t k, std::size_t robots, bool by_name,
                             Told& told) {
  while (!by_name && told.robot_id == 0) MonotonicClock::sleep_until(MonotonicClock::now() + 1ms);
  const DdsBus bus(settings(BusRole::controller));
  NearEnd near(bus, link_robot, by_name ? name_of(k) : robot_id_text(told.robot_id));
  told.session = near.dds().session();
  for (;;) {
    int ticks = 0;
    near.run([&] {
      const DdsLink link = near.dds().link();
      const std::uint64_t before = told.commanded.exchange(link.robot_id);
      if (before != 0 && before != link.robot_id) told.commanded_else = before;
      if (link.commands_obeyed) ++told.obeyed;
      return ++ticks == 50;
    });
    told.robots = named_among(near.dds().robots(), robots);
  }
}

/// Whether each robot obeys its station and has heard the other commands, and each station sees all robots.
bool all_have_met(const AllTold& told, std::size_t robots) {
  const auto has_met = [robots](const Told& one) {
    return one.obeyed >= 100 && one.for_others >= 100 && one.robots == static_cast<int>(robots);
  };
  return std::all_of(told.begin(), told.begin() + static_cast<std::ptrdiff_t>(robots), has_met);
}

/// Starts 2 to 5 robots and a station for each, every one a program, in an order and with pauses drawn from
/// `seed`.
void expect_programs_to_find_their_own(const SettingsOf& settings, unsigned seed) {
  std::mt19937 draw(seed);
  const std::size_t robots = 2 + draw() % (most_robots - 1);
  SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(robots) + " robots");
  const test::SharedMemory<AllTold> told;
  std::vector<std::size_t> order(2 * robots);
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), draw);
  std::vector<std::unique_ptr<test::OtherProgram>> programs;
  for (const std::size_t which : order) {
    const std::size_t k = which / 2;
    const bool by_name = draw() % 2 == 0;
    programs.push_back(std::make_unique<test::OtherProgram>([&, k, which, by_name] {
      which % 2 == 0 ? be_robot(settings, k, (*told)[k])
                     : be_station(settings, k, robots, by_name, (*told)[k]);
    }));
    MonotonicClock::sleep_until(MonotonicClock::now() + (draw() % 30) * 1ms);
  }
  const Time deadline = MonotonicClock::now() + 30s;
  while (!all_have_met(*told, robots) && MonotonicClock::now() < deadline)
    MonotonicClock::sleep_until(MonotonicClock::now() + 5ms);
  for (std::size_t k = 0; k < robots; ++k) {
    const Told& one = (*told)[k];
    SCOPED_TRACE(name_of(k));
    EXPECT_GE(one.obeyed, 100);
    EXPECT_EQ(one.commander, one.session);
    EXPECT_EQ(one.changes, 0);
    EXPECT_EQ(one.commanded, one.robot_id);
    EXPECT_EQ(one.commanded_else, 0u);
    EXPECT_GE(one.for_others, 100u) << "commands of the others arrive here as well";
    EXPECT_EQ(one.robots, static_cast<int>(robots)) << "that this station tells by name";
  }
}

class StartsOfPrograms : public testing::TestWithParam<bool> {};

INSTANTIATE_TEST_SUITE_P(Bus, StartsOfPrograms, testing::Bool(),
                         [](const auto& secured) { return secured.param ? "WithKeys" : "WithoutKeys"; });

TEST_P(StartsOfPrograms, LeadEachStationToItsOwnRobotInAnyOrder) {
  const std::uint32_t domain = test::free_domain();
  std::optional<test::KeyFolder> keys;
  if (GetParam()) keys.emplace();
  const SettingsOf settings = [&](BusRole role) {
    BusSettings of_role{.domain = domain};
    if (keys) of_role.security = keys->of(role);
    return of_role;
  };
  const unsigned starts = test::wanted("FLINCH_ROBOT_STARTS", 1u);
  for (unsigned seed = 1; seed <= starts; ++seed) expect_programs_to_find_their_own(settings, seed);
}

// ---------------------------------------------------------------- whom to command

TEST(SeveralRobots, AreNotCommandedUnlessOneIsChosen) {
  const DdsBus bus({.domain = test::free_domain()});
  NotingRobot left(bus, "left"), right(bus, "right");
  NearEnd near(bus);
  int undecided = 0;
  near.run([&] {
    undecided += near.dds().is_undecided() ? 1 : 0;
    return undecided == 600 || too_long(near);
  });
  EXPECT_EQ(undecided, 600);
  EXPECT_EQ(near.dds().link().robot_id, 0u);
  EXPECT_EQ(left.commander, 0u);
  EXPECT_EQ(right.commander, 0u);
  EXPECT_EQ(left.released + right.released, 0);
  EXPECT_THAT(text_of(near.dds().robots()),
              HasSubstr("left (" + robot_id_text(left.far.server().robot_id())));
  EXPECT_THAT(text_of(near.dds().robots()),
              HasSubstr("right (" + robot_id_text(right.far.server().robot_id())));
}

TEST(SeveralRobots, AreNotCommandedWhereTwoHaveTheChosenName) {
  const DdsBus bus({.domain = test::free_domain()});
  NotingRobot one(bus, "arm"), other(bus, "arm");
  NearEnd near(bus, link_robot, "arm");
  int undecided = 0;
  near.run([&] {
    undecided += near.dds().is_undecided() ? 1 : 0;
    return undecided == 600 || too_long(near);
  });
  EXPECT_EQ(undecided, 600);
  EXPECT_EQ(one.commander, 0u);
  EXPECT_EQ(other.commander, 0u);
}

TEST(SeveralRobots, LeaveARunAloneInWhichAnotherAppears) {
  const DdsBus bus({.domain = test::free_domain()});
  NotingRobot first(bus);
  NearEnd near(bus);
  near.run([&] { return first.released > 100 || too_long(near); });
  ASSERT_GT(first.released, 100);
  NotingRobot second(bus);
  const int before = first.released;
  near.run([&] { return (second.for_others > 300 && first.released > before + 300) || too_long(near); });
  EXPECT_GT(second.for_others, 300u);
  EXPECT_GT(first.released, before + 300);
  EXPECT_EQ(second.commander, 0u);
  EXPECT_EQ(second.released, 0);
  EXPECT_EQ(first.changes, 0);
  EXPECT_EQ(near.dds().link().robots, 2);
  EXPECT_GT(near.dds().link().other_robot, 100u);
  EXPECT_EQ(near.dds().link().robot_id, first.far.server().robot_id());
}

/// A station that commands `first` when that robot falls silent, and then sees another robot.
struct AfterTheFirst {
  AfterTheFirst(const std::string& first_name, const std::string& second_name)
      : bus({.domain = test::free_domain()}) {
    auto first = std::make_unique<NotingRobot>(bus, first_name);
    near = std::make_unique<NearEnd>(bus, link_robot);
    near->run([&] { return first->released > 100 || too_long(*near); });
    EXPECT_GT(first->released, 100);
    first.reset();
    second = std::make_unique<NotingRobot>(bus, second_name);
  }

  DdsBus bus;
  std::unique_ptr<NearEnd> near;
  std::unique_ptr<NotingRobot> second;
};

TEST(SeveralRobots, TakeNoOneElsesPlaceWhenTheirsIsGone) {
  for (const auto& [first, second] : {std::pair("left", "right"), std::pair("", "")}) {
    AfterTheFirst then(first, second);
    then.near->run([&] { return then.second->for_others > 1500 || too_long(*then.near); });
    EXPECT_GT(then.second->for_others, 1500u) << "the station commands on";
    EXPECT_EQ(then.second->commander, 0u);
    EXPECT_EQ(then.second->released, 0);
  }
}

TEST(SeveralRobots, AreFoundAgainByTheNameUnderWhichTheyAreStartedAgain) {
  AfterTheFirst then("arm", "arm");
  const auto obeyed = [&] { return then.second->commander == then.near->dds().session(); };
  then.near->run([&] { return obeyed() || too_long(*then.near); });
  EXPECT_TRUE(obeyed());
  EXPECT_EQ(then.near->dds().link().robot_id, then.second->far.server().robot_id());
}

/// Commands of no torque, the way in which everybody may begin, that name a robot.
class Neutral {
 public:
  Neutral(const DdsBus& bus, std::uint64_t robot_id)
      : robot_id_(robot_id), writer_(bus, torque_command_topic) {}

  void send() {
    flinch_TorqueSample sample{};
    sample.header.acquired_ns = MonotonicClock::now().count();
    sample.header.count = 3;
    sample.header.flags = flag_engage_brake;
    stamp(sample.header, {.session = session_, .robot = link_robot, .robot_id = robot_id_}, ++number_);
    writer_.write(&sample);
  }

 private:
  std::uint64_t robot_id_;
  std::uint32_t session_ = draw_session();
  std::uint32_t number_ = 0;
  DdsWriter writer_;
};

/// How many commands a robot admits of those that name a robot, while it refuses a hundred or admits one.
DdsCommander answer_to(const std::function<std::uint64_t(const FarEnd&)>& named) {
  const DdsBus bus({.domain = test::free_domain()});
  FarEnd far(bus, link_robot, "arm");
  Neutral commander(bus, named(far));
  int ticks = 0;
  far.run([&] {
    commander.send();
    const DdsCommander now = far.server().commander();
    return now.received > 0 || now.for_others > 100 || ++ticks > 30'000;
  });
  return far.server().commander();
}

TEST(ARobot, ObeysCommandsThatNameIt) {
  const DdsCommander answer = answer_to([](const FarEnd& far) { return far.server().robot_id(); });
  EXPECT_GT(answer.received, 0u);
  EXPECT_EQ(answer.for_others, 0u);
}

TEST(ARobot, RefusesCommandsThatNameAnotherOrNone) {
  for (const auto& named : std::vector<std::function<std::uint64_t(const FarEnd&)>>{
           [](const FarEnd&) { return std::uint64_t{0}; }, [](const FarEnd&) { return draw_robot_id("arm"); },
           [](const FarEnd& far) { return far.server().robot_id() ^ 1; },
           [](const FarEnd& far) { return far.server().robot_id() ^ (1ull << 63); }}) {
    const DdsCommander answer = answer_to(named);
    EXPECT_EQ(answer.received, 0u);
    EXPECT_GT(answer.for_others, 100u);
    EXPECT_EQ(answer.session, 0u);
  }
}

/// A program that writes samples of another type under the topic's name, as one with another protocol does.
test::OtherProgram other_protocol(std::uint32_t domain, const Topic& topic, const Topic& like) {
  return test::OtherProgram([=, &topic, &like] {
    const DdsBus bus({.domain = domain});
    const Topic other{topic.name, like.type, topic.kind, topic.sender};
    const DdsWriter writer(bus, other);
    for (;;) MonotonicClock::sleep_until(MonotonicClock::now() + 1ms);
  });
}

TEST(OtherProtocol, IsSeenAtBothEndsThoughNoneOfItsSamplesArrives) {
  const std::uint32_t domain = test::free_domain();
  const auto robot = other_protocol(domain, joints_topic, status_topic);
  const auto commander = other_protocol(domain, torque_command_topic, status_topic);
  const DdsBus bus({.domain = domain});
  FarEnd far(bus);
  NearEnd near(bus);
  int both = 0;
  near.run([&] {
    const bool seen = near.dds().unreadable_robots() == 1 && far.server().unreadable_commanders() == 1;
    both = seen ? both + 1 : 0;
    return both == 100 || too_long(near);
  });
  EXPECT_EQ(both, 100);
}

}  // namespace
}  // namespace flinch
