#include "learning/network_stages.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <string>

#include "diagrams/contact_control.h"
#include "diagrams/contact_control_settings.h"
#include "experiments/scenario/scenario.h"
#include "learning/onnx_file.h"
#include "systems/config/robot_file.h"
#include "systems/framework/diagram_builder.h"
#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

const std::filesystem::path shipped = FLINCH_SOURCE_DIR "/apps/models";

/// Builds the control path of a shipped robot with the classifier of this name.
void build(const std::string& name, const IsolationSettings& isolation = {},
           const std::string& robot = "planar_3rrr", const std::filesystem::path& networks = shipped) {
  DiagramBuilder builder("control");
  ContactControlSettings settings;
  settings.isolation = isolation;
  for (ContactClassifier& stage : network_stages(networks)) {
    if (stage.name == name) settings.stages.classifiers.follow(std::move(stage));
  }
  EXPECT_EQ(settings.stages.classifiers.followed, name);
  add_contact_control(
      builder,
      read_robot_file(std::filesystem::path(FLINCH_SOURCE_DIR "/apps/robots") / (robot + ".yaml")).robot,
      settings);
}

TEST(NetworkStages, AskTheNetworksThatComeWithFlinchWhereNoneIsNamed) {
  build("papers_networks");
  build("learned_classifier");
}

TEST(NetworkStages, RunOnlyWhereAScenarioNamesThem) {
  for (const ContactClassifier& stage : network_stages(shipped)) EXPECT_TRUE(stage.only_when_named);
}

TEST(NetworkStages, RefuseANetworkOfAnotherQuestion) {
  IsolationSettings isolation;
  isolation.papers_networks.chain = shipped / "papers_body.onnx";
  EXPECT_THAT(test::problems_of([&] { build("papers_networks", isolation); }),
              ElementsAre(AllOf(HasSubstr("papers_body.onnx"), HasSubstr("answers the question 'body'"),
                                HasSubstr("that of 'chain' is asked for"))));
}

TEST(NetworkStages, RefuseANetworkThatIsNotThere) {
  EXPECT_THAT(test::problems_of([] { build("papers_networks", {}, "planar_3rrr", "nowhere"); }),
              ElementsAre(HasSubstr("nowhere/papers_clamping.onnx")));
}

TEST(NetworkStages, RefuseARobotOfOtherLegs) {
  const auto problems = test::problems_of([] { build("papers_networks", {}, "five_bar"); });
  ASSERT_FALSE(problems.empty());
  EXPECT_THAT(problems.front(),
              HasSubstr("trained for the robot 'planar 3-RRR bench', and this one is 'five-bar'"));
}

TEST(NetworkStages, RefuseARobotOfOtherGeometry) {
  const test::TemporaryFolder folder;
  for (const char* const name : {"papers_clamping.onnx", "papers_chain.onnx", "papers_body.onnx"}) {
    ClassifierModel model = read_onnx(shipped / name);
    model.provenance["features.check"] = "1.5";
    write_onnx(model, folder.path() / name);
  }
  EXPECT_THAT(test::problems_of([&] { build("papers_networks", {}, "planar_3rrr", folder.path()); }),
              ElementsAre(HasSubstr("has another geometry")));
}

}  // namespace
}  // namespace flinch
