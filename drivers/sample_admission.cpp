#include "drivers/sample_admission.h"

#include <drivers/idl/flinch.h>

#include <algorithm>

namespace flinch {
namespace {

/// Whether a number comes after another, also across the wrap-around.
bool is_after(std::uint32_t number, std::uint32_t last) {
  return static_cast<std::int32_t>(number - last) > 0;
}

}  // namespace

Pace pace_of(const flinch_Header& header) noexcept {
  return (header.flags & flag_lockstep) != 0 ? Pace::lockstep : Pace::real_time;
}

void SampleAdmission::give_up_the_silent(Time now) noexcept {
  if (session_ != 0 && now - last_ > settings_.longest_silence) session_ = 0;
}

bool SampleAdmission::is_of_robot(std::uint64_t robot_id, Time now) const noexcept {
  if (settings_.addressee != 0 && robot_id != settings_.addressee) return false;
  return settings_.robots == nullptr || settings_.robots->admits(robot_id, now);
}

bool SampleAdmission::is_over(std::uint32_t session) const noexcept {
  return settings_.once && session != last_session_ &&
         std::find(over_.begin(), over_.end(), session) != over_.end();
}

void SampleAdmission::listen_to(std::uint32_t session) noexcept {
  session_ = session;
  if (session == last_session_) return;
  over_[next_over_] = last_session_;
  next_over_ = (next_over_ + 1) % over_.size();
  last_session_ = session;
}

Admission SampleAdmission::judge(const flinch_Header& header, Time now, bool neutral) noexcept {
  if (header.version != protocol_version) return Admission::other_version;
  if (header.robot != settings_.robot) return Admission::other_description;
  if (!is_clock_time(header.sent_ns) || !is_clock_time(header.acquired_ns)) return Admission::no_time;
  if (!is_of_robot(header.robot_id, now)) return Admission::other_robot;
  if (settings_.pace && *settings_.pace != pace_of(header)) return Admission::other_pace;
  give_up_the_silent(now);
  if (header.session == 0 || (session_ != 0 && header.session != session_)) return Admission::other_session;
  if (is_over(header.session)) return Admission::other_session;

  const bool known = header.session == last_session_;
  if (known && !is_after(header.number, last_number_)) return Admission::not_newer;
  ClockMap clock = known ? clock_ : ClockMap();
  const bool in_time = settings_.pace != Pace::real_time || is_in_time(header, now, clock);
  if (known) clock_ = clock;
  if (!in_time) return Admission::too_late;
  if (session_ == 0 && settings_.begins_neutral && !neutral) return Admission::not_neutral;

  if (known) missed_ += header.number - last_number_ - 1;
  clock_ = clock;
  listen_to(header.session);
  last_number_ = header.number;
  last_ = now;
  if (settings_.pace == Pace::lockstep && (header.flags & flag_end) != 0) session_ = 0;
  return Admission::admitted;
}

/// Notes in `clock` when it came.
bool SampleAdmission::is_in_time(const flinch_Header& header, Time now, ClockMap& clock) const noexcept {
  clock.observe(Time(header.sent_ns), now);
  return now - clock.to_here(Time(header.sent_ns)) <= settings_.longest_way;
}

}  // namespace flinch
