#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace flinch {

/// Bounds on the magnitudes of the components of a force or a moment in the base frame: one for all of them,
/// or one for each.
class ComponentBounds {
 public:
  ComponentBounds(double all) : values_{all} {}  // NOLINT(google-explicit-constructor)
  /// `each`: one or more.
  explicit ComponentBounds(std::vector<double> each) : values_(std::move(each)) {}

  double operator[](int component) const {
    return values_.size() == 1 ? values_.front() : values_.at(static_cast<std::size_t>(component));
  }
  /// Whether they are bounds on a vector of so many components.
  bool fit(int components) const {
    return values_.size() == 1 || values_.size() == static_cast<std::size_t>(components);
  }
  /// As they were given.
  const std::vector<double>& values() const { return values_; }
  double least() const { return *std::min_element(values_.begin(), values_.end()); }
  double largest() const { return *std::max_element(values_.begin(), values_.end()); }

  bool operator==(const ComponentBounds&) const = default;

 private:
  std::vector<double> values_;
};

}  // namespace flinch
