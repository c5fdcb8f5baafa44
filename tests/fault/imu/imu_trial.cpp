#include "tests/fault/imu/imu_trial.h"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <numbers>

#include "diagrams/requested_fault.h"
#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_run.h"
#include "systems/framework/random.h"
#include "systems/robot/imu_mount.h"
#include "tests/fault/scenario_loop.h"
#include "tests/support/wanted.h"

namespace flinch::test {
namespace {

constexpr Time watched = 300ms;   // after a failure
constexpr Time patience = 100ms;  // after a contact

/// A run as these trials look at it, by ticks.
struct ImuRun {
  std::vector<double> speed;
  std::vector<Eigen::Vector3d> force;  // of the unit
  std::vector<Eigen::Vector3d> truth;  // what it should say of the tick, without noise and bias
  std::optional<std::size_t> touched, stopped, named;
  ImuFault doubt = ImuFault::none;
  std::map<std::string, std::size_t> detected;
};

ImuRun run(SimulatedScenario scenario, const std::vector<std::string>& faults, Time end) {
  for (const std::string& each : faults)
    scenario.station.faults.push_back(parse_fault(each, *scenario.robot.robot));
  ScenarioLoop loop(scenario);
  const SimulatedStation& station = loop.station;
  const ContactControl& control = loop.control;
  const Context& context = loop.context;
  std::vector<Named<OutputPort<ContactDetection>>> detectors = control.others.detections;
  for (const auto& each : control.others.detections_by_estimator) {
    // That needs 74 N, by which the momentum observer that it falls back to misses most contacts.
    if (each.name != "detection_by_direct_imu_ekf") detectors.push_back(each);
  }
  const auto& robot = *scenario.robot.robot;
  ImuRun result;
  while (context.time() < end) {
    const std::size_t tick = result.speed.size();
    loop.tick();
    const PlantTruth& truth = context.get(station.plant_truth);
    result.speed.push_back(truth.velocity.head(2).norm());
    result.truth.push_back(
        specific_force(spatial_motion(robot.space(), truth.pose, truth.velocity, truth.acceleration),
                       ImuMount().position_in_platform, robot.gravity()));
    result.force.push_back(context.get(station.imu).specific_force);
    const Plausibility& found = context.get(control.plausibility);
    if (!result.named && found.imu_doubt != ImuFault::none) {
      result.named = tick;
      result.doubt = found.imu_doubt;
    }
    if (!result.touched && context.get(station.contact_truth).strongest.strength() > 0.0)
      result.touched = tick;
    for (const auto& each : detectors) {
      if (context.get(each.port).level != ContactLevel::none) result.detected.try_emplace(each.name, tick);
    }
    if (!result.stopped && tick > 400 && context.get(control.gate).phase == GatePhase::closed)
      result.stopped = tick;
  }
  return result;
}

double degrees(double angle) { return angle * std::numbers::pi / 180.0; }

Campaign campaign(const std::string& name) {
  CampaignOverrides overrides;
  overrides.seed = wanted<std::uint64_t>("FLINCH_IMU_SEED",
                                         271828);  // other robots than those by which the rule was chosen
  overrides.draws = 1000;
  return read_campaign(std::string(FLINCH_SOURCE_DIR "/apps/campaigns/") + name + ".yaml", overrides);
}

/// The scenario with a unit whose stamps err within a range that is known.
SimulatedScenario with_stamps(SimulatedScenario scenario, Time spread) {
  scenario.station.imu.clock.delay_jitter = spread / 2;
  scenario.control.imu_stamp_spread = spread;
  return scenario;
}

const Campaign& free_motion() {
  static const Campaign motions = campaign("false_alarms");
  return motions;
}

/// The failure as faults on request; sizes are drawn.
std::vector<std::string> faults_of(const std::string& kind, double at, RandomGenerator& random) {
  const auto one_of_three = [&random] { return 1 + static_cast<int>(random.uniform(0.0, 2.999)); };
  const double sign = random.uniform(-1.0, 1.0) < 0.0 ? -1.0 : 1.0;
  const double size = std::pow(20.0, random.uniform(0.0, 1.0));
  const int axis = one_of_three();
  if (kind == "dropped out") return {fmt::format("imu:off@{}", at)};
  if (kind == "frozen") return {fmt::format("imu:stuck@{}", at)};
  if (kind == "saturated") return {fmt::format("accelerometer:saturated@{}:10", at)};
  if (kind == "2 ms late") return {fmt::format("imu:delayed@{}:0.002", at)};
  if (kind == "accelerometer off")
    return {fmt::format("accelerometer{}:wrong@{}:{:.3f}", axis, at, sign * size)};
  if (kind == "gyroscope off")
    return {fmt::format("gyroscope{}:wrong@{}:{:.3f}", axis, at, 0.05 * sign * size)};
  if (kind == "turned")
    return {fmt::format("imu{}:turned@{}:{:.3f}", axis, at, sign * degrees(random.uniform(5.0, 30.0)))};
  return {fmt::format("gyroscope:noise@{}:0.0274", at), fmt::format("accelerometer:noise@{}:0.395", at)};
}

/// The first tick from `begin` on of which the unit tells with a failure that shows.
std::optional<std::size_t> first_wrong(const ImuFailure& failure, const ImuRun& honest, std::size_t begin) {
  for (std::size_t k = begin; k < honest.force.size(); ++k) {
    const bool shows =
        failure.right != ImuFault::saturated || honest.force[k].lpNorm<Eigen::Infinity>() > 10.5;
    if (honest.speed[k] > 0.3 && shows) return k;
  }
  return std::nullopt;
}

/// The first tick from `begin` on at which a unit that is 2 ms late tells of something else than it should.
std::optional<std::size_t> first_shown(const ImuRun& honest, std::size_t begin) {
  constexpr std::size_t delay = 4, late = 2;  // ticks
  for (std::size_t k = begin; k < honest.truth.size(); ++k) {
    if ((honest.truth[k - delay - late] - honest.truth[k - delay]).norm() > 0.3) return k;
  }
  return std::nullopt;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& each : words) text += (text.empty() ? "" : "+") + each;
  return text;
}

ImuOutcome outcome_of(const ImuRun& failed, std::size_t begin, const std::vector<std::string>& faults) {
  ImuOutcome outcome;
  outcome.told = joined(faults);
  outcome.doubt = failed.doubt;
  outcome.stopped = failed.stopped && (!failed.touched || *failed.stopped < *failed.touched);
  if (failed.named && *failed.named >= begin)
    outcome.named = Time(1ms) * static_cast<Time::rep>(*failed.named - begin);
  for (const auto& [name, tick] : failed.detected) {
    if (!failed.touched || tick < *failed.touched) outcome.false_contacts.push_back(name);
  }
  return outcome;
}

}  // namespace

