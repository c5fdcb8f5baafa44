// What each law of the reaction costs in a tick, with all blocks that it brings, and as a multiple of the
// impedance that follows a retreat; and what the strict level costs, the torque level's tasks with limits
// that are always kept, as a multiple of the torque level alone.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "diagrams/contact_control_settings.h"
#include "diagrams/limit_keeping.h"
#include "systems/framework/constant.h"
#include "tests/support/planar_bench.h"
#include "tests/support/smooth_trajectory.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

std::shared_ptr<const PlanarRrr> bench() {
  static const auto robot = test::planar_bench(BenchFriction::test_bench);
  return robot;
}

/// A second of the smooth trajectory, which then repeats.
const test::Posture& posture(Time now) {
  static const std::vector<test::Posture> all = [] {
    std::vector<test::Posture> made;
    for (int k = 0; k < 1000; ++k) {
      const test::SmoothTrajectory truth(1e-3 * k);
      made.emplace_back(*bench(), truth.pose, truth.velocity);
    }
    return made;
  }();
  return all[static_cast<std::size_t>(now / 1ms) % all.size()];
}

/// What the blocks before a law say: the platform is touched at the first tick.
class LawSources final : public System {
 public:
  OutputPort<PlatformMotion> platform = output<&LawSources::read_platform>("platform", clock);
  OutputPort<Kinematics> kinematics = output<&LawSources::read_kinematics>("kinematics", clock);
  OutputPort<Dynamics> dynamics = output<&LawSources::read_dynamics>("dynamics", clock);
  OutputPort<ReactionState> reaction = output<&LawSources::read_reaction>("reaction", clock);

 private:
  PlatformMotion read_platform(Time now) const {
    PlatformMotion motion = posture(now).platform;
    motion.acquired = now;
    return motion;
  }
  void read_kinematics(Time now, Kinematics& result) const { result = posture(now).kinematics; }
  void read_dynamics(Time now, Dynamics& result) const { result = posture(now).dynamics; }
  ReactionState read_reaction(Time /*now*/) const { return {ReactionMode::react, ReactionMode::nominal, {}}; }
};

enum class Limits { not_kept, kept };

LimitKeeperSettings strict_limits() {
  LimitKeeperSettings settings;
  settings.use = LimitKeeperSettings::Use::always;
  settings.limits.workspace = {
      .centre = {}, .max_distance = 0.35, .min_abs_det_A = 0.02, .min_abs_det_B = 0.02};
  settings.limits.workspace.min_self_collision_distance = 0.17;
  settings.limits.max_condition_number = 15.0;
  settings.max_platform_speed = 2.1;
  return settings;
}

/// One law and what feeds it; without a name what feeds it alone.
class LawBench {
 public:
  explicit LawBench(const std::string& name, Limits limits = Limits::not_kept)
      : ticking_(wire(name, limits)) {}

  void tick() {
    JointReading joints = posture(ticking_.now()).joints;
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

 private:
  template <class T>
  OutputPort<T> always(const std::string& name, const T& value) {
    return builder_.add<Constant<T>>(name, value).value;
  }

  DiagramBuilder& wire(const std::string& name, Limits limits) {
    auto& sources = builder_.add<LawSources>("sources");
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
    given.wrench = always("wrench", felt);
    given.classification = always("classification", told);
    given.location = always("location", ContactLocation());
    given.nominal = always("nominal", PlatformReference());
    for (const ControlLaw& law : known_stages().reaction_laws.all) {
      if (law.name != name) continue;
      const LawPorts added = law.add({builder_, name, bench(), settings_}, given);
      if (limits == Limits::not_kept) continue;
      settings_.limits = strict_limits();
      add_limit_keeper({builder_, "limits", bench(), settings_}, given, added.torque);
    }
    return builder_;
  }

  DiagramBuilder builder_{"bench", 1ms};
  ContactControlSettings settings_;
  InputPort<JointReading> joints_ = builder_.input<JointReading>("joints");
  InputPort<DriveReading> drives_ = builder_.input<DriveReading>("drives");
  InputPort<StationStatus> status_ = builder_.input<StationStatus>("status");
  test::Ticking ticking_;
};

void ReactionLawTick(benchmark::State& state, const std::string& name) {
  LawBench tested(name), retraction("retraction"), sources("");
  for (auto unused : state) tested.tick();
  const double nothing = sources.time_of_a_tick();
  state.counters["times_the_retraction"] =
      (tested.time_of_a_tick() - nothing) / (retraction.time_of_a_tick() - nothing);
}

void StrictLevelTick(benchmark::State& state) {
  LawBench strict("torque_reaction", Limits::kept), soft("torque_reaction"), sources("");
  for (auto unused : state) strict.tick();
  const double nothing = sources.time_of_a_tick();
  state.counters["times_the_torque_level"] =
      (strict.time_of_a_tick() - nothing) / (soft.time_of_a_tick() - nothing);
}
BENCHMARK(StrictLevelTick);

const bool registered = [] {
  for (const ControlLaw& law : known_stages().reaction_laws.all) {
    benchmark::RegisterBenchmark(("ReactionLawTick/" + law.name).c_str(), ReactionLawTick, law.name);
  }
  return true;
}();

}  // namespace
}  // namespace flinch
