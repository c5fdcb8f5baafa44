#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "drivers/clock_map.h"
#include "drivers/pace.h"
#include "drivers/robot_selection.h"
#include "drivers/wire_header.h"
#include "systems/framework/time.h"

namespace flinch {

/// What becomes of a sample that has arrived.
enum class Admission : std::uint8_t {
  admitted,
  other_version,      ///< speaks another protocol
  other_description,  ///< uses another robot description
  other_robot,        ///< comes from another robot than the one that is commanded, or is meant for another
  other_session,      ///< comes from another sender than the one that is being listened to, or may be
  other_pace,         ///< goes in lockstep where this end goes by the clock, or the other way round
  not_neutral,        ///< would begin a session with more than a neutral command
  not_newer,          ///< its number has been seen, or overtaken
  too_late,           ///< was on its way for too long
  no_time,            ///< bears a stamp that no clock shows
};
inline constexpr int admission_count = 10;

/// By what the sender of a sample goes.
Pace pace_of(const flinch_Header& header) noexcept;

struct AdmissionSettings {
  std::uint32_t robot = 0;           ///< robot_hash() of the description
  std::uint64_t addressee = 0;       ///< the only robot that samples may name; 0: any
  RobotSelection* robots = nullptr;  ///< who decides which robot's samples count, where given
  Time longest_silence = 100ms;      ///< after which a sender is given up, and another one listened to
  Time longest_way = 20ms;           ///< from sending to arrival, as far as it varies
  bool begins_neutral = false;       ///< a session begins only with a sample that asks for nothing
  bool once = false;                 ///< a session that another one has followed never comes back
  /// Of the senders whose samples count; none: of all. Only in real time samples can be too late.
  std::optional<Pace> pace = Pace::real_time;
};

/// Who is listened to, and which of its samples count: one sender at a time, the first that speaks, until it
/// falls silent; only what is newer than the last; only what is not late. Neither a second sender, however
/// loud, nor a late or repeated sample can push in. Where a session must begin neutral, so must what comes
/// after a silence. Where sessions do not come back, the last 64 are remembered: what was recorded of them
/// and is sent again has no effect. In lockstep a session may say that it ends: then the next one is listened
/// to at once. Constant time; for one thread.
class SampleAdmission {
 public:
  explicit SampleAdmission(const AdmissionSettings& settings) : settings_(settings) {}

  /// Judges a sample that arrived `now` (own monotonic clock); `neutral`: it asks for nothing.
  Admission judge(const flinch_Header& header, Time now, bool neutral = true) noexcept;

  /// A time of the admitted sender's clock in the own one; in lockstep both show the same.
  Time to_own_clock(Time senders) const noexcept { return clock_.to_here(senders); }

  /// How many samples of admitted senders never came, by their numbers.
  std::uint32_t missed() const noexcept { return missed_; }

  /// The session that is listened to; 0 for none.
  std::uint32_t session() const noexcept { return session_; }

 private:
  void give_up_the_silent(Time now) noexcept;
  bool is_of_robot(std::uint64_t robot_id, Time now) const noexcept;
  bool is_over(std::uint32_t session) const noexcept;
  bool is_in_time(const flinch_Header& header, Time now, ClockMap& clock) const noexcept;
  void listen_to(std::uint32_t session) noexcept;

  AdmissionSettings settings_;
  std::uint32_t session_ = 0;
  std::uint32_t last_session_ = 0;
  std::array<std::uint32_t, 64> over_{};  ///< sessions that others have followed, 0 where there are none yet
  std::size_t next_over_ = 0;
  std::uint32_t last_number_ = 0;
  std::uint32_t missed_ = 0;
  Time last_{};
  ClockMap clock_;
};

}  // namespace flinch
