#include "systems/framework/hdf5_format.h"

#include <gtest/gtest.h>

#include "systems/framework/table_file.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

TEST(Hdf5Format, IsWhatTheFileSays) {
  const test::TemporaryFolder folder;
  write_table({}, 0, {}, {{"format", "a table"}}, folder / "table.h5");
  EXPECT_EQ(hdf5_format(folder / "table.h5"), "a table");
}

TEST(Hdf5Format, IsEmptyWhereNothingIsSaid) {
  const test::TemporaryFolder folder;
  write_table({}, 0, {}, {}, folder / "table.h5");
  EXPECT_EQ(hdf5_format(folder / "table.h5"), "");
  EXPECT_EQ(hdf5_format(folder.write("text.h5", "format: a table")), "");
  EXPECT_EQ(hdf5_format(folder / "none.h5"), "");
}

}  // namespace
}  // namespace flinch
