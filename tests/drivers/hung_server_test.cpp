// A robot's program that hangs in mid-motion and goes on: what it tells of its brakes then.
#include <drivers/idl/flinch.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <vector>

#include "drivers/dds_reader.h"
#include "drivers/topics.h"
#include "drivers/wire_header.h"
#include "systems/framework/monotonic_clock.h"
#include "tests/drivers/link_ends.h"
#include "tests/support/free_domain.h"
#include "tests/support/other_program.h"

namespace flinch {
namespace {

using test::FarEnd;
using test::NearEnd;
using test::OtherProgram;

/// All that a robot says of itself.
class StatusLog {
 public:
  explicit StatusLog(const DdsBus& bus) : reader_(bus, status_topic, &append, this) {}

  std::size_t count() const {
    const std::lock_guard lock(mutex_);
    return samples_.size();
  }
  /// How many tell of open brakes as they were longer ago than that, and call it valid.
  std::ptrdiff_t open_before(Time age) const {
    const std::lock_guard lock(mutex_);
    return std::count_if(samples_.begin(), samples_.end(), [&](const flinch_StatusSample& sample) {
      const bool is_valid = (sample.header.flags & flag_valid) != 0;
      return is_valid && sample.braked == 0 && Time(sample.header.sent_ns - sample.header.acquired_ns) > age;
    });
  }

 private:
  static void append(DdsArrivals arrivals, void* owner) {
    auto& log = *static_cast<StatusLog*>(owner);
    flinch_StatusSample sample;
    const std::lock_guard lock(log.mutex_);
    while (arrivals.take(&sample)) log.samples_.push_back(sample);
  }

  mutable std::mutex mutex_;
  std::vector<flinch_StatusSample> samples_;
  DdsReader reader_;  // last: ends before what it writes to
};

TEST(AServerThatHung, TellsNothingOfItsBrakesThatItHasSeenBefore) {
  const std::uint32_t domain = test::free_domain();
  const OtherProgram controller([domain] {
    const DdsBus bus({.domain = domain});
    NearEnd(bus).run([] { return false; });
  });
  const DdsBus bus({.domain = domain});
  const StatusLog log(bus);
  FarEnd far(bus);
  int open = 0, hung = 0;
  bool has_just_hung = false;
  far.run(
      [&] {
        if (has_just_hung)
          MonotonicClock::sleep_until(MonotonicClock::now() + 1ms);  // the sending thread first
        return hung == 10;
      },
      [&] {
        has_just_hung = !far.brake() && ++open % 20 == 0;
        if (!has_just_hung) return;
        MonotonicClock::sleep_until(MonotonicClock::now() + 30ms);
        ++hung;
      });
  EXPECT_GT(log.count(), 200u);
  EXPECT_EQ(log.open_before(20ms), 0);
}

}  // namespace
}  // namespace flinch
