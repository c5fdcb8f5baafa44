#include "systems/framework/never_allocates.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "systems/framework/random.h"
#include "systems/framework/time.h"

namespace flinch {
namespace parts {

using Bounded = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

enum class Mood { calm, alarmed };

struct Inner {
  bool valid = false;
  Time when{};
  Mood mood = Mood::calm;
  Bounded bounded;
};

struct Outer : Inner {
  std::array<Inner, 3> several;
  Eigen::Vector3d fixed{1.0, 2.0, 3.0};
  std::uint32_t number = 0;
  double plain[2] = {0.0, 0.0};
};

template <class Hidden>
struct With {
  Inner inner;
  Hidden hidden;
  double last = 0.0;
};

template <class Hidden>
struct EndsWith {
  double number = 0.0;
  Hidden hidden;
};

/// Shows too many members to look behind them.
struct Long {
  double numbers[48]{};
  std::string text;
};

class Closed {
 public:
  Bounded seen() const { return bounded_; }

 private:
  Bounded bounded_;
};

class Declared : public Closed {};

}  // namespace parts

template <>
inline constexpr bool never_allocates<parts::Declared> = true;

namespace {

using namespace parts;

template <class T>
constexpr bool allowed() {
  // What a type may be, an array, a part and the part of a part may be as well, and the other way round.
  static_assert(never_allocates<T> == never_allocates<std::array<T, 2>>);
  static_assert(never_allocates<T> == never_allocates<With<T>>);
  static_assert(never_allocates<T> == never_allocates<With<With<std::array<T, 2>>>>);
  static_assert(never_allocates<T> == never_allocates<EndsWith<EndsWith<T>>>);
  static_assert(never_allocates<T> == never_allocates<With<EndsWith<EndsWith<T>>>>);
  return never_allocates<T>;
}

TEST(NeverAllocates, IsSeenOfNumbersBoundedMatricesAndStructsOfThem) {
  EXPECT_TRUE(allowed<double>());
  EXPECT_TRUE(allowed<Time>());
  EXPECT_TRUE(allowed<RandomGenerator>());
  EXPECT_TRUE(allowed<Eigen::Matrix3d>());
  EXPECT_TRUE(allowed<Bounded>());
  EXPECT_TRUE(allowed<Inner>());
  EXPECT_TRUE(allowed<Outer>());
}

TEST(NeverAllocates, IsNotSaidOfWhatMayAllocate) {
  EXPECT_FALSE(allowed<std::string>());
  EXPECT_FALSE(allowed<std::vector<double>>());
  EXPECT_FALSE((allowed<std::map<int, int>>()));
  EXPECT_FALSE(allowed<std::function<void()>>());
  EXPECT_FALSE(allowed<std::shared_ptr<int>>());
  EXPECT_FALSE(allowed<std::optional<std::vector<double>>>());
  EXPECT_FALSE(allowed<std::optional<std::string>>());
  EXPECT_FALSE(allowed<Eigen::VectorXd>());
  EXPECT_FALSE(allowed<Eigen::MatrixXd>());
}

TEST(NeverAllocates, IsNotSaidOfAStructThatIsTooLongToBeSeen) { EXPECT_FALSE(allowed<Long>()); }

TEST(NeverAllocates, IsSaidOfAClosedClassByItsAuthorOnly) {
  EXPECT_FALSE(allowed<Closed>());
  EXPECT_TRUE(allowed<Declared>());
}

}  // namespace
}  // namespace flinch
