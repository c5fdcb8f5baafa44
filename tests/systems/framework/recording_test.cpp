#include "systems/framework/recording.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/player.h"
#include "systems/framework/recorder.h"
#include "systems/framework/simulator.h"
#include "tests/support/file_bytes.h"
#include "tests/support/temporary_folder.h"
#include "tests/systems/framework/random_source.h"

namespace flinch {
namespace {

using test::Mood;
using test::Sample;
using test::Source;

/// Something downstream whose every bit depends on the samples.
class Digest final : public System {
  State<double> sum_ = state<double>("sum", 0.0);

 public:
  InputPort<Sample> sample = input<Sample>("sample");
  OutputPort<double> sum = output<&Digest::read>("sum", sum_);

 private:
  Update add_ = update<&Digest::add>(sum_, sum_, sample);
  double read(double value) const { return value; }
  double add(double value, const Sample& seen) const {
    const double real = std::isnan(seen.real) ? 0.25 : seen.real;
    return 0.9 * value + real + seen.fixed.x() + seen.bounded.sum() * (seen.good ? 1.0 : 3.0) + seen.pair[1] +
           1e-9 * static_cast<double>(seen.when.count()) + (seen.mood == Mood::alarmed ? 0.1 : 0.2) +
           seen.count;
  }
};

Recording record_source(int ticks) {
  DiagramBuilder builder("original");
  auto& source = builder.add<Source>("source");
  auto& digest = builder.add<Digest>("digest");
  builder.connect(source.sample, digest.sample);
  const auto diagram = builder.build();
  Recorder recorder(*diagram, recordable_paths(*diagram), static_cast<std::size_t>(ticks));
  Simulator simulator(*diagram);
  simulator.record(recorder);
  Context context = diagram->make_context();
  simulator.advance_to(context, ticks * Time(1ms));
  return recorder.recording({{"seed", "3"}, {"scenario", "name: text\nsecond: line\n"}, {"empty", ""}});
}

class RecordingFile : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& name) const { return folder_ / name; }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(RecordingFile, ReplaysToIdenticalBitsDownstream) {
  const Recording original = record_source(500);
  write_recording(original, file("a.h5"));
  const Recording read = read_recording(file("a.h5"));

  DiagramBuilder builder("replay");
  auto& player = builder.add<Player<Sample>>("player", read, "source/sample");
  auto& digest = builder.add<Digest>("digest");
  builder.connect(player.played, digest.sample);
  const auto diagram = builder.build();
  Recorder recorder(*diagram, {"digest/sum"}, 500);
  Simulator simulator(*diagram);
  simulator.record(recorder);
  Context context = diagram->make_context();
  simulator.advance_to(context, 500ms);
  EXPECT_EQ(recorder.recording().column("digest/sum", "value"), original.column("digest/sum", "value"));
}

TEST(Recorder, KeepsOneRowForPortsThatShowOneValue) {
  DiagramBuilder inner("inner");
  auto& source = inner.add<Source>("source");
  inner.export_output("sample", source.sample);
  DiagramBuilder builder("outer");
  builder.add(inner.build());
  const auto diagram = builder.build();
  Recorder recorder(*diagram, {"inner/sample", "inner/source/sample"}, 10);
  Simulator simulator(*diagram);
  simulator.record(recorder);
  Context context = diagram->make_context();
  simulator.advance_to(context, 10ms);
  const SampleBlock block = recorder.front();
  ASSERT_EQ(block.rows.size(), 2U);
  EXPECT_EQ(block.rows[0].first, block.rows[1].first);
  const Recording recording = recorder.recording();
  EXPECT_EQ(recording.column("inner/sample", "real"), recording.column("inner/source/sample", "real"));
  EXPECT_EQ(recording.column("inner/sample", "real").size(), 10U);
}

TEST_F(RecordingFile, HoldsEveryBitAndAttribute) {
  const Recording original = record_source(200);
  write_recording(original, file("a.h5"));
  const Recording read = read_recording(file("a.h5"));
  EXPECT_EQ(read.attributes, original.attributes);
  EXPECT_EQ(read.period, original.period);
  EXPECT_EQ(read.time_ns, original.time_ns);
  ASSERT_EQ(read.signals.size(), original.signals.size());
  for (std::size_t i = 0; i < read.signals.size(); ++i) {
    ASSERT_EQ(read.signals[i].rows.size(), original.signals[i].rows.size());
    for (std::size_t k = 0; k < read.signals[i].rows.size(); ++k) {
      ASSERT_EQ(read.signals[i].rows[k].integer, original.signals[i].rows[k].integer)
          << read.signals[i].path << k;
    }
    for (std::size_t f = 0; f < read.signals[i].layout.fields.size(); ++f) {
      EXPECT_EQ(read.signals[i].layout.fields[f].unit, original.signals[i].layout.fields[f].unit);
      EXPECT_EQ(read.signals[i].layout.fields[f].frame, original.signals[i].layout.fields[f].frame);
    }
  }
}

TEST_F(RecordingFile, IsTheSameFileForTheSameRun) {
  write_recording(record_source(300), file("a.h5"));
  write_recording(record_source(300), file("b.h5"));
  EXPECT_EQ(test::bytes_of(file("a.h5")), test::bytes_of(file("b.h5")));
}

TEST_F(RecordingFile, TellsWhenItIsTruncatedAndNamesTheFile) {
  write_recording(record_source(300), file("a.h5"));
  const std::string whole = test::bytes_of(file("a.h5"));
  for (const std::size_t size : {std::size_t{0}, std::size_t{100}, whole.size() / 2, whole.size() - 100}) {
    std::ofstream(file("cut.h5"), std::ios::binary) << whole.substr(0, size);
    try {
      read_recording(file("cut.h5"));
      ADD_FAILURE() << "a recording cut to " << size << " bytes was read";
    } catch (const SetupError& error) {
      EXPECT_NE(std::string(error.what()).find("cut.h5: this is no whole flinch recording"),
                std::string::npos);
    }
  }
  EXPECT_THROW(read_recording(file("missing.h5")), SetupError);
}

TEST_F(RecordingFile, KeepsTheOldFileWhenTheNewOneCannotBeWritten) {
  const std::filesystem::path nowhere = file("no_folder") / "a.h5";
  EXPECT_THROW(write_recording(record_source(3), nowhere), SetupError);
  EXPECT_FALSE(std::filesystem::exists(nowhere));
}

TEST_F(RecordingFile, CanBeEmpty) {
  write_recording(record_source(0), file("empty.h5"));
  EXPECT_EQ(read_recording(file("empty.h5")).samples(), 0U);
}

TEST(Recorder, CountsWhatDoesNotFit) {
  DiagramBuilder builder;
  builder.add<Source>("source");
  const auto diagram = builder.build();
  Recorder recorder(*diagram, {"source/sample"}, 5, {}, Every{2ms});
  Simulator simulator(*diagram);
  simulator.record(recorder);
  Context context = diagram->make_context();
  simulator.advance_to(context, 20ms);
  EXPECT_EQ(recorder.samples(), 5U);
  EXPECT_EQ(recorder.dropped(), 5);
}

/// A value whose unit depends on the robot.
struct Push {
  double force = 0.0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("force", "<drive force>", self.force);
  }
};

