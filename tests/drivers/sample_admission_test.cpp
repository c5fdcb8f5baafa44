#include "drivers/sample_admission.h"

#include <drivers/idl/flinch.h>
#include <gtest/gtest.h>

#include <limits>

namespace flinch {
namespace {

using enum Admission;

constexpr std::uint32_t robot = 0xc0ffee;

flinch_Header header(std::uint32_t session, std::uint32_t number, Time sent) {
  flinch_Header result{};
  result.sent_ns = sent.count();
  result.session = session;
  result.robot = robot;
  result.number = number;
  result.version = protocol_version;
  return result;
}

/// Judges samples whose sender's clock is ahead by an hour.
struct Gate {
  SampleAdmission admission;

  explicit Gate(bool begins_neutral = false, Time longest_silence = 100ms)
      : admission({.robot = robot,
                   .longest_silence = longest_silence,
                   .longest_way = 5ms,
                   .begins_neutral = begins_neutral}) {}

  Admission judge(std::uint32_t session, std::uint32_t number, Time sent, bool neutral = true,
                  Time way = 50us) {
    return admission.judge(header(session, number, sent + 1h), sent + way, neutral);
  }
};

TEST(SampleAdmission, AdmitsNumbersThatGrowAlsoWithGapsAndAcrossTheWrapAround) {
  Gate gate;
  EXPECT_EQ(gate.judge(7, 0xfffffffe, 1ms), admitted);
  EXPECT_EQ(gate.judge(7, 0xffffffff, 2ms), admitted);
  EXPECT_EQ(gate.judge(7, 0, 3ms), admitted);
  EXPECT_EQ(gate.judge(7, 40, 43ms), admitted);
}

TEST(SampleAdmission, RefusesRepeatedAndOvertakenSamples) {
  Gate gate;
  EXPECT_EQ(gate.judge(7, 5, 1ms), admitted);
  EXPECT_EQ(gate.judge(7, 5, 2ms), not_newer);
  EXPECT_EQ(gate.judge(7, 4, 3ms), not_newer);
  EXPECT_EQ(gate.judge(7, 6, 4ms), admitted);
}

TEST(SampleAdmission, RefusesAnotherVersionAndAnotherRobotWithoutListeningToThem) {
  Gate gate;
  flinch_Header other = header(7, 1, 1h);
  other.version = protocol_version + 1;
  EXPECT_EQ(gate.admission.judge(other, 1ms), other_version);
  other = header(7, 1, 1h);
  other.robot = robot + 1;
  EXPECT_EQ(gate.admission.judge(other, 1ms), other_description);
  EXPECT_EQ(gate.admission.session(), 0u);
  EXPECT_EQ(gate.judge(8, 1, 2ms), admitted);
}

TEST(SampleAdmission, ListensToTheFirstSenderUntilItFallsSilent) {
  Gate gate;
  Time t = 0ms;
  for (std::uint32_t k = 1; k < 200; ++k, t += 1ms) {
    EXPECT_EQ(gate.judge(7, k, t), admitted);
    EXPECT_EQ(gate.judge(8, 1000 + k, t), other_session);
  }
  EXPECT_EQ(gate.judge(8, 2000, t + 90ms), other_session);
  EXPECT_EQ(gate.judge(8, 2001, t + 101ms), admitted);
  EXPECT_EQ(gate.judge(7, 300, t + 102ms), other_session);
}

TEST(SampleAdmission, IsNotKeptAliveByWhatItRefuses) {
  Gate gate;
  EXPECT_EQ(gate.judge(7, 5, 0ms), admitted);
  for (Time t = 1ms; t < 100ms; t += 1ms) EXPECT_EQ(gate.judge(7, 5, t), not_newer);
  EXPECT_EQ(gate.judge(8, 1, 102ms), admitted);
}

TEST(SampleAdmission, RefusesWhatWasOnItsWayForTooLong) {
  Gate gate;
  EXPECT_EQ(gate.judge(7, 1, 0ms), admitted);
  EXPECT_EQ(gate.judge(7, 2, 1ms, true, 1100ms), too_late);
  EXPECT_EQ(gate.judge(7, 3, 1102ms), admitted);
}

TEST(SampleAdmission, LetsNobodyBeginOrBeginAgainWithMoreThanANeutralSample) {
  Gate gate(true, 6ms);
  EXPECT_EQ(gate.judge(7, 1, 1ms, false), not_neutral);
  EXPECT_EQ(gate.judge(7, 2, 2ms, true), admitted);
  EXPECT_EQ(gate.judge(7, 3, 3ms, false), admitted);
  EXPECT_EQ(gate.judge(7, 4, 20ms, false), not_neutral);
  EXPECT_EQ(gate.judge(7, 5, 21ms, true), admitted);
}

TEST(SampleAdmission, RefusesASenderWithoutASession) {
  Gate gate;
  EXPECT_EQ(gate.judge(0, 1, 1ms), other_session);
}

TEST(SampleAdmission, TranslatesTheSendersTimes) {
  Gate gate;
  for (std::uint32_t k = 1; k < 50; ++k) ASSERT_EQ(gate.judge(7, k, k * 1ms), admitted);
  const Time error = gate.admission.to_own_clock(1h + 49ms) - 49ms;
  EXPECT_GE(error, 49us);
  EXPECT_LE(error, 51us);
}

TEST(RobotHash, DiffersForAnyChangeOfTheDescription) {
  EXPECT_EQ(robot_hash("abc"), robot_hash("abc"));
  EXPECT_EQ(robot_hash(""), 0x811c9dc5u);   // FNV-1a, by its definition
  EXPECT_EQ(robot_hash("a"), 0xe40c292cu);  // published test vector
  EXPECT_NE(robot_hash("mass: 2.1"), robot_hash("mass: 2.2"));
}

TEST(SampleAdmission, RefusesStampsThatNoClockShows) {
  SampleAdmission admission({.robot = robot});
  constexpr std::int64_t least = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  for (const std::int64_t stamp : {least, most, most / 2, -most / 2}) {
    EXPECT_EQ(admission.judge(header(7, 1, Time(stamp)), 1ms), no_time) << stamp;
    flinch_Header acquired_never = header(7, 1, 1ms);
    acquired_never.acquired_ns = stamp;
    EXPECT_EQ(admission.judge(acquired_never, 1ms), no_time) << stamp;
  }
  EXPECT_EQ(admission.judge(header(7, 1, 24h * 365 * 40), 1ms), admitted);
}

TEST(Session, IsNeverZeroAndNeverTheSame) {
  const std::uint32_t first = draw_session(), second = draw_session();
  EXPECT_NE(first, 0u);
  EXPECT_NE(first, second);
}

TEST(SampleAdmission, DoesNotListenAgainToASessionThatAnotherHasFollowed) {
  SampleAdmission admission({.robot = robot, .longest_silence = 100ms, .longest_way = 5ms, .once = true});
  EXPECT_EQ(admission.judge(header(7, 1, 1ms), 1ms), admitted);
  EXPECT_EQ(admission.judge(header(7, 2, 500ms), 500ms), admitted);  // it was silent, but nobody came
  EXPECT_EQ(admission.judge(header(8, 1, 1s), 1s), admitted);
  EXPECT_EQ(admission.judge(header(7, 3, 2s), 2s), other_session);
  EXPECT_EQ(admission.judge(header(8, 2, 2s), 2s), admitted);
  EXPECT_EQ(admission.judge(header(9, 1, 3s), 3s), admitted);
  EXPECT_EQ(admission.judge(header(7, 4, 4s), 4s), other_session);
  EXPECT_EQ(admission.judge(header(8, 3, 4s), 4s), other_session);
  EXPECT_EQ(admission.judge(header(9, 2, 4s), 4s), admitted);
}

TEST(SampleAdmission, ListensAgainWhereSessionsMayComeBack) {
  Gate gate;
  EXPECT_EQ(gate.judge(7, 1, 1ms), admitted);
  EXPECT_EQ(gate.judge(8, 1, 1s), admitted);
  EXPECT_EQ(gate.judge(7, 2, 2s), admitted);
}

TEST(SampleAdmission, HearsSendersOfItsOwnPaceOnly) {
  flinch_Header by_the_clock = header(7, 1, 1s), in_lockstep = header(7, 2, 1s);
  in_lockstep.flags = flag_lockstep;
  SampleAdmission clock({.robot = robot}), lockstep({.robot = robot, .pace = Pace::lockstep});
  EXPECT_EQ(clock.judge(in_lockstep, 1s), other_pace);
  EXPECT_EQ(clock.session(), 0U) << "it is not listened to";
  EXPECT_EQ(clock.judge(by_the_clock, 1s), admitted);
  EXPECT_EQ(lockstep.judge(by_the_clock, 1s), other_pace);
  EXPECT_EQ(lockstep.judge(in_lockstep, 1s), admitted);
  SampleAdmission either({.robot = robot, .pace = std::nullopt});
  EXPECT_EQ(either.judge(by_the_clock, 1s), admitted);
  EXPECT_EQ(either.judge(in_lockstep, 2s), admitted);
}

TEST(SampleAdmission, TranslatesNoTimesInLockstepAndFindsNoneTooLate) {
  SampleAdmission admission({.robot = robot, .longest_silence = 10s, .pace = Pace::lockstep});
  for (std::uint32_t tick = 0; tick < 100; ++tick) {
    flinch_Header sample = header(7, tick + 1, tick * 1ms);
    sample.flags = flag_lockstep;
    EXPECT_EQ(admission.judge(sample, 5s + tick * 700ms), admitted) << "seven hundred times slower than real";
    EXPECT_EQ(admission.to_own_clock(tick * 1ms), tick * 1ms);
  }
}

TEST(SampleAdmission, HearsTheNextAtOnceWhereASessionSaysThatItEnds) {
  SampleAdmission admission(
      {.robot = robot, .longest_silence = 10s, .begins_neutral = true, .once = true, .pace = Pace::lockstep});
  const auto judge = [&admission](std::uint32_t session, std::uint32_t number, std::uint8_t flags) {
    flinch_Header sample = header(session, number, 0s);
    sample.flags = static_cast<std::uint8_t>(flag_lockstep | flags);
    return admission.judge(sample, 1s, (flags & flag_valid) == 0);
  };
  EXPECT_EQ(judge(7, 1, 0), admitted);
  EXPECT_EQ(judge(8, 1, 0), other_session);
  EXPECT_EQ(judge(8, 2, flag_end), other_session) << "nobody ends the session of another";
  EXPECT_EQ(judge(7, 2, flag_end), admitted);
  EXPECT_EQ(judge(8, 3, flag_valid), not_neutral);
  EXPECT_EQ(judge(8, 4, 0), admitted);
  EXPECT_EQ(judge(7, 3, 0), other_session);
  EXPECT_EQ(judge(8, 5, flag_end), admitted);
  EXPECT_EQ(judge(7, 4, 0), other_session) << "another has followed it";
}

}  // namespace
}  // namespace flinch
