#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/robot_id.h"
#include "systems/framework/time.h"

namespace flinch {

/// Which robot a station commands, of those whose samples arrive. Before it has commanded any it looks for a
/// while, and takes the one that is there, or that was chosen among them. Where several could be meant it
/// takes none, and the samples of none count. Once it has taken one it stays with that one, whoever else
/// appears or leaves. Only a robot of the same name that appears after that one has fallen silent, alone, is
/// taken for it: it was started again. Who chose an identity means this start.
///
/// Any thread may call anything; only robots() allocates, nothing locks. Robots that have been silent for a
/// second are forgotten where none was taken.
class RobotSelection {
 public:
  /// `wanted`: name or identity of the robot; empty: whichever is alone. `discovery`: from the first sample
  /// of the robot until it is taken; who is chosen by its identity is taken at once.
  explicit RobotSelection(std::string wanted, Time discovery = 300ms);

  /// Notes that a sample of the robot `id` has arrived, and tells whether it counts.
  bool admits(std::uint64_t id, Time now) noexcept;
  /// Notes the name that a robot gives itself; 32 octets, zeros after its end.
  void note_name(std::uint64_t id, const std::uint8_t* name) noexcept;

  /// Takes the robot if it is time to, and returns it; 0: none yet.
  std::uint64_t take(Time now) noexcept;
  /// The robot that was taken; 0: none yet.
  std::uint64_t taken() const noexcept { return taken_.load(); }

  /// Whether several could be meant, and none was taken.
  bool is_undecided(Time now) const noexcept;
  /// How many robots there are, or were while one was taken.
  int count() const noexcept;
  /// These, by their identities.
  std::vector<SeenRobot> robots() const;

 private:
  static constexpr std::size_t most_robots = 32;
  static constexpr std::size_t words = longest_robot_name / 8;

  struct Seen {
    std::atomic<std::uint64_t> id{0};
    std::atomic<std::int64_t> first_ns{0}, last_ns{0};
    std::array<std::atomic<std::uint64_t>, words> name{};
  };
  struct Candidates {
    int count = 0;
    std::uint64_t id = 0;  ///< of one of them
    Time first{};          ///< when it was seen first
  };

  Candidates candidates(Time now) const noexcept;
  bool succeeds(const Seen& seen, std::uint64_t before, Time now) noexcept;
  Seen* find(std::uint64_t id) noexcept;
  Seen* place_for(std::uint64_t id, Time now) noexcept;
  bool may_be_meant(std::uint64_t id) const noexcept { return wanted_.empty() || is_meant(wanted_, id); }

  std::string wanted_;
  Time discovery_;
  std::atomic<std::uint64_t> taken_{0};
  std::array<Seen, most_robots> seen_{};
};

}  // namespace flinch
