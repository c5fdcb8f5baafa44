// Whether torques go on without a step where the sequence switches from law to law: random contacts on all
// levels, hard ones that lead to zero gravity in the midst of a blend, and an operator who presses buttons at
// random, on robots that differ from their model. FLINCH_RUNS in the environment says how many of each body;
// 250 are all.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_run.h"
#include "tests/fault/scenario_loop.h"
#include "tests/support/in_parallel.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

constexpr double blend = 10.0;     // of laws [ticks of 1 ms]
constexpr double most = 20.0;      // by which a torque may change in a tick [Nm]
constexpr double rounding = 1e-9;  // [Nm]
constexpr int longest = 30;        // that torques may be behind a law that moves [ticks]

enum Law : std::uint8_t { gravity, following, reacting, yielding, stopping };

/// `is_told`: the drives were told a torque in the tick before.
Law law_of(ReactionMode mode, bool is_told) {
  switch (mode) {
    case ReactionMode::nominal:
    case ReactionMode::recover:
      return following;
    case ReactionMode::react:
    case ReactionMode::hold:
      return reacting;
    case ReactionMode::zero_g:
      return yielding;
    case ReactionMode::stopped:
      break;
  }
  return is_told ? stopping : gravity;
}

/// What the control path computes at a tick.
struct Tick {
  ReactionMode mode = ReactionMode::stopped;
  GatePhase gate = GatePhase::waiting;
  GateFault fault = GateFault::none;
  std::array<TorqueCommand, 5> laws;  ///< by Law; of a stop what was sent in the tick before
  TorqueCommand selected;             ///< from the laws
  TorqueCommand kept;                 ///< within the limits
  TorqueCommand sent;                 ///< from the gate
};

/// What was seen of a group of runs.
struct Steps {
  std::size_t runs = 0, switches = 0, in_a_blend = 0, at_once = 0;
  std::size_t jumps = 0;      ///< that the gate took for a fault
  double largest = 0.0;       ///< of the selector's torques from a switch until they have caught up [Nm]
  double beyond = -1e9;       ///< of what the blend permits, at most [Nm]
  double largest_kept = 0.0;  ///< from what was sent to the next torques within the limits [Nm]
  double largest_sent = 0.0;  ///< of the gate's, as long as they are valid [Nm]
  std::size_t cut = 0;        ///< ticks at which an open gate had to shorten a step
  int longest_behind = 0;     ///< that torques took to catch up [ticks]
  std::map<std::string, int> between;

  void add(const Steps& other) {
    runs += other.runs, switches += other.switches, in_a_blend += other.in_a_blend;
    at_once += other.at_once, jumps += other.jumps, cut += other.cut;
    largest = std::max(largest, other.largest), beyond = std::max(beyond, other.beyond);
    largest_kept = std::max(largest_kept, other.largest_kept);
    largest_sent = std::max(largest_sent, other.largest_sent);
    longest_behind = std::max(longest_behind, other.longest_behind);
    for (const auto& [name, count] : other.between) between[name] += count;
  }

  void print(const std::string& name) const {
    std::printf(
        "%-22s %4zu runs, %4zu switches, %3zu in a blend, %3zu at once; largest step %.2f Nm of the laws, "
        "%.1e beyond the blend's, %.2f within limits, %.2f sent; %zu cut by the gate, %zu taken for a fault; "
        "behind for at most %d ms\n ",
        name.c_str(), runs, switches, in_a_blend, at_once, largest, beyond, largest_kept, largest_sent, cut,
        jumps, longest_behind);
    for (const auto& [pair, count] : between) std::printf(" %s %d", pair.c_str(), count);
    std::printf("\n");
  }
};

/// Follows one run. The course of a blend is found anew from the torques of the laws alone.
class Watch {
 public:
  explicit Watch(bool reacts_at_once) : reacts_at_once_(reacts_at_once) {}

  void see(Tick now) {
    now.laws[stopping] = last_.sent;
    if (first_) return begin(now);
    const Law law = law_of(now.mode, last_.sent.valid);
    if (law != to_) note_switch(law);
    ++since_;
    const double w = std::min(1.0, since_ / blend);
    const JointVector& wanted = now.laws[to_].torque;
    if (!is_frozen_ && w < 1.0 && !now.laws[from_].valid) freeze();
    const JointVector old = is_frozen_ ? held_ : now.laws[from_].torque;
    const JointVector course = w < 1.0 ? JointVector((1.0 - w) * old + w * wanted) : wanted;
    const bool keeps_course = (now.selected.torque - course).lpNorm<Eigen::Infinity>() < rounding;
    const JointVector step = now.selected.torque - last_.selected.torque;
    behind_ = keeps_course ? 0 : behind_ + 1;
    steps_.longest_behind = std::max(steps_.longest_behind, behind_);
    if (to_ != stopping && (w < 1.0 || !keeps_course || !on_course_))
      steps_.largest = std::max(steps_.largest, step.lpNorm<Eigen::Infinity>());
    if (since_ <= blend && on_course_ && !at_once_ && to_ != stopping) compare(now, step, w);
    on_course_ = keeps_course;
    see_what_follows(now);
    last_ = now;
  }

  const Steps& finish() {
    steps_.runs = 1;
    return steps_;
  }

 private:
  void begin(const Tick& now) {
    first_ = false;
    to_ = from_ = law_of(now.mode, false);
    since_ = static_cast<int>(blend);
    last_ = now;
  }

  void freeze() {
    is_frozen_ = true;
    held_ = last_.selected.torque;
  }

