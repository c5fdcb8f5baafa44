#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace flinch {

/// Rows of a log from one begin of its time to the next.
struct LogPhase {
  std::size_t first = 0;  ///< row
  std::size_t rows = 0;
  double seconds = 0.0;
};

/// The rows of a log whose time grows, and what was left out.
struct ClockRows {
  std::vector<std::int64_t> instants;  ///< of the rows that are kept, growing [ns]
  std::vector<bool> kept;              ///< of each row of the log
  std::vector<LogPhase> phases;        ///< more than one where the time begins anew
  std::size_t phase = 0;               ///< that was taken
  std::size_t without_time = 0;
  std::size_t repeated = 0;
  std::size_t out_of_order = 0;
};

/// The rows of one phase, counted from 1, or of the longest; rows that repeat the instant before, or go back,
/// are left out. Throws SetupError where there is no such phase.
ClockRows clock_rows(const std::vector<std::int64_t>& instants, std::optional<int> phase = std::nullopt);

/// How regular a clock is.
struct ClockRate {
  std::int64_t period = 0;   ///< between two rows where none is missing [ns]
  double jitter = 0.0;       ///< standard deviation of the steps from it, where no row is missing [s]
  std::size_t gaps = 0;      ///< of more than three periods
  double longest_gap = 0.0;  ///< [s]
  double first_gap = 0.0;    ///< where it begins, since the first row [s]
  std::size_t bridged = 0;   ///< rows that are missing one or two at a time

  double rate() const { return 1e9 / static_cast<double>(period); }
};

/// Of instants that grow; of fewer than two there is no period.
ClockRate clock_rate(const std::vector<std::int64_t>& instants);

/// What is left out of the rows, and which phases there are; one sentence each.
std::vector<std::string> told_rows(const ClockRows& rows, const std::string& clock);

}  // namespace flinch
