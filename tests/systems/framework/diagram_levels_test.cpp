#include "systems/framework/diagram_levels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "systems/framework/diagram_builder.h"

namespace flinch {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Twice final : public System {
 public:
  InputPort<double> in = input<double>("in");
  OutputPort<double> out = output<&Twice::twice>("out", in);

 private:
  double twice(double value) const { return 2.0 * value; }
};

/// in -> outer(twice -> inner(twice)) -> out
std::unique_ptr<const Diagram> nested() {
  DiagramBuilder inner("inner");
  const auto& last = inner.add<Twice>("last");
  const InputPort<double> inside = inner.export_input("given", last.in);
  const OutputPort<double> got = inner.export_output("got", last.out);
  DiagramBuilder outer("outer");
  const auto& first = outer.add<Twice>("first");
  outer.export_input("in", first.in);
  outer.add(inner.build());
  outer.connect(first.out, inside);
  outer.export_output("out", got);
  return outer.build();
}

TEST(DiagramLevels, HoldEachDiagramOnceTheOutermostFirst) {
  const auto diagram = nested();
  const std::vector<DiagramLevel> levels = levels_of(*diagram);
  ASSERT_EQ(levels.size(), 2U);
  EXPECT_EQ(levels[0].path, "");
  EXPECT_EQ(levels[1].path, "inner");
}

TEST(DiagramLevels, ShowADiagramInsideAsABoxAndItsBlocksInItsOwnPicture) {
  const auto diagram = nested();
  const std::vector<DiagramLevel> levels = levels_of(*diagram);
  EXPECT_THAT(levels[0].dot, HasSubstr("<b>inner</b>"));
  EXPECT_THAT(levels[0].dot, Not(HasSubstr("<b>last</b>")));
  EXPECT_THAT(levels[1].dot, HasSubstr("<b>last</b>"));
  EXPECT_THAT(levels[1].dot, Not(HasSubstr("<b>first</b>")));
}

TEST(DiagramLevels, NameEachWireByThePathsOfItsPorts) {
  const auto diagram = nested();
  const std::vector<DiagramLevel> levels = levels_of(*diagram);
  for (const char* const wire : {"in>first/in", "first/out>inner/given", "inner/got>out"})
    EXPECT_THAT(levels[0].dot, HasSubstr("[id=\"" + std::string(wire) + "\"]"));
  for (const char* const wire : {"inner/given>inner/last/in", "inner/last/out>inner/got"})
    EXPECT_THAT(levels[1].dot, HasSubstr("[id=\"" + std::string(wire) + "\"]"));
}

TEST(PortPaths, AreThoseOfTaps) {
  const auto diagram = nested();
  const PortPaths paths(*diagram);
  for (const Diagram::Tap& tap : diagram->taps()) EXPECT_EQ(paths.of(tap.port), tap.path);
  EXPECT_EQ(paths.of(*diagram), "");
}

}  // namespace
}  // namespace flinch
