// What each law of the reaction costs in a tick, with all blocks that it brings, and as a multiple of the
// impedance that follows a retreat.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "diagrams/contact_control_settings.h"
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
class Sources final : public System {
 public:
  OutputPort<PlatformMotion> platform = output<&Sources::read_platform>("platform", clock);
  OutputPort<Kinematics> kinematics = output<&Sources::read_kinematics>("kinematics", clock);
  OutputPort<Dynamics> dynamics = output<&Sources::read_dynamics>("dynamics", clock);
  OutputPort<ReactionState> reaction = output<&Sources::read_reaction>("reaction", clock);

 private:
  PlatformMotion read_platform(Time now) const { return posture(now).platform; }
  void read_kinematics(Time now, Kinematics& result) const { result = posture(now).kinematics; }
  void read_dynamics(Time now, Dynamics& result) const { result = posture(now).dynamics; }
  ReactionState read_reaction(Time /*now*/) const { return {ReactionMode::react, ReactionMode::nominal, {}}; }
};

/// One law and what feeds it; without a name what feeds it alone.
class LawBench {
 public:
  explicit LawBench(const std::string& name) : ticking_(wire(name)) {}

  void tick() { ticking_.tick(); }
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

  DiagramBuilder& wire(const std::string& name) {
    auto& sources = builder_.add<Sources>("sources");
    WrenchEstimate felt;
    felt.valid = true;
    felt.wrench_in_base = Eigen::Vector3d(20.0, -10.0, 0.5);
    felt.drive_torque = Eigen::Vector3d(3.0, 2.0, 1.0);
    ContactClassification told;
    told.valid = told.accepted = true;
    told.most_likely = 0;
    ReactionPorts given{};
    given.platform = sources.platform;
    given.kinematics = sources.kinematics;
    given.dynamics = sources.dynamics;
    given.reaction = sources.reaction;
    given.wrench = always("wrench", felt);
    given.classification = always("classification", told);
    given.location = always("location", ContactLocation());
    given.nominal = always("nominal", PlatformReference());
    for (const ControlLaw& law : known_stages().reaction_laws.all) {
      if (law.name == name) law.add({builder_, name, bench(), settings_}, given);
    }
    return builder_;
  }

  DiagramBuilder builder_{"bench", 1ms};
  ContactControlSettings settings_;
  test::Ticking ticking_;
};

void ReactionLawTick(benchmark::State& state, const std::string& name) {
  LawBench tested(name), retraction("retraction"), sources("");
  for (auto unused : state) tested.tick();
  const double nothing = sources.time_of_a_tick();
  state.counters["times_the_retraction"] =
      (tested.time_of_a_tick() - nothing) / (retraction.time_of_a_tick() - nothing);
}

const bool registered = [] {
  for (const ControlLaw& law : known_stages().reaction_laws.all) {
    benchmark::RegisterBenchmark(("ReactionLawTick/" + law.name).c_str(), ReactionLawTick, law.name);
  }
  return true;
}();

}  // namespace
}  // namespace flinch
