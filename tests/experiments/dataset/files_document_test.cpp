#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "experiments/campaign/campaign_run.h"
#include "experiments/dataset/data_spec.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

/// The block of docs/files.md that is marked as YAML and begins below "## Data of contacts".
std::string documented_spec() {
  std::ifstream file(FLINCH_SOURCE_DIR "/docs/files.md");
  const std::string document((std::istreambuf_iterator<char>(file)), {});
  const std::string mark = "```yaml\n";
  const std::size_t begin = document.find(mark, document.find("## Data of contacts")) + mark.size();
  return document.substr(begin, document.find("```\n", begin) - begin);
}

TEST(DocumentedDataSpecification, IsReadWithEveryKey) {
  const test::Workplace place;
  std::filesystem::create_directories(place / "models");
  std::filesystem::create_directories(place / "data");
  std::filesystem::copy(FLINCH_SOURCE_DIR "/apps/models", place / "models",
                        std::filesystem::copy_options::recursive);
  place.write("data/run.h5", "");
  place.write("data/log.h5", "another one");
  place.write("data/documented.yaml", documented_spec());
  const DataSpec spec = read_data_spec(place / "data/documented.yaml");
  EXPECT_EQ(spec.parts.size(), 2U);
  EXPECT_EQ(spec.parts[1].configuration, "motion.pose");
  EXPECT_EQ(spec.samples.from_force, 10.0);
  EXPECT_EQ(spec.recordings[0].touched, "leg1_link2");
  EXPECT_FALSE(spec.recordings[1].scenario_text.empty());
  EXPECT_EQ(spec.recordings[1].contacts.front().at, 1.337);
}

TEST(ShippedDataSpecifications, CanBeDrawn) {
  int specifications = 0;
  for (const auto& entry : std::filesystem::directory_iterator(FLINCH_SOURCE_DIR "/apps/models")) {
    if (entry.path().extension() != ".yaml") continue;
    for (const DataPart& part : read_data_spec(entry.path()).parts) {
      for (std::size_t point = 0; point < part.campaign.grid_points(); ++point)
        EXPECT_NO_THROW(draw_run(part.campaign, point * part.campaign.draws)) << entry.path() << " " << point;
    }
    ++specifications;
  }
  EXPECT_EQ(specifications, 3);
}

}  // namespace
}  // namespace flinch