class Pusher final : public System {
 public:
  OutputPort<Push> push = output<&Pusher::make>("push", clock);

 private:
  Push make(Time) const { return {}; }
};

std::unique_ptr<Diagram> pushing() {
  DiagramBuilder builder;
  builder.add<Pusher>("pusher");
  return builder.build();
}

TEST(Recorder, GivesAQuantityTheUnitOfTheTable) {
  const auto diagram = pushing();
  const Recorder recorder(*diagram, {"pusher/push"}, 5, {{"<drive force>", "N"}, {"<wrench>", "N, N, Nm"}});
  EXPECT_EQ(recorder.recording().signal("pusher/push").layout.fields.at(0).unit, "N");
}

TEST(Recorder, NamesSignalAndQuantityWhoseUnitItWasNotTold) {
  const auto diagram = pushing();
  try {
    const Recorder recorder(*diagram, {"pusher/push"}, 5, {{"<drive fource>", "N"}});
    FAIL() << "a quantity without unit was recorded";
  } catch (const SetupError& error) {
    EXPECT_STREQ(
        error.what(),
        "the field 'force' of the port 'pusher/push' has the unit of the quantity <drive force>, which "
        "is not in the table of units that the recorder was given; did you mean '<drive fource>'?");
  }
}

TEST(Player, IsNotValidBeforeAndAfterTheRecording) {
  Recording recording = record_source(10);
  DiagramBuilder builder;
  auto& player = builder.add<Player<Sample>>("player", recording, "source/sample");
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  context.set_time(50ms);
  diagram->evaluate(context);
  EXPECT_EQ(context.get(player.played).when, Time(0));
  EXPECT_EQ(context.get(player.played).bounded.size(), 0);
}

TEST(Player, RefusesASampleOfImpossibleSize) {
  Recording recording = record_source(10);
  for (Signal& signal : recording.signals) {
    if (signal.path != "source/sample") continue;
    // Before the bounded vector stand five scalars and a vector of three, then its rows and columns.
    const std::size_t rows = 3 * signal.layout.numbers + 8;
    ASSERT_LE(signal.rows[rows].integer, 6);
    ASSERT_EQ(signal.rows[rows + 1].integer, 1);
    signal.rows[rows].integer = 1'000'000;
  }
  EXPECT_THROW(Player<Sample>(recording, "source/sample"), SetupError);
}

TEST(Player, RefusesAnotherTypeThanWasRecorded) {
  const Recording recording = record_source(10);
  EXPECT_THROW(Player<double>(recording, "source/sample"), SetupError);
  EXPECT_THROW(Player<Sample>(recording, "source/simple"), SetupError);
}

}  // namespace
}  // namespace flinch
