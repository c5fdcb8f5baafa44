// What each law of the reaction costs in a tick, with all blocks that it brings, and as a multiple of the
// impedance that follows a retreat; and what the strict level costs, the torque level's tasks with limits
// that are always kept, as a multiple of the torque level alone: in the mean of a smooth motion, and at worst
// in motions from limit to limit.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "diagrams/contact_control_settings.h"
#include "diagrams/safety_filtering.h"
#include "diagrams/shared_parts.h"
#include "systems/framework/constant.h"
#include "systems/laws/safety_filter.h"
#include "systems/robot/forward_dynamics.h"
#include "tests/support/planar_rig.h"
#include "tests/support/smooth_trajectory.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

std::shared_ptr<const PlanarRrr> bench() {
  static const auto robot = test::planar_rig(RigFriction::test_rig);
  return robot;
}

/// What the robot does, tick by tick; then it repeats.
using Path = std::vector<test::Posture>;

const test::Posture& posture(const Path& path, Time now) {
  return path[static_cast<std::size_t>(now / 1ms) % path.size()];
}

/// A second of the smooth trajectory.
const Path& smooth_path() {
  static const Path path = [] {
    Path made;
    for (int k = 0; k < 1000; ++k) {
      const test::SmoothTrajectory truth(1e-3 * k);
      made.emplace_back(*bench(), truth.pose, truth.velocity);
    }
    return made;
  }();
  return path;
}

/// What the blocks before a law say: the platform is touched at the first tick.
class LawSources final : public System {
 public:
  explicit LawSources(const Path& path) : path_(path) {}

  OutputPort<PlatformMotion> platform = output<&LawSources::read_platform>("platform", clock);
  OutputPort<Kinematics> kinematics = output<&LawSources::read_kinematics>("kinematics", clock);
  OutputPort<Dynamics> dynamics = output<&LawSources::read_dynamics>("dynamics", clock);
  OutputPort<ReactionState> reaction = output<&LawSources::read_reaction>("reaction", clock);

 private:
  PlatformMotion read_platform(Time now) const {
    PlatformMotion motion = posture(path_, now).platform;
    motion.acquired = now;
    return motion;
  }
  void read_kinematics(Time now, Kinematics& result) const { result = posture(path_, now).kinematics; }
  void read_dynamics(Time now, Dynamics& result) const { result = posture(path_, now).dynamics; }
  ReactionState read_reaction(Time /*now*/) const { return {ReactionMode::react, ReactionMode::nominal, {}}; }

  const Path& path_;
};

enum class Limits { not_kept, kept };

SafetyFilterSettings strict_limits() {
  SafetyFilterSettings settings;
  settings.use = SafetyFilterSettings::Use::always;
  settings.limits.workspace = {
      .centre = {}, .max_distance = 0.35, .min_abs_det_A = 0.02, .min_abs_det_B = 0.02};
  settings.limits.workspace.min_self_collision_distance = 0.17;
  settings.limits.max_condition_number = 15.0;
  settings.max_platform_speed = 2.1;
  return settings;
}

/// One law and what feeds it; without a name what feeds it alone.
class LawRig {
 public:
  explicit LawRig(const std::string& name, Limits limits = Limits::not_kept, const Path& path = smooth_path())
      : path_(path), ticking_(wire(name, limits)) {}

  void tick() {
    JointReading joints = posture(path_, ticking_.now()).joints;
    joints.acquired = ticking_.now();
    ticking_.set(joints_, joints);
    ticking_.set(drives_, {.acquired = ticking_.now(), .valid = true, .current = JointVector::Zero(3)});
    ticking_.tick();
  }
  /// The best of several runs [ns].
  double time_of_a_tick() {
    double best = 1e9;
    for (int run = 0; run < 20; ++run) {
      const auto begin = std::chrono::steady_clock::now();
      for (int k = 0; k < 1000; ++k) tick();
      const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - begin;
      best = std::min(best, took.count() / 1000);
    }
    return best;
  }
  /// The best of several times along the path, tick by tick [ns].
  std::vector<double> time_of_each_tick(int times) {
    std::vector<double> best(path_.size(), std::numeric_limits<double>::infinity());
    for (int time = 0; time < times; ++time) {
      for (double& least : best) {
        const auto begin = std::chrono::steady_clock::now();
        tick();
        const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - begin;
        least = std::min(least, took.count());
      }
    }
    return best;
  }
  /// At the last tick; nothing where limits are not kept.
  LimitStatus limit_status() const { return kept_ ? ticking_.get(*kept_) : LimitStatus(); }

