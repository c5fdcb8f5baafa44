#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

/// The one block of docs/files.md that is marked as YAML.
std::string documented_scenario() {
  std::ifstream file(FLINCH_SOURCE_DIR "/docs/files.md");
  const std::string document((std::istreambuf_iterator<char>(file)), {});
  const std::string mark = "```yaml\n";
  const std::size_t begin = document.find(mark) + mark.size();
  return document.substr(begin, document.find("```\n", begin) - begin);
}

TEST(DocumentedScenario, CanBeRunAndSaysEveryKey) {
  std::string text = documented_scenario();
  const std::string folder = "../robots/";
  text.replace(text.find(folder), folder.size(), FLINCH_SOURCE_DIR "/apps/robots/");
  const test::TemporaryFolder place;
  const std::filesystem::path file = place.write("documented_scenario.yaml", text);

  const SimulatedScenario scenario = read_simulated_scenario(file);
  EXPECT_NO_THROW(build_experiment(scenario));
  EXPECT_GT(scenario.values.size(), 50U);
  for (const ReadValue& value : scenario.values) EXPECT_TRUE(value.from_file) << value.key;
}

}  // namespace
}  // namespace flinch
