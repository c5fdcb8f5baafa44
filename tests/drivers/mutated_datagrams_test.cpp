// Datagrams of a link with random errors in them, as far as Cyclone DDS takes them apart: what they do to a
// robot that nobody commands, and to one that somebody does.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

#include "systems/framework/monotonic_clock.h"
#include "tests/drivers/datagram_mutator.h"
#include "tests/drivers/key_folder.h"
#include "tests/drivers/link_ends.h"
#include "tests/drivers/outsider.h"
#include "tests/support/free_domain.h"
#include "tests/support/other_program.h"
#include "tests/support/shared_memory.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

using test::FarEnd;
using test::KeyFolder;
using test::Mutants;
using test::NearEnd;
using test::OtherProgram;
using test::Outsider;
using test::SharedMemory;
using ::testing::HasSubstr;

/// Mutants that each robot gets.
std::uint32_t enough() {
  static const auto count = test::wanted<std::uint32_t>("FLINCH_MUTANTS", 3000);
  return count;
}

/// What a robot's program writes to its terminal.
class Terminal {
 public:
  Terminal() : file_(::memfd_create("terminal", MFD_CLOEXEC)) {}
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  ~Terminal() { ::close(file_); }

  void belongs_to_this_program() const {
    ::dup2(file_, STDOUT_FILENO);
    ::dup2(file_, STDERR_FILENO);
  }
  std::string text() const {
    struct stat status {};
    ::fstat(file_, &status);
    std::string text(static_cast<std::size_t>(status.st_size), '\0');
    text.resize(static_cast<std::size_t>(std::max<ssize_t>(::pread(file_, text.data(), text.size(), 0), 0)));
    return text;
  }

 private:
  int file_;
};

/// What a robot saw.
struct Seen {
  std::atomic<bool> ready = false;
  std::uint32_t commands = 0;    ///< torque commands that came through the bus while mutants were sent
  std::uint32_t believed = 0;    ///< ticks with a torque that no controller has sent
  std::uint32_t released = 0;    ///< ticks with open brakes while nobody commanded
  std::uint32_t commanded = 0;   ///< ticks while mutants were sent with a torque of the controller
  std::uint32_t afterwards = 0;  ///< ticks after the mutants with one
};

/// A controller's torque is what some earlier tick of the robot has told of its angles.
bool is_of_a_controller(const TorqueCommand& command) {
  const double tick = std::round(1e3 * command.torque[0]);
  const JointVector told = to_seconds(1ms * static_cast<int>(tick)) * JointVector::LinSpaced(3, 1.0, 3.0);
  return command.torque.size() == 3 && tick >= 0.0 && tick < 1e7 && command.torque == told;
}

/// Runs until it has seen enough mutants, or those that there are, and a controller for 300 ticks after.
void run_robot(const BusSettings& settings, const Terminal& terminal, Mutants& mutants, Seen& seen,
               bool is_commanded) {
  terminal.belongs_to_this_program();
  const DdsBus bus(settings);
  FarEnd far(bus);
  int ticks = 0, before = 0;
  far.run([&] {
    const TorqueCommand& torque = far.torque();
    const bool of_controller = torque.valid && is_of_a_controller(torque);
    const bool had_begun = mutants.go;
    const bool is_attacked = had_begun && mutants.sent < enough();
    if (torque.valid && !of_controller) ++seen.believed;
    before += of_controller ? 1 : 0;
    if (!is_commanded || before == 300) mutants.go = true;
    if (is_attacked) {
      seen.commanded += of_controller ? 1 : 0;
      seen.commands = far.server().commander().received + far.server().commander().refused;
      seen.released += !is_commanded && !far.brake() ? 1 : 0;
    } else if (had_begun) {
      seen.ready = true;
      seen.afterwards += of_controller ? 1 : 0;
    }
    return seen.afterwards == 300 || ++ticks == 60'000;
  });
}

void print(const char* how, const Mutants& mutants, const Seen& seen, const Terminal& terminal) {
  std::cout << how << ": " << mutants.sent << " mutants, " << seen.commands << " commands received, "
            << seen.believed << " torques believed that no controller has sent, " << seen.commanded
            << " that it has; afterwards " << seen.afterwards << "; " << terminal.text().size()
            << " letters on the terminal" << std::endl;
}

