#include "systems/framework/recording_stream.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <thread>

#include "systems/foundation/setup_error.h"
#include "systems/framework/recorder.h"
#include "systems/framework/simulator.h"
#include "tests/support/allocations.h"
#include "tests/support/file_bytes.h"
#include "tests/support/locks.h"
#include "tests/support/temporary_folder.h"
#include "tests/systems/framework/killed_run.h"
#include "tests/systems/framework/random_source.h"

namespace flinch {
namespace {

class Stream : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& name) const { return folder_ / name; }
  bool exists(const std::string& name) const { return std::filesystem::exists(file(name)); }
  auto files() const {
    return std::distance(std::filesystem::directory_iterator(folder_.path()),
                         std::filesystem::directory_iterator());
  }

  /// Runs for `ticks` through a ring of `ring` samples.
  void stream_to(const std::filesystem::path& path, int ticks, std::size_t ring) const {
    Recorder recorder(*diagram_, recordable_paths(*diagram_), ring);
    RecordingStream stream(recorder, path, {{"seed", "3"}});
    Simulator simulator(*diagram_);
    simulator.record(recorder);
    Context context = diagram_->make_context();
    for (int tick = 0; tick < ticks; ++tick) {
      stream.wait_for_room();
      simulator.step(context);
    }
    stream.finish({{"late", "known at the end"}});
    EXPECT_EQ(recorder.dropped(), 0);
  }

  const std::unique_ptr<Diagram> diagram_ = test::random_source();

 private:
  test::TemporaryFolder folder_;
};

TEST_F(Stream, MakesTheFileThatIsWrittenFromMemory) {
  for (const int ticks : {0, 1, 50, 5000, 8192, 10'000}) {
    stream_to(file("a.h5"), ticks, 1000);
    Recorder recorder(*diagram_, recordable_paths(*diagram_), static_cast<std::size_t>(ticks));
    Simulator simulator(*diagram_);
    simulator.record(recorder);
    Context context = diagram_->make_context();
    simulator.advance_to(context, ticks * Time(1ms));
    write_recording(recorder.recording({{"seed", "3"}, {"late", "known at the end"}}), file("b.h5"));
    EXPECT_TRUE(test::bytes_of(file("a.h5")) == test::bytes_of(file("b.h5"))) << ticks;
  }
}

TEST_F(Stream, MakesTheSameFileWhateverTheRing) {
  stream_to(file("a.h5"), 9001, 8192);
  for (const std::size_t ring : {1U, 2U, 77U}) {
    stream_to(file("b.h5"), 9001, ring);
    EXPECT_TRUE(test::bytes_of(file("a.h5")) == test::bytes_of(file("b.h5"))) << ring;
  }
}

TEST_F(Stream, LeavesNothingButTheFile) {
  stream_to(file("a.h5"), 100, 10);
  EXPECT_TRUE(exists("a.h5"));
  EXPECT_EQ(files(), 1);
  EXPECT_EQ(open_recording(file("a.h5")).attributes.count("recording.partial"), 0U);
}

TEST_F(Stream, ReplacesAnOlderFileOnlyAtTheEnd) {
  stream_to(file("a.h5"), 100, 10);
  const std::string older = test::bytes_of(file("a.h5"));
  {
    Recorder recorder(*diagram_, recordable_paths(*diagram_), 10);
    const RecordingStream stream(recorder, file("a.h5"));
    Context context = diagram_->make_context();
    diagram_->evaluate(context);
    recorder.record(context);
  }  // the run ended without finish()
  EXPECT_TRUE(test::bytes_of(file("a.h5")) == older);
  EXPECT_EQ(files(), 2) << "the file and the journal";
  EXPECT_EQ(open_recording(file("a.h5.part")).samples(), 1U);
}

TEST_F(Stream, LeavesNothingOfARunThatNeverBegan) {
  Recorder recorder(*diagram_, recordable_paths(*diagram_), 10);
  { const RecordingStream stream(recorder, file("a.h5")); }
  EXPECT_TRUE(std::filesystem::is_empty(file("")));
}

TEST_F(Stream, CountsWhatTheFullRingDropsAndSaysSo) {
  Recorder recorder(*diagram_, recordable_paths(*diagram_), 5);
  Context context = diagram_->make_context();
  diagram_->evaluate(context);
  for (int tick = 0; tick < 12; ++tick) {  // nobody takes anything away yet
    context.set_time(tick * 1ms);
    recorder.record(context);
  }
  EXPECT_EQ(recorder.samples(), 5U);
  EXPECT_EQ(recorder.dropped(), 7);
  RecordingStream stream(recorder, file("a.h5"));
  stream.finish();
  const Recording recording = open_recording(file("a.h5"));
  EXPECT_EQ(recording.samples(), 5U);
  EXPECT_EQ(recording.attributes.at("recording.dropped"), "7");
}

TEST_F(Stream, NeitherAllocatesNorLocksWhereItRecords) {
  Recorder recorder(*diagram_, recordable_paths(*diagram_), 100);
  RecordingStream stream(recorder, file("a.h5"));
  Context context = diagram_->make_context();
  diagram_->evaluate(context);
  recorder.record(context);
  std::int64_t locked = 0, allocated = 0;
  for (int round = 0; round < 20; ++round) {
    const std::int64_t locks = test::locks(), allocations = test::allocations();
    for (int tick = 0; tick < 50; ++tick) recorder.record(context);
    locked += test::locks() - locks;
    allocated += test::allocations() - allocations;
    std::this_thread::sleep_for(5ms);
  }
  EXPECT_EQ(locked, 0);
  EXPECT_EQ(allocated, 0);
  stream.finish();
}

TEST_F(Stream, SaysWhereTheFileCannotBeWritten) {
  Recorder recorder(*diagram_, recordable_paths(*diagram_), 10);
  EXPECT_THROW(RecordingStream(recorder, file("no_folder") / "a.h5"), SetupError);
}

/// Kills runs at random moments, all at the same time.
TEST_F(Stream, OfAKilledRunHoldsAllButTheLastSecond) {
  for (const test::Pace pace : {test::Pace::real_time, test::Pace::as_fast_as_possible}) {
    test::kill_runs(4, 3, pace, file(""));
  }
}

TEST_F(Stream, OfARunThatIsKilledWhileItEndsLeavesAWholeRecording) {
  test::kill_ends_of_runs(12, 5, file(""));
}

}  // namespace
}  // namespace flinch
