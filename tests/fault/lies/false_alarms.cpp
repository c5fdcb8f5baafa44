#include "tests/fault/lies/false_alarms.h"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <mutex>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/simulated/simulated_scenario.h"
#include "systems/config/config_node.h"
#include "systems/safety/fault_table.h"
#include "systems/signals/gate_status.h"
#include "tests/fault/scenario_loop.h"

namespace flinch::test {
namespace {

constexpr std::array names{"jump",          "isolated", "pair",   "quiet angle",   "gyroscope",
                           "accelerometer", "parity",   "tube",   "quiet current", "still",
                           "stop",          "brakes",   "status", "response"};
static_assert(names.size() == plausibility_checks);

/// The largest force between the robot and what it touches [N].
double force_of(const ContactTruth& contact) { return contact.strongest.strength(); }

}  // namespace

void Margins::add(const Margins& other) {
  runs += other.runs;
  seconds += other.seconds;
  touched += other.touched;
  peak_force = std::max(peak_force, other.peak_force);
  for (const auto& [fault, count] : other.alarms) alarms[fault] += count;
  for (std::size_t i = 0; i < largest.size(); ++i) largest[i] = std::max(largest[i], other.largest[i]);
}

int Margins::false_alarms() const {
  int all = 0;
  for (const auto& [fault, count] : alarms) all += count;
  return all;
}

std::string Margins::table() const {
  std::string text = fmt::format("{} runs, {:.2f} h, {} with contacts of up to {:.0f} N, {} false alarms",
                                 runs, seconds / 3600.0, touched, peak_force, false_alarms());
  for (const auto& [fault, count] : alarms)
    text += fmt::format(" (fault {}: {})", static_cast<int>(fault), count);
  text += "\n";
  for (std::size_t i = 0; i < largest.size(); ++i)
    text += fmt::format("  {:14} {:.3f}\n", names[i], largest[i]);
  return text;
}

Margins margins_of(SimulatedScenario scenario, const MountedSensors& sensors) {
  scenario.station.encoders.passive_mounted = sensors.passive_encoders;
  scenario.control.forward_kinematics.initial_pose = scenario.station.rig.initial_pose;
  if (!sensors.imu) scenario.station.faults.push_back({.signal = FaultSignal::imu, .kind = FaultKind::off});
  ScenarioLoop loop(scenario);
  const SimulatedStation& station = loop.station;
  const ContactControl& control = loop.control;
  const Context& context = loop.context;
  Margins margins;
  margins.runs = 1;
  while (context.time() < scenario.duration) {
    loop.tick();
    margins.peak_force = std::max(margins.peak_force, force_of(context.get(station.contact_truth)));
    const Plausibility& found = context.get(control.plausibility);
    for (std::size_t i = 0; i < found.ratio.size(); ++i)
      margins.largest[i] = std::max(margins.largest[i], found.ratio[i]);
    if (found.present != 0) {
      ++margins.alarms[first_fault(found.present)];
      break;
    }
    if (context.get(control.gate).phase == GatePhase::closed) break;
    if (context.get(control.gate).phase == GatePhase::open)
      margins.seconds += to_seconds(scenario.control_period);
  }
  margins.touched = margins.peak_force > 0.0 ? 1 : 0;
  return margins;
}

Margins margins_of_campaign(const std::string& file, std::size_t runs, const MountedSensors& sensors,
                            Time period) {
  Campaign campaign = read_campaign(file);
  if (period != 1ms) {
    const auto node = std::make_shared<ConfigNode>();
    node->kind = ConfigNode::Kind::scalar;
    node->scalar = std::to_string(period / 1us);
    campaign.grid.push_back({"control_period_us", {node}});
  }
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  Margins all;
  const auto work = [&] {
    for (std::size_t number = next++; number < runs; number = next++) {
      const Margins margins = margins_of(draw_run(campaign, number).scenario, sensors);
      if (margins.peak_force > 800.0) continue;
      const std::lock_guard lock(mutex);
      all.add(margins);
      for (const auto& [fault, count] : margins.alarms)
        fmt::print("run {}: fault {}\n", number, static_cast<int>(fault));
    }
  };
  auto other = std::async(std::launch::async, work);
  work();
  other.wait();
  return all;
}

}  // namespace flinch::test
