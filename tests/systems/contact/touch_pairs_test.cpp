#include "systems/contact/touch_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "systems/foundation/setup_error.h"
#include "systems/robot/contact_jacobian.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "systems/robot/planar_leg_bases.h"
#include "tests/support/allocations.h"
#include "tests/systems/contact/touched_robot.h"

namespace flinch {
namespace {

using Eigen::Vector2d;

/// Pushes on the planar rig and what of them is felt.
class Pushed {
 public:
  explicit Pushed(unsigned seed) : random_(seed) { all_ = test::random_kinematics(*robot, 200, 0.3, seed); }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  void begin() {
    at = all_[static_cast<std::size_t>(uniform(0.0, 199.99))];
    wrench = PlatformVector::Zero(3);
    felt = BaseForceEstimate();
    felt.valid = true;
    felt.force_in_base.setZero(6);
  }

  /// Something pushes on `body` anywhere, with friction up to 0.2; returns the point.
  LocatedContact push(int body, double force) {
    const BodyId id = BodyId::from_index(body);
    const bool is_platform = id.is_platform();
    const double along = uniform(0.1, 0.9);
    const Vector2d normal_in_body =
        is_platform ? unit_vector(uniform(-3.14, 3.14)) : Vector2d(0.0, uniform(-1.0, 1.0) < 0 ? -1.0 : 1.0);
    const Vector2d axis = robot->axis_point(id, along).head<2>();
    const Vector2d in_body =
        is_platform ? Vector2d(0.137 * normal_in_body) : Vector2d(axis + 0.03 * normal_in_body);
    const Vector2d point = robot->point_on_body(at, id, in_body).head<2>();
    const Vector2d n = point - robot->point_on_body(at, id, in_body - normal_in_body).head<2>();
    const Vector2d f = force * (-n + uniform(-0.2, 0.2) * normal(n));
    wrench += platform_wrench(robot->contact_jacobian(at, id, in_body), f);
    if (!is_platform) felt.force_in_base.segment<2>(2 * id.leg()) += bases->felt(at, id, point, f);
    return {.body = body, .fraction = is_platform ? 0.0 : along, .point_in_base = point, .force_in_base = f};
  }

  void add_noise(double share = 1.0) {
    std::normal_distribution<double> normal;
    for (int i = 0; i < 3; ++i) wrench[i] += share * (i < 2 ? 1.5 : 0.12) * normal(random_);
    for (int i = 0; i < 6; ++i) felt.force_in_base[i] += share * 0.8 * normal(random_);
  }

  LocatedContacts found(const TouchPairs& pairs) const {
    LocatedContacts out;
    const WrenchUncertainty uncertainty{
        .force = 1.5, .moment = 0.12, .share_of_force = 0.02, .share_of_lever = 0.002};
    pairs.find(at, wrench, uncertainty.covariance(robot->space(), wrench), felt, out);
    return out;
  }

  std::shared_ptr<const PlanarRrr> robot = test::touched_rig();
  std::shared_ptr<const LegBases> bases =
      std::make_shared<const PlanarLegBases>(robot, std::array<double, 3>{1.095, 1.095, 1.095});
  Kinematics at;
  PlatformVector wrench;
  BaseForceEstimate felt;

 private:
  std::mt19937_64 random_;
  std::vector<Kinematics> all_;
};

double distance(const LocatedContacts& found, const LocatedContact& truth) {
  double least = 1e3;
  for (int i = 0; i < found.count; ++i) {
    const LocatedContact& contact = found.contacts[static_cast<std::size_t>(i)];
    least = std::min(least, (contact.point_in_base - truth.point_in_base).norm());
  }
  return least;
}

/// What is found of many random pushes.
struct Tally {
  int drawn = 0, two = 0, neither = 0, bodies_right = 0;
  std::vector<double> errors;  // of the worse placed one [m]

