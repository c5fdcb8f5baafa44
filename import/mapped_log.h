#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "import/clock_rows.h"
#include "import/computed_columns.h"
#include "import/log_mapping.h"
#include "import/log_track.h"

namespace flinch {

/// The columns of a log that are mapped, in SI, each over its own rows, and what was met on the way.
class MappedLog {
 public:
  /// Throws SetupError with all that is wrong.
  explicit MappedLog(const LogMapping& mapping);

  const LogMapping& mapping() const { return mapping_; }
  Time period() const { return period_; }
  std::size_t samples() const { return samples_; }
  std::size_t rows() const { return rows_; }          ///< of the log, that were kept
  std::size_t repeated() const { return repeated_; }  ///< left out
  const ClockRate& rate() const { return rate_; }     ///< of the joints' clock
  const std::vector<std::string>& unused() const { return unused_; }
  /// Columns beside the joints' that follow from those which are mapped.
  const std::vector<ComputedColumn>& computed() const { return computed_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  void warn(const std::string& warning) { warnings_.push_back(warning); }

  /// The instant of a sample of the recording [ns of the log].
  std::int64_t instant(std::size_t sample) const {
    return start_ + static_cast<std::int64_t>(sample) * period_.count();
  }
  bool has(const std::string& signal) const;
  bool is_in_body(const std::string& signal) const;

  /// The entries of a signal over samples that are asked for in their order; NaN where there is none.
  class Cursor {
   public:
    Cursor(const MappedLog& log, const std::string& signal, int entries);
    const Eigen::VectorXd& at(std::size_t sample);

   private:
    const MappedLog* log_;
    std::vector<std::size_t> tracks_;
    std::vector<std::size_t> rows_;
    Eigen::VectorXd values_;
  };

 private:
  friend class Cursor;
  void read(LogFile& file);
  void read_clock(LogFile& file, const LogClock& clock, const std::vector<std::size_t>& columns);
  std::vector<std::int64_t> instants_of(LogFile& file, const LogClock& clock, const std::string& table);
  void place_samples();
  void tell(const LogFile& file);
  void find_computed(LogFile& file);

  LogMapping mapping_;
  std::vector<LogTrack> tracks_;  ///< of each column of the mapping
  Time period_{};
  std::int64_t start_ = 0;
  std::size_t samples_ = 0;
  std::size_t rows_ = 0;
  std::size_t repeated_ = 0;
  ClockRate rate_;
  std::vector<std::string> unused_;
  std::vector<ComputedColumn> computed_;
  std::vector<std::string> warnings_;
};

}  // namespace flinch
