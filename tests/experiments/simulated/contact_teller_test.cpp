#include "experiments/simulated/contact_teller.h"

#include <gtest/gtest.h>

#include "systems/framework/diagram_builder.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

struct Teller {
  explicit Teller(const std::string& made_for = "truth")
      : block(builder.add<ContactTeller>("teller", robot, made_for)) {}

  void touch(int body, double fraction = 0.5, bool clamping = false,
             const Eigen::Vector2d& force = Eigen::Vector2d(3, 4)) {
    const test::Posture posture(*robot);
    ContactTruth truth;
    truth.clear(3, 2);
    truth.valid = truth.in_contact = true;
    truth.clamping = clamping;
    const BodyId id = BodyId::from_index(body);
    const CartesianVector point =
        robot->point_on_body(posture.kinematics, id, robot->axis_point(id, fraction));
    truth.strongest = {.body = body, .point_in_base = point, .force_in_base = force};
    ticking.set(contact, truth);
    ticking.set(platform, posture.platform);
    ticking.tick();
  }
  const ContactClassification& told() const { return ticking.get(block.classification); }
  const ContactLocation& place() const { return ticking.get(block.location); }

  std::shared_ptr<const PlanarRrr> robot = test::planar_rig();
  DiagramBuilder builder{"test", 1ms};
  ContactTeller& block;
  InputPort<ContactTruth> contact = builder.export_input("contact", block.contact);
  InputPort<PlatformMotion> platform = builder.export_input("platform", block.platform);
  test::Ticking ticking{builder};
};

TEST(ContactTeller, TellsWhichBodyIsTouchedAndWhere) {
  Teller teller;
  for (int body = 0; body < 7; ++body) {
    teller.touch(body, 0.3);
    EXPECT_TRUE(teller.told().accepted);
    EXPECT_EQ(teller.told().most_likely, body);
    EXPECT_EQ(teller.told().confidence(), 1.0);
    EXPECT_EQ(teller.place().body, body);
    EXPECT_EQ(teller.place().force_in_base, Eigen::Vector2d(3, 4));
    if (body > 0) {
      EXPECT_NEAR(teller.place().fraction, 0.3, 1e-12);
    }
  }
}

TEST(ContactTeller, TwoLinksOfALegOnOneObjectAreAClamping) {
  Teller teller;
  teller.touch(BodyId::link2(1).index(), 0.5, true);
  EXPECT_EQ(teller.told().most_likely, ContactClasses(7, 3).clamping(1));
}

TEST(ContactTeller, AnExperimentMadeForAClampingBeginsOneWithItsFirstLink) {
  Teller teller("leg2_clamping");
  const int clamping = ContactClasses(7, 3).clamping(1);
  const LegPoints leg = test::Posture(*teller.robot).kinematics.legs[1];
  const Eigen::Vector2d apart = leg.coupling_joint - leg.base_joint;  // pushes the second link from the first
  const int first = BodyId::link1(1).index(), second = BodyId::link2(1).index();
  teller.touch(second, 0.5, false, apart);
  EXPECT_EQ(teller.told().most_likely, clamping);
  teller.touch(first, 0.5, false, -apart);
  EXPECT_EQ(teller.told().most_likely, clamping);
  teller.touch(BodyId::link2(0).index(), 0.5, false, apart);
  EXPECT_EQ(teller.told().most_likely, BodyId::link2(0).index());
  teller.touch(second, 0.5, false, -apart);
  EXPECT_EQ(teller.told().most_likely, second) << "from outside";
  teller.touch(first, 0.5, false, apart);
  EXPECT_EQ(teller.told().most_likely, first) << "from outside";
}

TEST(ContactTeller, WithoutAContactNothingIsTold) {
  Teller teller;
  teller.ticking.set(teller.contact, ContactTruth());
  teller.ticking.tick();
  EXPECT_FALSE(teller.told().valid);
  EXPECT_FALSE(teller.place().valid);
}

}  // namespace
}  // namespace flinch