  double median_error() {
    std::sort(errors.begin(), errors.end());
    return errors[errors.size() / 2];
  }
};

bool has(const LocatedContacts& found, int body) {
  return found.contacts[0].body == body || (found.count > 1 && found.contacts[1].body == body);
}

/// `pushes` on bodies that are drawn, not the same twice, and noise of a `share` of the errors expected.
Tally tally(int pushes, double share, unsigned seed) {
  Pushed pushed(seed);
  const TouchPairs pairs(pushed.robot, pushed.bases, {});
  Tally found;
  for (int k = 0; k < 300; ++k) {
    pushed.begin();
    std::vector<LocatedContact> truth;
    while (static_cast<int>(truth.size()) < pushes) {
      const int body = static_cast<int>(pushed.uniform(0.0, 6.99));
      if (!truth.empty() && truth.front().body == body) continue;
      truth.push_back(pushed.push(body, pushed.uniform(20.0, 80.0)));
    }
    pushed.add_noise(share);
    const LocatedContacts located = pushed.found(pairs);
    ++found.drawn;
    found.two += located.count == 2;
    found.neither += located.count == 0;
    if (located.count != pushes) continue;
    bool right = true;
    double worst = 0.0;
    for (const LocatedContact& each : truth) {
      right = right && has(located, each.body);
      worst = std::max(worst, distance(located, each));
    }
    found.bodies_right += right;
    found.errors.push_back(worst);
  }
  return found;
}

TEST(TouchPairs, PlaceOnePushAndDoNotTakeItForTwo) {
  Tally one = tally(1, 1.0, 3);
  std::cout << "one push: told as two " << one.two << ", as neither " << one.neither << ", right body "
            << one.bodies_right << " of " << one.drawn << ", placed " << 1e3 * one.median_error()
            << " mm off\n";
  EXPECT_LE(one.two, 3);
  EXPECT_GT(one.bodies_right, 285);
  EXPECT_LT(one.median_error(), 0.015);
}

TEST(TouchPairs, TellTwoPushesFromOneAndPlaceBoth) {
  Tally two = tally(2, 1.0, 4);
  std::cout << "two pushes: told as two " << two.two << ", as neither " << two.neither << ", right bodies "
            << two.bodies_right << " of " << two.drawn << ", the worse placed " << 1e3 * two.median_error()
            << " mm off\n";
  EXPECT_GT(two.two, 270);
  EXPECT_GT(two.bodies_right, 255);
  EXPECT_LT(two.median_error(), 0.03);
  EXPECT_LT(tally(2, 0.1, 4).median_error(), 0.015);
}

TEST(TouchPairs, SayWhereAPushMayBe) {
  Pushed pushed(5);
  const TouchPairs pairs(pushed.robot, pushed.bases, {});
  int within = 0, placed = 0;
  for (int k = 0; k < 300; ++k) {
    pushed.begin();
    const LocatedContact truth = pushed.push(static_cast<int>(pushed.uniform(0.0, 6.99)), 40.0);
    pushed.add_noise();
    const LocatedContacts found = pushed.found(pairs);
    if (found.count != 1 || found.contacts[0].body != truth.body) continue;
    ++placed;
    within += distance(found, truth) < 1.96 * found.contacts[0].point_deviation;
  }
  std::cout << "within 1.96 deviations: " << within << " of " << placed << "\n";
  EXPECT_GT(within, 0.9 * placed);
}

TEST(TouchPairs, SayThatNothingExplainsWhatNoPushMakes) {
  Pushed pushed(6);
  const TouchPairs pairs(pushed.robot, pushed.bases, {});
  pushed.begin();
  pushed.wrench << 0.0, 0.0, 60.0;  // a moment that no push on a disc makes
  for (int i = 0; i < 6; ++i) pushed.felt.force_in_base[i] = 300.0;
  const LocatedContacts found = pushed.found(pairs);
  EXPECT_EQ(found.count, 0);
}

TEST(TouchPairs, NeverAllocateAndRefuseWhatTheyCannotUse) {
  Pushed pushed(7);
  const TouchPairs pairs(pushed.robot, pushed.bases, {});
  pushed.begin();
  pushed.push(0, 40.0);
  const test::AllocationCounter allocations;
  EXPECT_TRUE(pushed.found(pairs).valid);
  EXPECT_EQ(allocations.count(), 0);
  pushed.felt.force_in_base[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(pushed.found(pairs).valid);
  pushed.felt.valid = false;
  EXPECT_FALSE(pushed.found(pairs).valid);
  const auto spatial =
      std::make_shared<const Hexapod>(hexapod_robot(HexapodPayload::none, HexapodFriction::none));
  EXPECT_THROW(TouchPairs(spatial, pushed.bases, {}), SetupError);
  EXPECT_THROW(TouchPairs(pushed.robot, nullptr, {}), SetupError);
}

}  // namespace
}  // namespace flinch