 private:
  template <class T>
  OutputPort<T> always(const std::string& name, const T& value) {
    return builder_.add<Constant<T>>(name, value).value;
  }

  DiagramBuilder& wire(const std::string& name, Limits limits) {
    auto& sources = builder_.add<LawSources>("sources", path_);
    WrenchEstimate felt;
    felt.valid = true;
    felt.wrench_in_base = Eigen::Vector3d(20.0, -10.0, 0.5);
    felt.drive_torque = Eigen::Vector3d(3.0, 2.0, 1.0);
    ContactClassification told;
    told.valid = told.accepted = true;
    told.most_likely = 0;
    ReactionPorts given{};
    given.joints = joints_;
    given.drives = drives_;
    given.status = status_;
    given.platform = sources.platform;
    given.kinematics = sources.kinematics;
    given.dynamics = sources.dynamics;
    given.reaction = sources.reaction;
    given.wrench = given.isolation_wrench = always("wrench", felt);
    given.classification = always("classification", told);
    given.location = always("location", ContactLocation());
    given.nominal = always("nominal", PlatformReference());
    for (const ControlLaw& law : known_stages().reaction_laws.all) {
      if (law.name != name) continue;
      const LawPorts added = law.add({builder_, name, bench(), settings_, shared_}, given);
      if (limits == Limits::not_kept) continue;
      settings_.limits = strict_limits();
      const LimitedTorques kept =
          add_safety_filter({builder_, "limits", bench(), settings_, shared_}, given, added.torque);
      builder_.connect(kept.torque, *kept.commanded);
      kept_ = kept.status;
    }
    return builder_;
  }

  const Path& path_;
  DiagramBuilder builder_{"bench", 1ms};
  ContactControlSettings settings_;
  SharedParts shared_;
  std::optional<OutputPort<LimitStatus>> kept_;
  InputPort<JointReading> joints_ = builder_.input<JointReading>("joints");
  InputPort<DriveReading> drives_ = builder_.input<DriveReading>("drives");
  InputPort<StationStatus> status_ = builder_.input<StationStatus>("status");
  test::Ticking ticking_;
};

void ReactionLawTick(benchmark::State& state, const std::string& name) {
  LawRig tested(name), retraction("retraction"), sources("");
  for (auto unused : state) tested.tick();
  const double nothing = sources.time_of_a_tick();
  state.counters["times_the_retraction"] =
      (tested.time_of_a_tick() - nothing) / (retraction.time_of_a_tick() - nothing);
}

void StrictLevelTick(benchmark::State& state) {
  LawRig strict("torque_reaction", Limits::kept), soft("torque_reaction"), sources("");
  for (auto unused : state) strict.tick();
  const double nothing = sources.time_of_a_tick();
  state.counters["times_the_torque_level"] =
      (strict.time_of_a_tick() - nothing) / (soft.time_of_a_tick() - nothing);
}
BENCHMARK(StrictLevelTick);

/// A robot that is driven at random, by up to 100 Nm for 150 ms each, and kept within the strict level's
/// limits: the ticks from 100 ms on are near them mostly.
class RobotBetweenLimits {
 public:
  explicit RobotBetweenLimits(unsigned seed) : random_(seed) {
    builder_.connect(safety_filter_.torque, safety_filter_.commanded);
  }

