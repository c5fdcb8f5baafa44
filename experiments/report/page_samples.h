#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "experiments/report/report.h"

namespace flinch {

/// A page with more samples takes long to open.
inline constexpr std::size_t most_page_samples = 10'000;

/// How many of `samples` one of a page stands for.
std::size_t samples_in_one(std::size_t samples);

/// The columns and lanes of a page, filled sample by sample. Of several samples that a page shows as one,
/// each column has the value of the greatest weight, so that no peak is lost; what belongs together has one
/// weight.
class PageSamples {
 public:
  explicit PageSamples(std::size_t together) : together_(together) {}

  /// Makes a column, or a lane, and says by which number it is filled.
  std::size_t column(std::string name);
  std::size_t lane(std::string name, std::vector<std::string> states);
  /// Adds a state to a lane, and says its number.
  int add_state(std::size_t lane, std::string name);

  /// Begins a sample; it fills all columns and lanes.
  void begin();
  void set(std::size_t column, double value, double weight);
  /// The same of a scalar whose greatest magnitude counts.
  void set(std::size_t column, double value);
  void set_state(std::size_t lane, int state, double weight);

  /// Moves all of it to the page.
  void finish(Report& report);

 private:
  /// One value a page sample, and the weight of the last.
  template <class Value>
  struct Filled {
    std::vector<Value> values;
    double weight = 0.0;
  };
  template <class Value>
  void fill(Filled<Value>& filled, Value value, double weight) const;

  std::size_t together_;
  std::size_t samples_ = 0;
  std::vector<std::string> names_;
  std::vector<Filled<double>> columns_;
  std::vector<ReportLane> lanes_;
  std::vector<Filled<int>> states_;
};

}  // namespace flinch
