#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace flinch {

/// Collects what is wrong with settings, one sentence each: "post.radius is -1 m; it must be positive".
class Findings {
 public:
  /// `owner` stands before every field and every sentence, as in "post.".
  explicit Findings(std::string owner = "") : owner_(std::move(owner)) {}

  // Each adds a sentence where `value` is not so. What is not finite is nothing of the kind.
  void positive(const std::string& field, double value, const char* unit = "");
  void not_negative(const std::string& field, double value, const char* unit = "");
  void at_most(double limit, const std::string& field, double value, const char* unit = "");
  void finite(const std::string& field, double value, const char* unit = "");
  /// Every entry of a vector, as field[0], field[1], ...
  template <class Vector>
  requires requires(const Vector& values) { values.data(); }
  void finite(const std::string& field, const Vector& values, const char* unit = "");

  /// "field is value unit; it expectation"
  void add(const std::string& field, double value, const char* unit, const std::string& expectation);
  void add(const std::string& sentence) { sentences_.push_back(owner_ + sentence); }
  /// What was found of a part, in sentences that say themselves what they belong to.
  void add_all(std::vector<std::string> of_part);
  /// Adds the sentence that says so unless `good`.
  void require(bool good, const std::string& sentence) {
    if (!good) add(sentence);
  }

  bool none() const { return sentences_.empty(); }
  std::vector<std::string> take() { return std::move(sentences_); }

 private:
  std::string owner_;
  std::vector<std::string> sentences_;
};

template <class Vector>
requires requires(const Vector& values) { values.data(); }
void Findings::finite(const std::string& field, const Vector& values, const char* unit) {
  std::size_t i = 0;
  for (const double value : values) finite(field + "[" + std::to_string(i++) + "]", value, unit);
}

}  // namespace flinch
