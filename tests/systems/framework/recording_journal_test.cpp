#include "systems/framework/recording_journal.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <filesystem>
#include <fstream>

#include "systems/foundation/setup_error.h"
#include "systems/framework/recorded_values.h"
#include "systems/framework/recorder.h"
#include "systems/framework/simulator.h"
#include "tests/support/temporary_folder.h"
#include "tests/systems/framework/random_source.h"

namespace flinch {
namespace {

class Journal : public testing::Test {
 protected:
  std::filesystem::path part() const { return folder_ / "a.h5.part"; }

  /// `ticks` samples of a random source.
  static Recording whole(int ticks) {
    const auto diagram = test::random_source();
    Recorder recorder(*diagram, recordable_paths(*diagram), static_cast<std::size_t>(ticks));
    Simulator simulator(*diagram);
    simulator.record(recorder);
    Context context = diagram->make_context();
    simulator.advance_to(context, ticks * Time(1ms));
    return recorder.recording({{"seed", "3"}, {"scenario", "name: text\nsecond: line\n"}, {"empty", ""}});
  }

  static SampleBlock samples(const Recording& recording, std::size_t first, std::size_t count) {
    SampleBlock all{recording.time_ns, {}};
    for (const Signal& signal : recording.signals)
      all.rows.push_back({signal.rows.data(), signal.layout.numbers, signal.layout.numbers});
    return all.part(first, count);
  }

  /// Writes frames of 1, 2, 3, ... samples.
  void write(const Recording& recording) const {
    RecordingJournal journal(recording, part());
    for (std::size_t first = 0, size = 1; first < recording.samples(); first += size, ++size) {
      journal.append(samples(recording, first, std::min(size, recording.samples() - first)));
    }
  }

