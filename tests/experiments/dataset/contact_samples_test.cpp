#include "experiments/dataset/contact_samples.h"

#include <gtest/gtest.h>

#include <functional>

#include "experiments/dataset/data_spec.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "plant/contact_truth.h"
#include "systems/framework/recorded_values.h"
#include "systems/framework/recording.h"
#include "systems/signals/contact_detection.h"
#include "systems/signals/wrench_estimate.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

/// A platform that runs into a pylon, recorded; what is recorded can be changed tick by tick.
class Collision {
 public:
  Collision()
      : scenario_(read_simulated_scenario(test::shipped("scenarios/platform_collision.yaml"))),
        recording_(run_for_signals(scenario_, sampled_signals(choice))) {}

  template <class T>
  Collision& change(const std::string& path, const std::function<void(T&)>& change) {
    for (Signal& signal : recording_.signals) {
      if (signal.path != path) continue;
      for (std::size_t k = 0; k < recording_.samples(); ++k) {
        T value = RecordedValues<T>(recording_, path)[k];
        change(value);
        write_row(value, signal.rows.data() + k * signal.layout.numbers);
      }
    }
    return *this;
  }
  ContactSamples samples() const { return contact_samples(recording_, *scenario_.robot.robot, choice); }

  SampleChoice choice;

 private:
  SimulatedScenario scenario_;
  Recording recording_;
};

TEST(ContactSamples, AreThereForAContactThatIsNoticed) {
  const ContactSamples made = Collision().samples();
  EXPECT_FALSE(made.samples.empty());
  EXPECT_EQ(made.left_out, "");
}

TEST(ContactSamples, SayThatNothingTouchedOrThatItWasNotNoticed) {
  Collision deaf;
  deaf.change<ContactDetection>("detection", [](auto& now) { now.level = ContactLevel::none; });
  EXPECT_EQ(deaf.samples().left_out, "not detected");
  deaf.change<ContactTruth>("contact", [](auto& now) { now = ContactTruth(); });
  EXPECT_EQ(deaf.samples().left_out, "nothing touched");
}

TEST(ContactSamples, SayWhatIsMissingOfAContactThatWasNoticed) {
  Collision with_two;
  with_two.change<ContactTruth>("contact", [](auto& now) { now.second.body = BodyId::link2(0).index(); });
  EXPECT_TRUE(with_two.samples().samples.empty());
  EXPECT_EQ(with_two.samples().left_out, "detected, but at no tick did one thing touch");

  Collision soft;
  soft.choice.from_force = 1e6;
  EXPECT_TRUE(soft.samples().samples.empty());
  EXPECT_EQ(soft.samples().left_out, "detected, but at no tick that 'samples' asks for");

  Collision blind;
  blind.change<WrenchEstimate>("isolation_wrench", [](auto& now) { now.valid = false; });
  EXPECT_EQ(blind.samples().left_out, "detected, but wrench or motion were not known");
}

}  // namespace
}  // namespace flinch
