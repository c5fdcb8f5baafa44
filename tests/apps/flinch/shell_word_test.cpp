#include "apps/flinch/shell_word.h"

#include <gtest/gtest.h>

namespace flinch {
namespace {

TEST(AWordForAShell, IsQuotedWhereItWouldBeAnother) {
  EXPECT_EQ(shell_word("control.limits.keep=always"), "control.limits.keep=always");
  EXPECT_EQ(shell_word("../out/run-1.h5"), "../out/run-1.h5");
  EXPECT_EQ(shell_word("gain=[20, 20]"), "'gain=[20, 20]'");
  EXPECT_EQ(shell_word("my robot"), "'my robot'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word("$HOME;ls"), "'$HOME;ls'");
  EXPECT_EQ(shell_word(""), "''");
}

}  // namespace
}  // namespace flinch