  static void expect_beginning_of(const Recording& whole, const Recording& read) {
    ASSERT_LE(read.samples(), whole.samples());
    EXPECT_TRUE(std::equal(read.time_ns.begin(), read.time_ns.end(), whole.time_ns.begin()));
    ASSERT_EQ(read.signals.size(), whole.signals.size());
    for (std::size_t i = 0; i < read.signals.size(); ++i) {
      ASSERT_EQ(read.signals[i].path, whole.signals[i].path);
      std::vector<internal::Number> rows(read.samples() * read.signals[i].layout.numbers);
      read.read_rows(read.signals[i], 0, read.samples(), rows.data());
      for (std::size_t k = 0; k < rows.size(); ++k) {
        ASSERT_EQ(rows[k].integer, whole.signals[i].rows[k].integer) << read.signals[i].path << ' ' << k;
      }
    }
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(Journal, HoldsEveryBitUnitAndAttribute) {
  const Recording recording = whole(200);
  write(recording);
  Recording read = open_journal(part());
  ASSERT_EQ(read.samples(), 200U);
  expect_beginning_of(recording, read);
  EXPECT_EQ(read.attributes.at("recording.partial"),
            "the run was killed; only its first 0.200 s are recorded");
  read.attributes.erase("recording.partial");
  EXPECT_EQ(read.attributes, recording.attributes);
  EXPECT_EQ(read.period, recording.period);
  for (std::size_t i = 0; i < read.signals.size(); ++i) {
    for (std::size_t f = 0; f < read.signals[i].layout.fields.size(); ++f) {
      EXPECT_EQ(read.signals[i].layout.fields[f].unit, recording.signals[i].layout.fields[f].unit);
      EXPECT_EQ(read.signals[i].layout.fields[f].frame, recording.signals[i].layout.fields[f].frame);
    }
  }
}

TEST_F(Journal, CutAnywhereHoldsEveryFrameBeforeTheCut) {
  const Recording recording = whole(30);
  write(recording);
  const std::uintmax_t size = std::filesystem::file_size(part());
  std::size_t last = 30;
  int refused = 0;
  for (std::uintmax_t cut = size - 1; cut > 0; --cut) {
    std::filesystem::resize_file(part(), cut);
    try {
      const Recording read = open_journal(part());
      EXPECT_LE(read.samples(), last);
      EXPECT_LE(last - read.samples(), 7U) << "a cut of one byte takes more than one frame";
      last = read.samples();
      if (cut % 997 == 0) expect_beginning_of(recording, read);
    } catch (const SetupError& error) {  // only the description is cut
      EXPECT_EQ(last, 0U);
      EXPECT_NE(std::string(error.what()).find("a.h5.part: "), std::string::npos);
      ++refused;
    }
  }
  EXPECT_EQ(last, 0U);
  EXPECT_GT(refused, 100);
}

TEST_F(Journal, StopsAtAFrameThatIsSpoilt) {
  const Recording recording = whole(30);
  write(recording);
  const std::uintmax_t size = std::filesystem::file_size(part());
  std::fstream file(part(), std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(static_cast<std::streamoff>(size - 100));
  file.put('\x55');
  file.close();
  const Recording read = open_journal(part());
  EXPECT_EQ(read.samples(), 28U);  // the last frame has two samples
  expect_beginning_of(recording, read);
}

TEST_F(Journal, ReadsAnyRowsAcrossFrames) {
  const Recording recording = whole(60);
  write(recording);
  const Recording read = open_journal(part());
  const auto values = flinch::read<test::Sample>(read, "source/sample");
  const auto original = flinch::read<test::Sample>(recording, "source/sample");
  for (const std::size_t k : {59U, 0U, 14U, 15U, 16U, 31U}) EXPECT_EQ(values[k].when, original[k].when);
  const Signal& signal = read.signal("source/sample");
  std::vector<internal::Number> rows(7 * signal.layout.numbers);
  read.read_rows(signal, 26, 7, rows.data());
  const internal::Number* const expected =
      recording.signal("source/sample").rows.data() + 26 * signal.layout.numbers;
  for (std::size_t k = 0; k < rows.size(); ++k) ASSERT_EQ(rows[k].integer, expected[k].integer) << k;
}

// Frames as earlier versions have written them: all numbers as they lay in memory.
TEST_F(Journal, OfAnEarlierVersionIsRead) {
  const Recording recording = whole(40);
  { const RecordingJournal description(recording, part()); }
  std::ofstream file(part(), std::ios::binary | std::ios::app);
  for (std::size_t first = 0; first < 40; first += 20) {
    std::vector<std::uint64_t> words = {20};
    for (std::size_t k = first; k < first + 20; ++k)
      words.push_back(static_cast<std::uint64_t>(recording.time_ns[k]));
    for (const Signal& signal : recording.signals) {
      for (std::size_t k = first * signal.layout.numbers; k < (first + 20) * signal.layout.numbers; ++k)
        words.push_back(static_cast<std::uint64_t>(signal.rows[k].integer));
    }
    std::uint64_t checksum = 0xcbf29ce484222325;
    for (const std::uint64_t word : words) {
      checksum = (checksum ^ word) * 0x100000001b3;
      checksum ^= checksum >> 32;
    }
    words.insert(words.begin(), {0x31'53'68'63'6e'69'6c'66, 8 * words.size(), checksum});
    file.write(reinterpret_cast<const char*>(words.data()), static_cast<std::streamsize>(8 * words.size()));
  }
  file.close();
  const Recording read = open_journal(part());
  EXPECT_EQ(read.samples(), 40U);
  expect_beginning_of(recording, read);
}

TEST_F(Journal, TakesAboutAsMuchRoomAsTheRecording) {
  Recording recording = whole(2000);
  for (Signal& signal : recording.signals) {  // that hardly changes, as most of a run
    for (std::size_t i = 0; i < signal.rows.size(); ++i) signal.rows[i].real = 0.5;
  }
  {
    RecordingJournal journal(recording, part());
    for (std::size_t first = 0; first < 2000; first += 100) journal.append(samples(recording, first, 100));
  }
  std::size_t plain = 0;
  for (const Signal& signal : recording.signals) plain += 8 * signal.rows.size();
  EXPECT_LT(std::filesystem::file_size(part()), plain / 20);
}

TEST_F(Journal, IsNotGivenToTwoRunsAtATime) {
  const Recording recording = whole(3);
  const RecordingJournal first(recording, part());
  try {
    const RecordingJournal second(recording, part());
    FAIL() << "two runs write one journal";
  } catch (const SetupError& error) {
    EXPECT_EQ(error.what(),
              part().string() + ": the recording cannot be written: another run is recording into it");
  }
  EXPECT_EQ(open_journal(part()).attributes.at("recording.partial"),
            "the run still goes on; so far 0.000 s are recorded");
}

TEST_F(Journal, SaysWhereItCannotBeWritten) {
  EXPECT_THROW(RecordingJournal(whole(1), part() / "no_folder"), SetupError);
  EXPECT_THROW(open_journal(part()), SetupError);
  // A device of its own: none that others use is put at risk.
  const std::filesystem::path full = part().parent_path() / "full";
  if (::mknod(full.c_str(), S_IFCHR | 0600, ::makedev(1, 7)) != 0)
    GTEST_SKIP() << "a device that is always full needs the right to make it";
  EXPECT_THROW(RecordingJournal(whole(1), full), SetupError);
  EXPECT_TRUE(std::filesystem::is_character_file(full)) << "it is not ours to remove";
}

}  // namespace
}  // namespace flinch
