#include "systems/contact/touch_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flinch {
namespace {

double shares_of(const OutlinePlaces& found) {
  double sum = 0.0;
  for (const TouchPlace& place : found.places) sum += place.share;
  return sum;
}

double area_of(const OutlinePlaces& found) {
  return found.area_each * static_cast<double>(found.places.size());
}

TEST(PlacesByArea, CoverAWholeSphere) {
  const OutlinePlaces found = places_by_area({Sphere{{0.1, 0.0, 0.0}, 0.2}}, 200);
  ASSERT_EQ(found.places.size(), 200U);
  EXPECT_NEAR(area_of(found), 4.0 * std::numbers::pi * 0.04, 1e-9);
  EXPECT_NEAR(shares_of(found), 200.0, 1e-9);
  for (const TouchPlace& place : found.places) {
    const Eigen::Vector3d out = place.point - Eigen::Vector3d(0.1, 0.0, 0.0);
    EXPECT_NEAR(out.norm(), 0.2, 1e-12);
    EXPECT_LT((place.normal - out.normalized()).norm(), 1e-9);
  }
}

// 8 (a b + a c + b c) of half-lengths.
TEST(PlacesByArea, GiveEachFaceOfAFlatBoxItsShare) {
  const Eigen::Vector3d half(0.3, 0.2, 0.03);
  const OutlinePlaces found = places_by_area({Box{{0.0, 0.0, 0.0}, Eigen::Matrix3d::Identity(), half}}, 300);
  EXPECT_NEAR(area_of(found), 0.60, 0.03);
  double above = 0.0, rim = 0.0;
  for (const TouchPlace& place : found.places) {
    if (place.normal.z() > 0.9) above += place.share * found.area_each;
    if (std::abs(place.normal.z()) < 0.1) rim += place.share * found.area_each;
  }
  EXPECT_NEAR(above, 0.24, 0.02);
  EXPECT_NEAR(rim, 0.12, 0.01);
}

TEST(PlacesByArea, AreNowhereFarFromAnyPlace) {
  const Eigen::Vector3d half(0.3, 0.2, 0.03);
  const OutlinePlaces found = places_by_area({Box{{0.0, 0.0, 0.0}, Eigen::Matrix3d::Identity(), half}}, 300);
  for (double x = -0.29; x < 0.3; x += 0.02) {
    const Eigen::Vector3d at(x, half.y(), 0.02);
    double nearest = 1.0;
    for (const TouchPlace& place : found.places) {
      if (place.normal.y() > 0.9) nearest = std::min(nearest, (place.point - at).norm());
    }
    EXPECT_LT(nearest, 0.06) << x;
  }
}

TEST(PlacesByArea, LeaveOutWhatLiesInAnotherShape) {
  const OutlinePlaces found =
      places_by_area({Sphere{{0.0, 0.0, 0.0}, 0.1}, Capsule{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.3}, 0.05}}, 200);
  for (const TouchPlace& place : found.places) EXPECT_GT(place.point.norm(), 0.1 - 1e-9);
  EXPECT_TRUE(std::any_of(found.places.begin(), found.places.end(),
                          [](const TouchPlace& place) { return place.point.z() > 0.34; }));
}

TEST(PlacesByArea, AreNoneWithoutShapes) { EXPECT_TRUE(places_by_area({}, 100).places.empty()); }

TEST(PlacesAlong, StandEvenlyOnOneSideOfACapsule) {
  const auto places = places_along({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.1}, Eigen::Vector3d::UnitZ(), 4);
  ASSERT_EQ(places.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(places[i].fraction, 0.125 + 0.25 * static_cast<double>(i), 1e-15);
    EXPECT_LT((places[i].point - Eigen::Vector3d(places[i].fraction, 0.0, 0.1)).norm(), 1e-15);
    EXPECT_EQ(places[i].share, 1.0);
  }
}

TEST(PlacesAround, AreWhereRaysLeaveTheShape) {
  const auto places = places_around(Sphere{{0.0, 0.0, 0.0}, 0.3}, 2, 8);
  ASSERT_EQ(places.size(), 8U);
  for (const TouchPlace& place : places) EXPECT_NEAR(place.point.norm(), 0.3, 1e-12);
}

}  // namespace
}  // namespace flinch