std::vector<ImuFailure> imu_failures() {
  return {{"dropped out", ImuFault::dropped_out},
          {"frozen", ImuFault::frozen},
          {"saturated", ImuFault::saturated},
          {"2 ms late", ImuFault::late},
          {"accelerometer off", ImuFault::biased},
          {"gyroscope off", ImuFault::biased},
          {"turned", ImuFault::turned},
          {"tenfold noise", ImuFault::noisy}};
}

ImuFault doubt_of_honest_unit(std::size_t number, Time stamps) {
  return run(with_stamps(draw_run(free_motion(), number).scenario, stamps), {}, 2500ms).doubt;
}

ImuOutcome fail_in_motion(const ImuFailure& failure, std::size_t number, Time stamps) {
  const SimulatedScenario scenario = with_stamps(draw_run(free_motion(), number).scenario, stamps);
  RandomGenerator random(1000 + number);
  const auto wanted = static_cast<std::size_t>(random.uniform(700.0, 1700.0));
  const ImuRun honest = run(scenario, {}, 2500ms);
  const auto begin = first_wrong(failure, honest, wanted);
  if (!begin) return {.told = "no motion to fail in"};
  const auto faults = faults_of(failure.kind, 1e-3 * static_cast<double>(*begin), random);
  if (honest.named || honest.stopped)
    fmt::print("honest motion {}: doubt {} at {}, stopped at {}\n", number, name(honest.doubt),
               honest.named.value_or(0), honest.stopped.value_or(0));
  const ImuRun failed = run(scenario, faults, Time(1ms) * static_cast<Time::rep>(*begin) + watched);
  ImuOutcome outcome = outcome_of(failed, *begin, faults);
  const auto shown = failure.right == ImuFault::late ? first_shown(honest, *begin) : std::nullopt;
  if (shown) outcome.shown = Time(1ms) * static_cast<Time::rep>(*shown - *begin);
  return outcome;
}

