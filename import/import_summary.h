#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "import/mapped_log.h"

namespace flinch {

/// A signal of an imported log.
struct SignalSummary {
  struct Entry {
    std::string column;
    int entry = 0;
    double least = 0.0;  ///< SI
    double most = 0.0;
  };
  std::string name;  ///< "joints.active"
  std::vector<Entry> entries;
  double valid_fraction = 0.0;  ///< of the samples
};

/// What was read of a log.
struct ImportSummary {
  std::size_t rows = 0;
  std::size_t samples = 0;
  double rate = 0.0;    ///< [Hz]
  double jitter = 0.0;  ///< [s]
  std::size_t gaps = 0;
  std::size_t repeated = 0;
  double seconds = 0.0;
  std::vector<SignalSummary> signals;
  std::vector<std::string> unused;
  std::vector<ComputedColumn> computed;
  std::vector<std::string> warnings;
};

ImportSummary summary_of(const MappedLog& log);

}  // namespace flinch
