// Results on a disk that is really full: a small file system of its own, with room for everything that is
// there and a little more, from nothing to enough.
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/statvfs.h>

#include <filesystem>
#include <iostream>
#include <optional>

#include "tests/campaign/interrupted/verb_results.h"
#include "tests/support/flinch_program.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

namespace fs = std::filesystem;
using test::InterruptedVerb;
using test::OtherProgram;
using test::VerbResults;

constexpr std::size_t plenty = 256 << 20;

/// Mounts nothing that others see.
class SmallDisk : public testing::Test {
 protected:
  void SetUp() override {
    is_mounted_ = ::unshare(CLONE_NEWNS) == 0 &&
                  ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 && mount(plenty, 0);
    if (!is_mounted_) GTEST_SKIP() << "a small disk needs the right to mount file systems";
    results_.emplace(folder_ / "out");
  }
  void TearDown() override {
    results_.reset();
    if (is_mounted_) ::umount(folder_.path().c_str());
  }

  bool mount(std::size_t size, unsigned long flags) const {
    return ::mount("flinch", folder_.path().c_str(), "tmpfs", flags,
                   ("size=" + std::to_string(size)).c_str()) == 0;
  }
  /// Leaves so many bytes free.
  void leave(std::size_t bytes) const {
    ASSERT_TRUE(mount(plenty, MS_REMOUNT));
    struct statvfs now {};
    ASSERT_EQ(::statvfs(folder_.path().c_str(), &now), 0);
    ASSERT_TRUE(mount((now.f_blocks - now.f_bfree) * now.f_frsize + bytes, MS_REMOUNT));
  }

  /// The exit status of the verb where only so many bytes are free, and what it said.
  std::pair<int, std::string> on_a_full_disk(const InterruptedVerb& verb, std::size_t bytes) {
    leave(bytes);
    OtherProgram program(test::flinch_program(verb.newer));
    const std::optional<int> status = program.wait(100s);
    return {status.value_or(-1), program.output()};
  }

  void fill(const InterruptedVerb& verb) {
    results_->make_both(verb);
    int refused = 0, written = 0;
    for (std::size_t bytes = 0; written < 3 && bytes < plenty && !HasFailure();) {
      const auto [status, said] = on_a_full_disk(verb, bytes);
      if (status != 0) {
        EXPECT_EQ(status, 2) << said;
        EXPECT_NE(said.find("No space left on device"), std::string::npos) << said;
      }
      (status == 0 ? written : refused) += 1;
      results_->expect_one_of_both();
      ASSERT_TRUE(mount(plenty, MS_REMOUNT));
      results_->make_older(verb);
      bytes = bytes < 64'000 ? bytes + 16'000 : bytes + bytes / 4;
    }
    std::cout << refused << " sizes too small, " << written << " large enough" << std::endl;
    EXPECT_GT(refused, 0);
    EXPECT_EQ(written, 3);
  }

  const test::TemporaryFolder folder_;
  bool is_mounted_ = false;
  std::optional<VerbResults> results_;
};

TEST_F(SmallDisk, KeepsTheOlderRecordingOrHasTheNewOne) { fill(results_->run()); }
TEST_F(SmallDisk, KeepsTheOlderTableOrHasTheNewOne) { fill(results_->campaign()); }
TEST_F(SmallDisk, KeepsTheOlderThresholdsOrHasTheNewOnes) { fill(results_->calibrate()); }

TEST_F(SmallDisk, ThatMayOnlyBeReadIsToldBeforeAnythingIsComputed) {
  for (const InterruptedVerb& verb : {results_->run(), results_->campaign(), results_->calibrate()}) {
    ASSERT_TRUE(mount(plenty, MS_REMOUNT));
    for (const auto& [name, bytes] : results_->files()) fs::remove(results_->file(name));
    results_->make_both(verb);
    const test::Files before = results_->files();
    ASSERT_TRUE(mount(plenty, MS_REMOUNT | MS_RDONLY));
    OtherProgram program(test::flinch_program(verb.newer));
    EXPECT_EQ(program.wait(100s), 2);
    EXPECT_NE(program.output().find("Read-only file system"), std::string::npos) << program.output();
    EXPECT_EQ(results_->files(), before);
  }
}

}  // namespace
}  // namespace flinch
