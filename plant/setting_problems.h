#pragma once

#include <string>
#include <utility>
#include <vector>

namespace flinch {

/// Collects what is wrong with settings, as sentences like "pylon.radius is -1; it must be positive".
class SettingProblems {
 public:
  /// `owner` stands before each name, as in "pylon.".
  explicit SettingProblems(std::string owner) : owner_(std::move(owner)) {}

  // What is not a number breaks every rule.
  void require_positive(const char* name, double value) {
    if (!(value > 0.0)) add(name, value, "must be positive");
  }
  void require_not_negative(const char* name, double value) {
    if (!(value >= 0.0)) add(name, value, "must not be negative");
  }
  void require_at_most(double limit, const char* name, double value) {
    if (!(value <= limit)) add(name, value, "must be at most " + std::to_string(limit));
  }

  const std::vector<std::string>& found() const { return found_; }

  /// Appends all that was found to `problems`.
  void append_to(std::vector<std::string>& problems) const {
    problems.insert(problems.end(), found_.begin(), found_.end());
  }

 private:
  void add(const char* name, double value, const std::string& rule) {
    found_.push_back(owner_ + name + " is " + std::to_string(value) + "; it " + rule);
  }

  std::string owner_;
  std::vector<std::string> found_;
};

}  // namespace flinch
