#pragma once

#include <chrono>

namespace flinch {

/// Wall time since it was made, for summaries.
class StopWatch {
 public:
  double seconds() const {  // [s]
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  }

 private:
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

}  // namespace flinch
