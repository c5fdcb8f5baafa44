#include "experiments/graph/graph_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "systems/framework/diagram_builder.h"
#include "systems/signals/joint_reading.h"

namespace flinch {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;

class Source final : public System {
 public:
  OutputPort<JointReading> joints = output<&Source::read>("joints", clock);

 private:
  JointReading read(Time now) const {
    JointReading reading;
    reading.acquired = now;
    return reading;
  }
};

class Sink final : public System {
 public:
  InputPort<JointReading> joints = input<JointReading>("joints");
  OutputPort<bool> valid = output<&Sink::is_valid>("valid", joints);

 private:
  bool is_valid(const JointReading& reading) const { return reading.valid; }
};

std::unique_ptr<const Diagram> source_and_sinks() {
  DiagramBuilder inner("station");
  const OutputPort<JointReading> joints = inner.export_output("joints", inner.add<Source>("encoders").joints);
  DiagramBuilder outer("loop");
  outer.add(inner.build());
  for (const char* const name : {"one", "other"}) outer.connect(joints, outer.add<Sink>(name).joints);
  return outer.build();
}

/// What the page of `diagram` holds, with pictures that are their text.
json page_of(const Diagram& diagram) {
  const std::string html = graph_page(diagram, {.name = "a < b", .call = "flinch graph"},
                                      [](const std::string& dot) { return dot; });
  const std::string begin = "id=\"data\">";
  const std::size_t from = html.find(begin) + begin.size();
  return json::parse(html.substr(from, html.find("</script>", from) - from));
}

TEST(GraphPage, TellsOfEachPortWhenceItsSignalComesAndWhereItGoes) {
  const auto diagram = source_and_sinks();
  const json root = page_of(*diagram).at("root");
  const json& station = root.at("children")[0];
  EXPECT_EQ(station.at("path"), "station");
  EXPECT_EQ(station.at("outputs")[0].at("from"), "station/encoders/joints");
  EXPECT_THAT(station["outputs"][0].at("to"), ElementsAre("one/joints", "other/joints"));
  EXPECT_EQ(root["children"][1].at("inputs")[0].at("from"), "station/joints");
  EXPECT_EQ(station.at("type"), "diagram");
  EXPECT_EQ(root["children"][1].at("type"), "Sink");
}

TEST(GraphPage, TellsFieldsOfASignalWithUnits) {
  const auto diagram = source_and_sinks();
  const json fields = page_of(*diagram).at("fields").at("JointReading");
  const RowLayout layout = row_layout<JointReading>();
  ASSERT_EQ(fields.size(), layout.fields.size());
  for (std::size_t i = 0; i < layout.fields.size(); ++i) {
    EXPECT_EQ(fields[i].at("name"), layout.fields[i].name);
    EXPECT_EQ(fields[i].at("unit"), layout.fields[i].unit);
  }
}

TEST(GraphPage, HoldsAPictureOfEachDiagram) {
  const auto diagram = source_and_sinks();
  const json page = page_of(*diagram);
  EXPECT_EQ(page.at("pictures").size(), 2U);
  EXPECT_TRUE(page["pictures"].contains("station"));
  EXPECT_EQ(page.at("name"), "a < b");
}

}  // namespace
}  // namespace flinch