  Path drive(int ticks) {
    test::Ticking ticking(builder_);
    PlatformVector pose = 0.08 * at_random(), velocity = at_random();
    JointVector torque = JointVector::Zero(3);
    Path path;
    for (int k = 0; k < ticks; ++k) {
      const test::Posture& here = path.emplace_back(*bench(), pose, velocity);
      if (k % 150 == 0) torque = 100.0 * at_random();
      ticking.set(motion_, here.platform);
      ticking.set(kinematics_, here.kinematics);
      ticking.set(dynamics_, here.dynamics);
      ticking.set(disturbance_, WrenchEstimate());
      ticking.set(request_, TorqueCommand{.computed = ticking.now(), .valid = true, .torque = torque});
      ticking.tick();
      velocity +=
          1e-3 * *forward_dynamics(here.kinematics, here.dynamics, ticking.get(safety_filter_.torque).torque,
                                   PlatformVector::Zero(3));
      pose += 1e-3 * velocity;
    }
    return path;
  }

 private:
  Eigen::Vector3d at_random() { return {unit_(random_), unit_(random_), unit_(random_)}; }

  std::mt19937 random_;
  std::uniform_real_distribution<double> unit_{-1.0, 1.0};
  DiagramBuilder builder_{"robot", 1ms};
  SafetyFilter& safety_filter_ = builder_.add<SafetyFilter>("limits", bench(), strict_limits());
  InputPort<PlatformMotion> motion_ = builder_.export_input("motion", safety_filter_.motion);
  InputPort<Kinematics> kinematics_ = builder_.export_input("kinematics", safety_filter_.kinematics);
  InputPort<Dynamics> dynamics_ = builder_.export_input("dynamics", safety_filter_.dynamics);
  InputPort<WrenchEstimate> disturbance_ = builder_.export_input("disturbance", safety_filter_.disturbance);
  InputPort<TorqueCommand> request_ = builder_.export_input("request", safety_filter_.request);
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void StrictLevelAtItsLimits(benchmark::State& state) {
  constexpr int paths = 20, ticks = 400, times = 100, first = 100;
  std::vector<double> strict, soft;
  std::size_t at_limits = 0;
  int most_steps = 0;
  for (auto unused : state) {
    for (unsigned seed = 0; seed < paths; ++seed) {
      const Path path = RobotBetweenLimits(seed).drive(ticks);
      LawRig kept("torque_reaction", Limits::kept, path), free("torque_reaction", Limits::not_kept, path),
          sources("", Limits::not_kept, path);
      const std::vector<double> with = kept.time_of_each_tick(times), without = free.time_of_each_tick(times),
                                nothing = sources.time_of_each_tick(times);
      for (std::size_t k = 0; k < path.size(); ++k) {
        kept.tick();
        if (k < first) continue;  // the path begins anew: the filter has to settle
        strict.push_back(with[k] - nothing[k]);
        soft.push_back(without[k] - nothing[k]);
        at_limits += kept.limit_status().binding != 0 ? 1U : 0U;
        most_steps = std::max(most_steps, static_cast<int>(kept.limit_status().steps));
      }
    }
  }
  const double torque_level = median(soft);
  state.counters["worst_times_the_torque_level"] =
      *std::max_element(strict.begin(), strict.end()) / torque_level;
  state.counters["median_times_the_torque_level"] = median(strict) / torque_level;
  state.counters["states"] = static_cast<double>(strict.size());
  state.counters["at_limits"] = static_cast<double>(at_limits);
  state.counters["most_steps"] = most_steps;
}
BENCHMARK(StrictLevelAtItsLimits)->Iterations(1)->Unit(benchmark::kSecond);

const bool registered = [] {
  for (const ControlLaw& law : known_stages().reaction_laws.all) {
    benchmark::RegisterBenchmark(("ReactionLawTick/" + law.name).c_str(), ReactionLawTick, law.name);
  }
  return true;
}();

}  // namespace
}  // namespace flinch
