#pragma once

#include <atomic>
#include <cstdint>

namespace flinch::test {

/// What happens to a program that has tests_bad_network preloaded; see bad_network.cpp. In a file that the
/// program maps into its memory, as the test does, so that trouble begins and ends whenever the test wants.
struct Trouble {
  static constexpr const char* variable = "FLINCH_TEST_TROUBLE";  ///< of the environment: names the file

  // Of the network.
  std::atomic<std::uint32_t> lost_per_mille;        ///< of the datagrams that come in
  std::atomic<std::uint32_t> duplicated_per_mille;  ///< of those that go out
  std::atomic<std::uint32_t> overtaken_per_mille;   ///< likewise: sent 1.5 ms late, in bursts of one
  std::atomic<std::int64_t> held_from;              ///< what goes out from here on (CLOCK_MONOTONIC) [ns] ...
  std::atomic<std::int64_t> held_until;             ///< ... to here goes out here, in order [ns]

  // Of the wall clock.
  std::atomic<std::int64_t> wall_clock_step;  ///< by which it is wrong [ns]

  // What has been done.
  std::atomic<std::uint64_t> lost;
  std::atomic<std::uint64_t> duplicated;
  std::atomic<std::uint64_t> overtaken;
  std::atomic<std::uint64_t> held;
  std::atomic<std::uint64_t> wrong_wall_times;  ///< that were told
};

}  // namespace flinch::test