  void note_switch(Law law) {
    static constexpr std::array names{"gravity", "nominal", "reaction", "yielding", "stop"};
    const bool in_a_blend = since_ < blend;
    from_ = to_;
    to_ = law;
    since_ = 0;
    is_frozen_ = false;
    if (in_a_blend || from_ == stopping) freeze();
    at_once_ = to_ == stopping || (reacts_at_once_ && to_ == reacting);
    if (at_once_) since_ = static_cast<int>(blend);
    ++steps_.switches;
    steps_.in_a_blend += in_a_blend ? 1U : 0U;
    steps_.at_once += at_once_ ? 1U : 0U;
    ++steps_.between[std::string(names[from_]) + "-" + names[to_]];
  }

  /// |tau - tau'| <= w |n - n'| + (1 - w) |o - o'| + |n' - o'| dt / T for each drive, with the torques n and
  /// o of the new and of the old law, and ' the tick before.
  void compare(const Tick& now, const JointVector& step, double w) {
    const JointVector n = now.laws[to_].torque, n_before = last_.laws[to_].torque;
    const JointVector o = is_frozen_ ? held_ : now.laws[from_].torque,
                      o_before = is_frozen_ ? held_ : last_.laws[from_].torque;
    const JointVector permitted = w * (n - n_before).cwiseAbs() + (1.0 - w) * (o - o_before).cwiseAbs() +
                                  (n_before - o_before).cwiseAbs() / blend;
    steps_.beyond = std::max(steps_.beyond, (step.cwiseAbs() - permitted).maxCoeff());
  }

  void see_what_follows(const Tick& now) {
    const auto step = [](const TorqueCommand& next, const TorqueCommand& before) {
      return next.valid && before.valid ? (next.torque - before.torque).lpNorm<Eigen::Infinity>() : 0.0;
    };
    if (now.gate == GatePhase::open && last_.gate != GatePhase::waiting) {
      steps_.largest_kept = std::max(steps_.largest_kept, step(now.kept, last_.sent));
      if (step(now.kept, now.sent) > rounding) ++steps_.cut;
    }
    if (now.fault == GateFault::torque_jump && last_.gate != GatePhase::closed &&
        now.gate == GatePhase::closed)
      ++steps_.jumps;
    steps_.largest_sent = std::max(steps_.largest_sent, step(now.sent, last_.sent));
  }

  bool reacts_at_once_;
  bool first_ = true, is_frozen_ = false, on_course_ = true, at_once_ = false;
  Law from_ = gravity, to_ = gravity;
  int since_ = 0, behind_ = 0;
  JointVector held_;
  Tick last_;
  Steps steps_;
};

Steps steps_of(const SimulatedScenario& scenario, std::size_t number) {
  test::ScenarioLoop loop(scenario);
  Context& context = loop.context;
  const auto torque = [&](const std::string& block) {
    return OutputPort<TorqueCommand>{loop.diagram->tap("control/" + block + "/torque").port};
  };
  const std::string reaction = followed_name(scenario.control.stages.reaction_laws);
  const std::array laws{torque("zero_gravity"), torque(followed_name(scenario.control.stages.nominal_laws)),
                        torque(reaction), torque("yielding")};
  const OutputPort<TorqueCommand> kept = torque("limits");
  Watch watch(reaction == "strict_reaction");
  std::mt19937 random(static_cast<unsigned>(number));
  bool detected = false;
  while (context.time() < scenario.duration) {
    loop.tick();
    Tick now{.mode = context.get(loop.control.reaction_state).mode,
             .gate = context.get(loop.control.gate).phase,
             .fault = context.get(loop.control.gate).fault,
             .laws = {},
             .selected = context.get(loop.control.requested_torque),
             .kept = context.get(kept),
             .sent = context.get(loop.control.torque_command)};
    for (std::size_t i = 0; i < laws.size(); ++i) now.laws[i] = context.get(laws[i]);
    if (now.gate != GatePhase::waiting) watch.see(now);
    detected = detected || now.mode == ReactionMode::react || now.mode == ReactionMode::zero_g;
    // Hardly anybody is so restless: that brings switches in all orders.
    const auto presses = [&](unsigned once_in) { return detected && random() % once_in == 0; };
    context.set(loop.buttons,
                OperatorCommand{.start = presses(150), .reset = presses(30), .stop = presses(200)});
  }
  return watch.finish();
}

TEST(TorquesInASwitch, NeverStepByMoreThanTheirRateOrTheBlendPermits) {
  CampaignOverrides overrides;
  overrides.draws = test::wanted<std::size_t>("FLINCH_RUNS", 10);
  overrides.set = {"control.sequence.zero_g_when_struck=true"};
  const Campaign campaign = read_campaign(
      std::filesystem::path(FLINCH_SOURCE_DIR) / "apps/campaigns/reaction_1000_oracle.yaml", overrides);
  std::map<std::string, Steps> groups;
  const auto steps_by_law = [&](std::size_t number) {
    const CampaignRun run = draw_run(campaign, number);
    return std::pair(followed_name(run.scenario.control.stages.reaction_laws),
                     steps_of(run.scenario, number));
  };
  for (const auto& [law, steps] : test::in_parallel(campaign.runs(), steps_by_law, 2)) groups[law].add(steps);
  EXPECT_EQ(groups.size(), 4U);
  for (const auto& [law, steps] : groups) {
    steps.print(law);
    EXPECT_GT(steps.in_a_blend, 0U) << law;
    EXPECT_LE(steps.largest, most + rounding) << law;
    EXPECT_LE(steps.beyond, rounding) << law;
    EXPECT_LE(steps.largest_kept, most + rounding) << law;
    EXPECT_LE(steps.largest_sent, most + rounding) << law;
    EXPECT_LE(steps.longest_behind, longest) << law;
    EXPECT_EQ(steps.cut, 0U) << law;
    EXPECT_EQ(steps.jumps, 0U) << law;
  }
}

}  // namespace
}  // namespace flinch
