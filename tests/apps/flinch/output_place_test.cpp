#include "apps/flinch/output_place.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "systems/foundation/setup_error.h"
#include "tests/apps/flinch/program.h"
#include "tests/support/problems_of.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using test::flinch;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// A file of every kind, made by the verbs that write them, and the ending that it has.
class OutputPlace : public ::testing::Test {
 protected:
  struct Made {
    OutputKind kind;
    std::string name;
  };

  void SetUp() override {
    const std::string scenario = place.at("scenarios/platform_collision.yaml");
    flinch({"run", scenario, "--set", "duration_s=0.3", "--out", place.at("run"), "--quiet"});
    flinch({"graph", scenario, "--out", place.at("made.dot")});
    flinch({"graph", scenario, "--out", place.at("made.svg")});
    flinch({"check", place.at("robots/planar_3rrr.yaml"), "--picture", place.at("workspace.svg")});
    flinch({"excite", place.at("robots/planar_3rrr.yaml"), "--out", place.at("excite.yaml"), "--duration",
            "1", "--trials", "1", "--quiet"});
    std::filesystem::copy_file(place / "run/report.html", place / "made.html");
    std::filesystem::copy_file(place / "run/run.h5", place / "made.h5");
    std::filesystem::copy_file(FLINCH_SOURCE_DIR "/apps/models/bodies.onnx", place / "made.onnx");
    place.write("found.yaml", "# Written by flinch calibrate. A scenario takes it over with\n");
    for (const Made& made : all) ASSERT_TRUE(std::filesystem::exists(place / made.name)) << made.name;
  }

  std::string complaint(const std::string& name, OutputKind kind) const {
    const auto problems = test::problems_of([&] { require_output(place / name, {}, kind); });
    return problems.empty() ? "" : problems.front();
  }

  const std::vector<Made> all = {
      {OutputKind::page, "made.html"},       {OutputKind::picture, "made.svg"},
      {OutputKind::graph, "made.dot"},       {OutputKind::parameters, "found.yaml"},
      {OutputKind::scenario, "excite.yaml"}, {OutputKind::recording, "made.h5"},
      {OutputKind::classifier, "made.onnx"}, {OutputKind::picture, "workspace.svg"}};
  test::Workplace place;
};

TEST_F(OutputPlace, IsOfTheSameKindAsWhatIsReplaced) {
  for (const Made& made : all) EXPECT_EQ(complaint(made.name, made.kind), "") << made.name;
}

TEST_F(OutputPlace, ReplacesNoFileOfAnotherKindWhateverItsName) {
  for (const Made& made : all) {
    for (const Made& other : all) {
      if (other.kind == made.kind) continue;
      EXPECT_NE(complaint(other.name, made.kind), "") << other.name << " by what is called " << made.name;
      const std::string disguised = "disguised" + std::filesystem::path(made.name).extension().string();
      std::filesystem::copy_file(place / other.name, place / disguised,
                                 std::filesystem::copy_options::overwrite_existing);
      EXPECT_THAT(complaint(disguised, made.kind), HasSubstr("is there already and is no ")) << other.name;
    }
    const std::string ending = std::filesystem::path(made.name).extension().string();
    place.write("own" + ending, "what somebody has written");
    EXPECT_THAT(complaint("own" + ending, made.kind), HasSubstr("is there already and is no "));
  }
  EXPECT_THAT(complaint("made.h5", OutputKind::data_set), HasSubstr("is no data set"));
}

TEST_F(OutputPlace, EndsAsItsKindDoes) {
  for (const Made& made : all) {
    for (const char* const name : {"new", "new.txt", "new.html.txt", ".yaml"})
      EXPECT_THAT(complaint(name, made.kind), HasSubstr("choose such a name")) << name;
    EXPECT_EQ(complaint("new" + std::filesystem::path(made.name).extension().string(), made.kind), "");
  }
}

TEST_F(OutputPlace, MayBeEmptyALinkOrADevice) {
  place.write("empty.html", "");
  std::filesystem::create_symlink("scenarios/square.yaml", place / "link.html");
  for (const std::string name : {"empty.html", "link.html"}) EXPECT_EQ(complaint(name, OutputKind::page), "");
  EXPECT_NO_THROW(require_output("/dev/null", {}, OutputKind::page));
  EXPECT_NO_THROW(require_output("", {}, OutputKind::page));
}

// Each verb with a name that somebody gives, and a scenario in its place.
TEST_F(OutputPlace, IsAskedForByEveryVerbBeforeAnythingIsWritten) {
  const std::string scenario = "scenarios/square.yaml";
  const std::string run = place.at("run/run.h5"), out = place.at(scenario);
  place.write("log.csv", "t,q\n0,1\n0.001,1\n");
  place.write("mapping.yaml",
              "csv: log.csv\nscenario: scenarios/square.yaml\ntime: {column: t, unit: s}\n"
              "columns: [{column: q, signal: joints.active, entry: 0, unit: deg}]\n");
  const auto before = place.contents();
  for (const std::vector<std::string>& call : std::vector<std::vector<std::string>>{
           {"report", run, "--out", out},
           {"graph", place.at("scenarios/platform_collision.yaml"), "--out", out},
           {"import", place.at("mapping.yaml"), "--out", out},
           {"convert", place.at("model.urdf"), "--platform", "effector", "--out", out},
           {"excite", place.at("robots/planar_3rrr.yaml"), "--out", out},
           {"calibrate", "thresholds", run, "--out", out},
           {"calibrate", "dynamics", run, "--out", out},
           {"calibrate", "torque-constant", run, "--out", out},
           {"calibrate", "imu-pose", run, "--out", out},
           {"dataset", FLINCH_SOURCE_DIR "/apps/models/papers.yaml", "--runs", "1", "--out", out},
           {"train", run, "-o", out},
           {"evaluate", place.at("made.onnx"), run, "--out", out},
           {"run", place.at("scenarios/platform_collision.yaml"), "--out", out},
           {"campaign", FLINCH_SOURCE_DIR "/apps/campaigns/random_contacts.yaml", "--out", out},
           {"speed-limit", place.at("scenarios/platform_collision.yaml"), "--out", out},
           {"keys", out}}) {
    const test::Outcome outcome = flinch(call);
    EXPECT_EQ(outcome.status, 2) << call.front();
    EXPECT_THAT(outcome.err, HasSubstr(scenario)) << call.front();
    EXPECT_TRUE(place.contents() == before) << call.front() << " " << outcome.err;
  }
}

}  // namespace
}  // namespace flinch
