#include "experiments/report/page_samples.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flinch {

std::size_t samples_in_one(std::size_t samples) {
  return std::max<std::size_t>(1, (samples + most_page_samples - 1) / most_page_samples);
}

std::size_t PageSamples::column(std::string name) {
  names_.push_back(std::move(name));
  columns_.emplace_back();
  return columns_.size() - 1;
}

std::size_t PageSamples::lane(std::string name, std::vector<std::string> states) {
  lanes_.push_back({std::move(name), std::move(states), {}});
  states_.emplace_back();
  return states_.size() - 1;
}

int PageSamples::add_state(std::size_t lane, std::string name) {
  lanes_[lane].states.push_back(std::move(name));
  return static_cast<int>(lanes_[lane].states.size()) - 1;
}

void PageSamples::begin() { ++samples_; }

// What has no weight, or no value, gives way to anything.
template <class Value>
void PageSamples::fill(Filled<Value>& filled, Value value, double weight) const {
  if (std::isnan(weight)) weight = -1.0;
  if ((samples_ - 1) % together_ == 0) {
    filled.values.push_back(value);
  } else if (weight > filled.weight) {
    filled.values.back() = value;
  } else {
    return;
  }
  filled.weight = weight;
}

void PageSamples::set(std::size_t column, double value, double weight) {
  fill(columns_[column], value, weight);
}

void PageSamples::set(std::size_t column, double value) { set(column, value, std::abs(value)); }

void PageSamples::set_state(std::size_t lane, int state, double weight) {
  fill(states_[lane], state, weight);
}

void PageSamples::finish(Report& report) {
  for (std::size_t i = 0; i < columns_.size(); ++i) report.columns[names_[i]] = std::move(columns_[i].values);
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    lanes_[i].state = std::move(states_[i].values);
    report.lanes.push_back(std::move(lanes_[i]));
  }
}

}  // namespace flinch
