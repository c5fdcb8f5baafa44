#include "tests/fault/link/bus_tap.h"

#include "drivers/dds_reader.h"
#include "drivers/topics.h"
#include "systems/framework/monotonic_clock.h"
#include "systems/framework/realtime_thread.h"
#include "tests/support/two_networks.h"

namespace flinch::test {
namespace {

template <class Sample>
void append(DdsArrivals arrivals, void* place) {
  auto& track = *static_cast<Track<Sample>*>(place);
  while (arrivals.take(&track.next())) track.count.fetch_add(1, std::memory_order_release);
}

void listen(BusSettings settings, const std::string& network, BusLog& log) {
  if (!enter_network(network)) return;
  settings.realtime_priority = permits_realtime(85) ? 85 : 0;
  const DdsBus bus(settings);
  const DdsReader status(bus, status_topic, &append<flinch_StatusSample>, &log.status);
  const DdsReader joints(bus, joints_topic, &append<flinch_JointSample>, &log.joints);
  const DdsReader drives(bus, drives_topic, &append<flinch_DriveSample>, &log.drives);
  const DdsReader commands(bus, torque_command_topic, &append<flinch_TorqueSample>, &log.commands);
  const DdsReader requests(bus, drive_request_topic, &append<flinch_DriveRequest>, &log.requests);
  for (;;) ::pause();
}

}  // namespace

BusTap::BusTap(const BusSettings& settings, const std::string& network)
    : program_([&] { listen(settings, network, *log_); }) {}

bool wait_until(Time patience, const std::function<bool()>& condition) {
  const Time deadline = MonotonicClock::now() + patience;
  while (!condition()) {
    if (MonotonicClock::now() > deadline) return false;
    MonotonicClock::sleep_until(MonotonicClock::now() + 1ms);
  }
  return true;
}

}  // namespace flinch::test
