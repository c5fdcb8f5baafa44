#include "systems/framework/dot_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "systems/framework/diagram_builder.h"

namespace flinch {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Doubled final : public System {
 public:
  InputPort<double> in = input<double>("in");

 private:
  Intermediate<double> half_way_ = intermediate<&Doubled::doubled>("half_way", in);

 public:
  OutputPort<double> out = output<&Doubled::same>("out", half_way_);

 private:
  double doubled(double value) const { return 2.0 * value; }
  double same(double value) const { return value; }
};

TEST(DotTable, HasACellForEachPortAndNoneForIntermediateResults) {
  DiagramBuilder builder("outer");
  const std::string table = dot_table(builder.add<Doubled>("block"));
  EXPECT_THAT(table, HasSubstr("<b>block</b>"));
  EXPECT_THAT(table, HasSubstr("<td port=\"i0\" align=\"left\">in</td>"));
  EXPECT_THAT(table, HasSubstr("<td port=\"o1\" align=\"right\">out</td>"));
  EXPECT_THAT(table, Not(HasSubstr("half_way")));
}

TEST(WiresToOutputs, EndWithThoseFromInsideToTheDiagramsOwnOutputs) {
  DiagramBuilder builder("outer");
  const auto& first = builder.add<Doubled>("first");
  const auto& last = builder.add<Doubled>("last");
  builder.export_input("in", first.in);
  builder.connect(first.out, last.in);
  builder.export_output("out", last.out);
  const auto diagram = builder.build();
  const std::vector<Diagram::Wire> wires = wires_to_outputs(*diagram);
  ASSERT_EQ(wires.size(), diagram->wires().size() + 1);
  EXPECT_EQ(wires.back().from, last.out.id);
  EXPECT_EQ(wires.back().to, (PortId{diagram.get(), PortId::Kind::output, 0}));
}

}  // namespace
}  // namespace flinch
