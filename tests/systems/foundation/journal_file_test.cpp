#include "systems/foundation/journal_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "systems/foundation/setup_error.h"
#include "tests/support/file_bytes.h"
#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(AJournal, KeepsTheOlderOneUntilTheNewOneIsWholeAndGoesOnInThat) {
  const test::TemporaryFolder place;
  const std::filesystem::path file = place.write("journal.part", "old");
  std::ofstream stream;
  begin_journal(file, stream, [&] {
    stream << "begin, ";
    EXPECT_EQ(test::bytes_of(file), "old");
  });
  EXPECT_EQ(test::bytes_of(file), "begin, ");
  stream << "more" << std::flush;
  EXPECT_EQ(test::bytes_of(file), "begin, more");
  EXPECT_FALSE(std::filesystem::exists(place / "journal.part.new"));
}

TEST(AJournal, ThatCannotBeWrittenIsTold) {
  const test::TemporaryFolder place;
  std::ofstream stream;
  EXPECT_THAT(test::problems_of([&] { begin_journal(place / "nowhere/journal.part", stream, [] {}); }),
              ElementsAre(HasSubstr("journal.part: the file cannot be written")));
}

TEST(AJournal, IsReplacedByNothingHalf) {
  const test::TemporaryFolder place;
  const std::filesystem::path file = place.write("journal.part", "old");
  std::ofstream stream;
  EXPECT_EQ(test::problems_of([&] {
              begin_journal(file, stream, [&] { stream.setstate(std::ios::badbit); });
            }).size(),
            1U);
  EXPECT_THROW(begin_journal(file, stream, [] { throw SetupError("no run"); }), SetupError);
  EXPECT_EQ(test::bytes_of(file), "old");
  EXPECT_FALSE(std::filesystem::exists(place / "journal.part.new"));
}

}  // namespace
}  // namespace flinch
