#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace flinch::test {

/// Largest residual of an identity over many samples. When it goes out of scope it prints the residual,
/// records it as a property of the test, and fails the test if it exceeds the tolerance or was never added
/// to.
class Residual {
 public:
  Residual(std::string name, double tolerance) : name_(std::move(name)), tolerance_(tolerance) {}
  Residual(const Residual&) = delete;
  Residual& operator=(const Residual&) = delete;

  ~Residual() {
    std::printf("  residual %-52s %.1e (tolerance %.0e, %d samples)\n", name_.c_str(), largest_, tolerance_,
                count_);
    ::testing::Test::RecordProperty("residual " + name_, std::to_string(largest_));
    EXPECT_LE(largest_, tolerance_) << name_;
    EXPECT_GT(count_, 0) << name_;
  }

  void add(double residual) {
    // Not a number counts as infinite.
    largest_ = std::max(largest_, std::isnan(residual) ? HUGE_VAL : std::abs(residual));
    ++count_;
  }

  template <class A, class B>
  void add(const A& a, const B& b) {
    ASSERT_EQ(a.rows(), b.rows());
    ASSERT_EQ(a.cols(), b.cols());
    for (int i = 0; i < a.rows(); ++i) {
      for (int j = 0; j < a.cols(); ++j) add(a(i, j) - b(i, j));
    }
  }

 private:
  std::string name_;
  double tolerance_;
  double largest_ = 0.0;
  int count_ = 0;
};

}  // namespace flinch::test
