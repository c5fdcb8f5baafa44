#include "apps/flinch/shell_completion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>

#include "tests/apps/flinch/program.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

using test::flinch;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// What bash offers for a line whose last word is being typed; nothing where there is no bash.
std::string offered(const std::string& line) {
  const test::TemporaryFolder folder;
  const auto script = folder.write("flinch", flinch({"completion", "bash"}).out);
  const auto asking = folder.write("ask", "source " + script.string() + "\nCOMP_WORDS=(" + line +
                                              ")\nCOMP_CWORD=$((${#COMP_WORDS[@]}-1))\n_flinch\n"
                                              "printf '%s\\n' \"${COMPREPLY[@]}\"\n");
  std::FILE* const pipe = ::popen(("bash " + asking.string() + " 2>&1").c_str(), "r");
  std::string said;
  std::array<char, 256> piece{};
  while (std::fgets(piece.data(), piece.size(), pipe) != nullptr) said += piece.data();
  ::pclose(pipe);
  return said;
}

TEST(BashCompletion, OffersVerbsThenTheirOptions) {
  EXPECT_THAT(offered("flinch ''"),
              AllOf(HasSubstr("run\n"), HasSubstr("reproduce\n"), HasSubstr("--version\n")));
  EXPECT_EQ(offered("flinch rep"), "report\nreproduce\n");
  EXPECT_THAT(offered("flinch run --s"),
              AllOf(HasSubstr("--set\n"), HasSubstr("--seed\n"), Not(HasSubstr("--align"))));
  EXPECT_THAT(offered("flinch run a.yaml --al"), Not(HasSubstr("--align")));
  EXPECT_EQ(offered("flinch compare --al"), "--align\n");
}

TEST(BashCompletion, KnowsVerbsOfVerbs) {
  EXPECT_THAT(offered("flinch calibrate th"), HasSubstr("thresholds\n"));
  EXPECT_THAT(offered("flinch calibrate thresholds --ra"), HasSubstr("--rate\n"));
}

TEST(Completion, IsThereForTheShellsThatThereAre) {
  for (const std::string& shell : completed_shells())
    EXPECT_THAT(flinch({"completion", shell}).out, HasSubstr("reproduce")) << shell;
  const auto wrong = flinch({"completion", "fsh"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean 'fish'?"));
}

TEST(FishCompletion, TellsWhatEachVerbDoes) {
  EXPECT_THAT(flinch({"completion", "fish"}).out,
              HasSubstr("complete -c flinch -n __fish_use_subcommand -a compare -d "));
}

}  // namespace
}  // namespace flinch
