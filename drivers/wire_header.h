#pragma once

#include <cstdint>
#include <string_view>

struct flinch_Header;  // drivers/idl/flinch.idl

namespace flinch {

/// Which wire format and meaning this version of flinch speaks. Samples of any other are refused.
inline constexpr std::uint16_t protocol_version = 5;

/// Bits of flinch_Header::flags.
inline constexpr std::uint8_t flag_valid = 1;
inline constexpr std::uint8_t flag_passive_valid = 2;  ///< of a joint sample
inline constexpr int passive_count_bit = 2;            ///< lowest of three bits of a joint sample
inline constexpr std::uint8_t flag_begin = 4;          ///< of a torque sample in lockstep
inline constexpr std::uint8_t flag_engage_brake = 2;   ///< of a torque sample
inline constexpr std::uint8_t flag_timing_known = 2;   ///< of diagnostics
inline constexpr std::uint8_t flag_links_known = 4;    ///< of diagnostics
inline constexpr std::uint8_t flag_end = 64;           ///< of every sample in lockstep
inline constexpr std::uint8_t flag_lockstep = 128;     ///< of every sample

/// Whether a stamp can be the time of a clock; sums and differences of such stamps do not overflow.
constexpr bool is_clock_time(std::int64_t ns) noexcept {
  constexpr std::int64_t century = 3'155'760'000'000'000'000;
  return -century / 2 < ns && ns < century / 2;
}

/// Who sends, as its samples say.
struct SenderIdentity {
  std::uint32_t session = 0;   ///< never 0 for a sender; see draw_session()
  std::uint32_t robot = 0;     ///< see robot_hash()
  std::uint64_t robot_id = 0;  ///< of readings: whose; of commands: for whom; see draw_robot_id()
};

/// A session that differs from that of any other sender, and from the last one of this program. Not 0.
std::uint32_t draw_session();

/// What two programs compare to know that they use the same robot description: a hash (FNV-1a, 32 bits) of
/// the robot file's text. It guards against mistakes, not against malice.
std::uint32_t robot_hash(std::string_view description) noexcept;

}  // namespace flinch
