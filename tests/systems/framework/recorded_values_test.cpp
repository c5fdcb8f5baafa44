#include "systems/framework/recorded_values.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

#include "systems/foundation/setup_error.h"
#include "systems/framework/recorder.h"
#include "systems/framework/simulator.h"
#include "tests/support/temporary_folder.h"
#include "tests/systems/framework/random_source.h"

namespace flinch {
namespace {

using test::Sample;

Recording recorded(int ticks) {
  const auto diagram = test::random_source();
  Recorder recorder(*diagram, recordable_paths(*diagram), static_cast<std::size_t>(ticks));
  Simulator simulator(*diagram);
  simulator.record(recorder);
  Context context = diagram->make_context();
  simulator.advance_to(context, ticks * Time(1ms));
  return recorder.recording();
}

std::vector<internal::Number> row_of(const Sample& sample) {
  std::vector<internal::Number> row(row_layout<Sample>().numbers);
  write_row(sample, row.data());
  return row;
}

TEST(RecordedValues, AreThoseOfTheRowsBitForBitFromMemoryAndFromAFile) {
  const Recording memory = recorded(10'000);
  const test::TemporaryFolder folder;
  const std::filesystem::path place = folder / "values.h5";
  write_recording(memory, place);
  const Recording file = open_recording(place);
  EXPECT_TRUE(file.signal("source/sample").rows.empty()) << "a file is not read before it is asked";
  const auto from_memory = read<Sample>(memory, "source/sample"),
             from_file = read<Sample>(file, "source/sample");
  ASSERT_EQ(from_file.size(), 10'000U);
  const internal::Number* row = memory.signal("source/sample").rows.data();
  for (std::size_t k = 0; k < from_file.size(); ++k) {
    const auto one = row_of(from_memory[k]), two = row_of(from_file[k]);
    ASSERT_EQ(std::memcmp(one.data(), row, 8 * one.size()), 0) << k;
    ASSERT_EQ(std::memcmp(two.data(), row, 8 * two.size()), 0) << k;
    row += one.size();
  }
  for (const std::size_t k : {9999U, 0U, 4096U, 4095U, 8191U}) {  // in any order
    EXPECT_EQ(from_file[k].when, Time(memory.time_ns[k]));
  }
  EXPECT_EQ(file.column("source/sample", "pair.1"), memory.column("source/sample", "pair.1"));
  std::filesystem::remove(place);
}

TEST(RecordedValues, RefuseAnotherTypeThanWasRecordedAndSignalsThatAreNotThere) {
  const Recording recording = recorded(3);
  EXPECT_THROW(read<double>(recording, "source/sample"), SetupError);
  EXPECT_THROW(read<Sample>(recording, "source/simple"), SetupError);
}

TEST(RecordedValues, RefuseASampleOfImpossibleSize) {
  Recording recording = recorded(3);
  for (Signal& signal : recording.signals) {
    if (signal.path != "source/sample") continue;
    signal.rows[signal.layout.numbers + 8].integer = 1'000'000;  // the bounded vector of the second sample
  }
  const auto values = read<Sample>(recording, "source/sample");
  EXPECT_EQ(values[0].when, Time(0));
  EXPECT_THROW(values[1], SetupError);
}

}  // namespace
}  // namespace flinch
