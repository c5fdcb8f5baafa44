// Several robots on one bus: whom commands reach.
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
#include "tests/drivers/link_ends.h"
#include "tests/support/free_domain.h"
#include "tests/support/other_program.h"

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

/// A robot that notes whom it has obeyed.
struct NotingRobot {
  explicit NotingRobot(const DdsBus& bus, const std::string& name = "")
      : far(bus, link_robot, name), running(far, [this] { note(); }) {}

  void note() {
    const std::uint32_t session = far.server().commander().session;
    const std::uint32_t before = commander.exchange(session == 0 ? commander.load() : session);
    if (session != 0 && before != 0 && session != before) ++changes;
    if (!far.brake()) ++released;
    for_others = far.server().commander().for_others;
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
