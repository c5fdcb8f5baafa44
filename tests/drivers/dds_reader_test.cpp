#include "drivers/dds_reader.h"

#include <drivers/idl/flinch.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <functional>
#include <iostream>
#include <thread>

#include "drivers/dds_writer.h"
#include "drivers/topics.h"
#include "systems/framework/monotonic_clock.h"
#include "tests/drivers/free_domain.h"

namespace flinch {
namespace {

void take_all(DdsArrivals arrivals, void* count) {
  flinch_TorqueSample sample;
  while (arrivals.take(&sample)) ++*static_cast<std::atomic<int>*>(count);
}

/// Writes every millisecond, until killed: a program of its own.
class CommandingProgram {
 public:
  explicit CommandingProgram(std::uint32_t domain) : id_(::fork()) {
    if (id_ != 0) return;
    const DdsBus bus({.domain = domain});
    DdsWriter writer(bus, torque_command_topic);
    const flinch_TorqueSample sample{};
    for (;;) {
      writer.write(&sample);
      std::this_thread::sleep_for(1ms);
    }
  }
  CommandingProgram(const CommandingProgram&) = delete;
  CommandingProgram& operator=(const CommandingProgram&) = delete;
  ~CommandingProgram() {
    signal(SIGKILL);
    ::waitpid(id_, nullptr, 0);
  }

  void signal(int number) const { ::kill(id_, number); }

 private:
  pid_t id_;
};

bool wait_until(const std::function<bool()>& holds) {
  const Time end = MonotonicClock::now() + 10s;
  while (!holds() && MonotonicClock::now() < end) std::this_thread::sleep_for(1ms);
  return holds();
}

class ListensToACommander : public testing::Test {
 protected:
  ListensToACommander() {
    EXPECT_TRUE(wait_until([this] { return arrived_ > 100; }));
    before_ = reader_.broken_promises();  // a busy machine breaks some
  }

  BrokenPromises since() const {
    const BrokenPromises now = reader_.broken_promises();
    return {now.deadlines - before_.deadlines, now.silences - before_.silences};
  }

  std::uint32_t domain_ = test::free_domain();
  CommandingProgram commander_{domain_};
  DdsBus bus_{BusSettings{.domain = domain_}};
  std::atomic<int> arrived_ = 0;
  DdsReader reader_{bus_, torque_command_topic, &take_all, &arrived_};
  BrokenPromises before_;
};

TEST_F(ListensToACommander, ThatHangsAndCountsItsDeadlinesAndItsSilence) {
  EXPECT_LT(before_.deadlines, 50u);  // of more than 100 ms
  commander_.signal(SIGSTOP);
  const Time stopped = MonotonicClock::now();
  ASSERT_TRUE(wait_until([this] { return since().silences >= 1; }));
  const Time noticed = MonotonicClock::now() - stopped;
  std::cout << "a hung commander noticed after " << 1e3 * to_seconds(noticed) << " ms, " << since().deadlines
            << " deadlines missed by then" << std::endl;
  EXPECT_TRUE(wait_until([this] { return since().deadlines >= 3; }));

  commander_.signal(SIGCONT);
  const int arrived = arrived_;
  EXPECT_TRUE(wait_until([&] { return arrived_ > arrived + 100; }));
  before_ = reader_.broken_promises();
  commander_.signal(SIGSTOP);
  EXPECT_TRUE(wait_until([this] { return since().silences >= 1; }));
}

TEST_F(ListensToACommander, ThatIsKilledAndCountsItsDeadlinesAndItsSilence) {
  commander_.signal(SIGKILL);
  EXPECT_TRUE(wait_until([this] { return since().silences >= 1 && since().deadlines >= 3; }));
}

TEST(DdsReader, HasNothingToComplainOfWhileNobodyHasPromised) {
  const DdsBus bus({.domain = test::free_domain()});
  std::atomic<int> arrived = 0;
  const DdsReader reader(bus, torque_command_topic, &take_all, &arrived);
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(reader.broken_promises().deadlines, 0u);
  EXPECT_EQ(reader.broken_promises().silences, 0u);
}

}  // namespace
}  // namespace flinch
