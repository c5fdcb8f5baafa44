#include "systems/foundation/bytes_of_file.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

TEST(BytesOfFile, AreAllOfThemWhateverTheyAre) {
  const test::TemporaryFolder folder;
  const std::string bytes("a\0b\r\n\xff", 6);
  EXPECT_EQ(bytes_of_file(folder.write("a", bytes)), bytes);
}

TEST(BytesOfFile, AreNoneOfAFileThatIsNotThere) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(bytes_of_file(folder.path() / "a"), "");
}

}  // namespace
}  // namespace flinch
