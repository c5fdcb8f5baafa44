#include "drivers/dds_reader.h"

#include <drivers/idl/flinch.h>
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <iostream>
#include <thread>

#include "drivers/dds_writer.h"
#include "drivers/topics.h"
#include "systems/framework/monotonic_clock.h"
#include "tests/support/free_domain.h"
#include "tests/support/other_program.h"

namespace flinch {
namespace {

using test::OtherProgram;

void take_all(DdsArrivals arrivals, void* count) {
  flinch_TorqueSample sample;
  while (arrivals.take(&sample)) ++*static_cast<std::atomic<int>*>(count);
}

OtherProgram commanding_program(std::uint32_t domain) {
  return OtherProgram([domain] {
    const DdsBus bus({.domain = domain});
    DdsWriter writer(bus, torque_command_topic);
    const flinch_TorqueSample sample{};
    for (;;) {
      writer.write(&sample);
      std::this_thread::sleep_for(1ms);
    }
  });
}

bool wait_until(const std::function<bool()>& holds) {
  const Time end = MonotonicClock::now() + 10s;
  while (!holds() && MonotonicClock::now() < end) std::this_thread::sleep_for(1ms);
  return holds();
}

class ListensToACommander : public testing::Test {
 protected:
  ListensToACommander() {
    EXPECT_TRUE(wait_until([this] { return arrived_ > 100; }));
    before_ = reader_.qos_mismatch();  // a busy machine breaks some
  }

  QosMismatch since() const {
    const QosMismatch now = reader_.qos_mismatch();
    return {now.deadlines - before_.deadlines, now.silences - before_.silences};
  }

  std::uint32_t domain_ = test::free_domain();
  OtherProgram commander_ = commanding_program(domain_);
  DdsBus bus_{BusSettings{.domain = domain_}};
  std::atomic<int> arrived_ = 0;
  DdsReader reader_{bus_, torque_command_topic, &take_all, &arrived_};
  QosMismatch before_;
};

TEST_F(ListensToACommander, ThatHangsAndCountsItsDeadlinesAndItsSilence) {
  EXPECT_LT(before_.deadlines, 50u);  // of more than 100 ms
  commander_.stop();
  const Time stopped = MonotonicClock::now();
  ASSERT_TRUE(wait_until([this] { return since().silences >= 1; }));
  const Time detected = MonotonicClock::now() - stopped;
  std::cout << "a hung commander detected after " << 1e3 * to_seconds(detected) << " ms, "
            << since().deadlines << " deadlines missed by then" << std::endl;
  EXPECT_TRUE(wait_until([this] { return since().deadlines >= 3; }));

  commander_.resume();
  const int arrived = arrived_;
  EXPECT_TRUE(wait_until([&] { return arrived_ > arrived + 100; }));
  before_ = reader_.qos_mismatch();
  commander_.stop();
  EXPECT_TRUE(wait_until([this] { return since().silences >= 1; }));
}

TEST_F(ListensToACommander, ThatIsKilledAndCountsItsDeadlinesAndItsSilence) {
  commander_.kill();
  EXPECT_TRUE(wait_until([this] { return since().silences >= 1 && since().deadlines >= 3; }));
}

TEST(DdsReader, HasNothingToComplainOfWhileNobodyHasPromised) {
  const DdsBus bus({.domain = test::free_domain()});
  std::atomic<int> arrived = 0;
  const DdsReader reader(bus, torque_command_topic, &take_all, &arrived);
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(reader.qos_mismatch().deadlines, 0u);
  EXPECT_EQ(reader.qos_mismatch().silences, 0u);
}

}  // namespace
}  // namespace flinch