/// What a controller sends to a robot of that domain.
std::vector<test::Datagram> overheard(std::uint32_t domain) {
  const SharedMemory<Outsider> outsider;
  const OtherProgram controller([&] {
    outsider->overhear();
    const DdsBus bus({.domain = domain});
    NearEnd(bus).run([] { return false; });
  });
  const OtherProgram robot([&] {
    const DdsBus bus({.domain = domain});
    outsider->rehearses = true;
    FarEnd(bus).run([] { return false; });
  });
  return test::overheard(outsider->ends[0], domain);
}

TEST(MutatedDatagrams, DoNothingToARobotThatNobodyCommands) {
  const std::uint32_t domain = test::free_domain();
  const std::vector<test::Datagram> heard = overheard(domain);
  const SharedMemory<Mutants> mutants;
  const SharedMemory<Seen> seen;
  const Terminal terminal;
  OtherProgram robot([&] { run_robot({.domain = domain}, terminal, *mutants, *seen, false); });
  const OtherProgram attacker([&] { mutants->send(heard, enough()); });
  while (robot.is_running() && !seen->ready) MonotonicClock::sleep_until(MonotonicClock::now() + 1ms);
  const OtherProgram controller([&] {
    const DdsBus bus({.domain = domain});
    NearEnd(bus).run([] { return false; });
  });
  EXPECT_EQ(robot.wait(60s), 0);
  print("commanded by nobody", *mutants, *seen, terminal);
  EXPECT_GE(mutants->sent, enough());
  EXPECT_EQ(seen->commands, 0u);
  EXPECT_EQ(seen->believed, 0u);
  EXPECT_EQ(seen->released, 0u);
  EXPECT_EQ(seen->afterwards, 300u) << "it does not obey a controller any more";
  EXPECT_THAT(terminal.text(), HasSubstr("malformed")) << "nobody has looked at them";
  EXPECT_LT(terminal.text().size(), 2000u);
}

/// Lets mutants of all that a controller sends go to its robot beside them.
void accompany(const BusSettings& robots, const BusSettings& controllers, Mutants& mutants, Seen& seen,
               const Terminal& terminal) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe2(pipe.data(), O_CLOEXEC), 0);
  ::fcntl(pipe[1], F_SETFL, O_NONBLOCK);
  OtherProgram robot([&] { run_robot(robots, terminal, mutants, seen, true); });
  const OtherProgram attacker([&] { mutants.accompany(pipe[0], 8); });
  {
    const OtherProgram controller([&] {
      test::capture_datagrams(pipe[1]);
      const DdsBus bus(controllers);
      NearEnd(bus).run([] { return false; });
    });
    while (robot.is_running() && !seen.ready) MonotonicClock::sleep_until(MonotonicClock::now() + 1ms);
  }
  const OtherProgram another([&] {
    const DdsBus bus(controllers);
    NearEnd(bus).run([] { return false; });
  });
  EXPECT_EQ(robot.wait(60s), 0);
  EXPECT_GE(mutants.sent, enough());
  EXPECT_EQ(seen.afterwards, 300u) << "it does not obey a controller any more";
  EXPECT_THAT(terminal.text(), HasSubstr("malformed")) << "nobody has looked at them";
  EXPECT_LT(terminal.text().size(), 2000u);
}

TEST(MutatedDatagrams, OfItsControllerLeaveARobotAliveAndItsTerminalQuiet) {
  const std::uint32_t domain = test::free_domain();
  const SharedMemory<Mutants> mutants;
  const SharedMemory<Seen> seen;
  const Terminal terminal;
  accompany({.domain = domain}, {.domain = domain}, *mutants, *seen, terminal);
  print("without keys", *mutants, *seen, terminal);
}

TEST(MutatedDatagrams, OfItsControllerAreNeverBelievedWithKeys) {
  const std::uint32_t domain = test::free_domain();
  const KeyFolder keys;
  const SharedMemory<Mutants> mutants;
  const SharedMemory<Seen> seen;
  const Terminal terminal;
  accompany({.domain = domain, .security = keys.of(BusRole::robot)},
            {.domain = domain, .security = keys.of(BusRole::controller)}, *mutants, *seen, terminal);
  print("with keys", *mutants, *seen, terminal);
  EXPECT_EQ(seen->believed, 0u);
  EXPECT_GT(seen->commanded, 0u);
}

}  // namespace
}  // namespace flinch
