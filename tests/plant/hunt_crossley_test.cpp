#include "plant/hunt_crossley.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>

#include "plant/sundials_integrator.h"

namespace flinch {
namespace {

/// A mass that strikes a fixed surface: y = (depth, its rate).
class Impact final : public DifferentialEquation {
 public:
  Impact(const HuntCrossley& law, double mass) : law_(law), mass_(mass) {}
  void rates(double, std::span<const double> y, std::span<double> rates) override {
    rates[0] = y[1];
    rates[1] = -law_.normal_force(y[0], y[1]) / mass_;
  }

 private:
  HuntCrossley law_;
  double mass_;
};

// Speed after an impact over speed before, by integration until the mass has left.
double measured_restitution(const HuntCrossley& law, double mass, double speed) {
  Impact impact(law, mass);
  SundialsIntegrator integrator({.relative_tolerance = 1e-12, .absolute_tolerance = 1e-14});
  integrator.prepare(2);
  std::array<double, 2> y = {0.0, speed};
  for (int i = 0; i < 2000 && (y[0] > 0.0 || y[1] > 0.0); ++i) integrator.advance(impact, 1e-3, y);
  return -y[1] / speed;
}

TEST(HuntCrossley, BouncesWithTheRestitutionOfItsMaterialWhateverMassAndStiffness) {
  for (const double restitution : {0.1, 0.3, 0.5, 0.8, 0.95, 1.0}) {
    for (const double stiffness : {3e3, 6e3, 5e4}) {
      for (const double mass : {0.5, 4.0}) {
        const ContactMaterial material{.stiffness = stiffness, .restitution = restitution};
        const double measured =
            measured_restitution(HuntCrossley(material), mass, material.restitution_speed);
        EXPECT_NEAR(measured, restitution, 1e-8) << stiffness << " N/m, " << mass << " kg";
      }
    }
  }
}

TEST(HuntCrossley, PredictsTheRestitutionAtOtherSpeeds) {
  const HuntCrossley law(ContactMaterial{});
  double slower = 1.0;
  for (const double speed : {0.01, 0.1, 0.3, 1.0, 1.5}) {
    const double predicted = law.restitution_at(speed);
    EXPECT_NEAR(measured_restitution(law, 2.0, speed), predicted, 1e-8) << speed << " m/s";
    EXPECT_LT(predicted, slower);
    slower = predicted;
  }
}

TEST(HuntCrossley, BeginsWithoutAStepAndNeverPulls) {
  const HuntCrossley law(ContactMaterial{});
  EXPECT_EQ(law.normal_force(0.0, 1.0), 0.0);
  EXPECT_EQ(law.normal_force(-1e-3, 1.0), 0.0);
  EXPECT_NEAR(law.normal_force(1e-9, 1.0), 0.0, 1e-4);
  EXPECT_EQ(law.normal_force(1e-3, -10.0), 0.0);
  EXPECT_DOUBLE_EQ(law.normal_force(2e-3, 0.0), 12.0);
}

TEST(HuntCrossley, WithoutDissipationIsASpring) {
  const HuntCrossley law({.stiffness = 1000.0, .restitution = 1.0});
  EXPECT_EQ(law.dissipation(), 0.0);
  EXPECT_EQ(law.restitution_at(3.0), 1.0);
  EXPECT_DOUBLE_EQ(law.normal_force(0.01, -3.0), 10.0);
}

TEST(HuntCrossley, FrictionOpposesSlidingAndApproachesCoulombsLaw) {
  const HuntCrossley law({.friction = 0.3, .friction_velocity = 0.02});
  const Eigen::Vector3d along(0.6, 0.0, -0.8);
  const auto force = [&](double speed) { return law.friction_force(100.0, speed * along).dot(along); };
  EXPECT_EQ(force(0.0), 0.0);
  EXPECT_NEAR(force(0.2), -30.0, 1e-6);
  EXPECT_NEAR(force(-0.2), 30.0, 1e-6);
  EXPECT_NEAR(force(0.02), -30.0 * std::tanh(1.0), 1e-12);
  EXPECT_NEAR(law.friction_force(100.0, along).cross(along).norm(), 0.0, 1e-12) << "against the motion";
  EXPECT_EQ(HuntCrossley(ContactMaterial{}).friction_force(100.0, along), Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace flinch
