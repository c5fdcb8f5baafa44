#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <vector>

#include "experiments/campaign/run_result.h"

namespace flinch {

/// The results of a campaign, read one after the other as often as one likes. Those of a journal stay in its
/// file: each is read when it is asked for, so that many take hardly more memory than few.
class CampaignResults {
 public:
  /// The result at a place, counted from 0.
  using Read = std::function<RunResult(std::size_t place)>;

  CampaignResults(std::size_t size, Read read);
  /// Results in memory.
  CampaignResults(std::vector<RunResult> results);            // NOLINT(google-explicit-constructor)
  CampaignResults(std::initializer_list<RunResult> results);  // NOLINT(google-explicit-constructor)

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  RunResult operator[](std::size_t place) const { return read_(place); }

  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = RunResult;
    using difference_type = std::ptrdiff_t;
    using pointer = const RunResult*;
    using reference = RunResult;

    Iterator(const CampaignResults& results, std::size_t place) : results_(&results), place_(place) {}
    RunResult operator*() const { return (*results_)[place_]; }
    Iterator& operator++() {
      ++place_;
      return *this;
    }
    bool operator==(const Iterator& other) const { return place_ == other.place_; }

   private:
    const CampaignResults* results_;
    std::size_t place_;
  };

  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size_}; }

 private:
  std::size_t size_;
  Read read_;
};

}  // namespace flinch