ImuOutcome fail_before_contact(const ImuFailure& failure, std::size_t number, Time stamps) {
  static const Campaign contacts = campaign("detection_roc");
  const SimulatedScenario scenario = with_stamps(draw_run(contacts, number).scenario, stamps);
  RandomGenerator random(2000 + number);
  const ImuRun honest = run(scenario, {}, scenario.duration);
  if (!honest.touched) return {.told = "no contact"};
  const std::size_t begin = *honest.touched - static_cast<std::size_t>(random.uniform(0.0, 50.0));
  const auto faults = faults_of(failure.kind, 1e-3 * static_cast<double>(begin), random);
  if (honest.named || honest.stopped)
    fmt::print("honest contact {}: doubt {} at {}, stopped at {}\n", number, name(honest.doubt),
               honest.named.value_or(0) - *honest.touched, honest.stopped.value_or(0));
  const ImuRun failed =
      run(scenario, faults, Time(1ms) * static_cast<Time::rep>(*honest.touched) + 2 * patience);
  ImuOutcome outcome = outcome_of(failed, begin, faults);
  const auto in_time = [](const ImuRun& is, const std::string& name) {
    const auto found = is.detected.find(name);
    return found != is.detected.end() && is.touched && found->second < *is.touched + patience / 1ms;
  };
  for (const auto& [name, tick] : honest.detected) {
    if (!in_time(honest, name) || tick < *honest.touched) continue;
    ++outcome.contacts;
    if (!in_time(failed, name)) outcome.missed.push_back(name);
  }
  return outcome;
}

std::vector<ImuOutcome> try_failures(const ImuFailure& failure, std::size_t count,
                                     ImuOutcome (*trial)(const ImuFailure&, std::size_t, Time), Time stamps) {
  std::vector<ImuOutcome> outcomes(count);
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) outcomes[i] = trial(failure, i, stamps);
  };
  auto other = std::async(std::launch::async, work);
  work();
  other.get();
  return outcomes;
}

std::size_t named_late_since_shown(const std::vector<ImuOutcome>& outcomes) {
  std::size_t count = 0;
  for (const ImuOutcome& each : outcomes) {
    if (each.shown && (!each.named || *each.named > *each.shown + 20ms)) ++count;
  }
  return count;
}

std::string table_of_failures_head() {
  return "failure             onsets  in 20 ms  median  most  rightly  never  false contacts  stops | "
         "contacts  "
         "missed  false contacts\n";
}

std::string line_of(const ImuFailure& failure, const std::vector<ImuOutcome>& moving,
                    const std::vector<ImuOutcome>& touched) {
  std::vector<Time> times;
  int right = 0, never = 0, false_contacts = 0, stops = 0;
  for (const ImuOutcome& each : moving) {
    if (each.named) times.push_back(*each.named);
    right += each.named && each.doubt == failure.right ? 1 : 0;
    never += each.named ? 0 : 1;
    false_contacts += each.false_contacts.empty() ? 0 : 1;
    stops += each.stopped ? 1 : 0;
  }
  std::sort(times.begin(), times.end());
  const auto in_time = std::count_if(times.begin(), times.end(), [](Time time) { return time <= 20ms; });
  int contacts = 0, missed = 0, false_touched = 0;
  for (const ImuOutcome& each : touched) {
    contacts += each.contacts > 0 ? 1 : 0;
    missed += each.missed.empty() ? 0 : 1;
    false_touched += each.false_contacts.empty() ? 0 : 1;
  }
  const auto ms = [&](std::size_t i) { return times.empty() ? "-" : fmt::format("{}", times[i] / 1ms); };
  return fmt::format("{:18} {:>7} {:>9} {:>7} {:>5} {:>8} {:>6} {:>15} {:>6} | {:>8} {:>7} {:>15}\n",
                     failure.kind, moving.size(), in_time, ms(times.size() / 2),
                     ms(times.empty() ? 0 : times.size() - 1), right, never, false_contacts, stops, contacts,
                     missed, false_touched);
}

}  // namespace flinch::test
