#include "systems/framework/packed_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>

#include "systems/foundation/setup_error.h"

namespace flinch::internal {
namespace {

using Words = std::vector<std::uint64_t>;

/// Rows of `numbers`, one behind the other.
std::string packed(const Words& words, std::size_t numbers) {
  RowPacker packer;
  std::string bytes = "before";
  packer.pack({reinterpret_cast<const char*>(words.data()), numbers, 8 * numbers},
              numbers == 0 ? 0 : words.size() / numbers, bytes);
  return bytes.substr(6);
}

Words unpacked(const std::string& bytes, std::size_t samples, std::size_t numbers) {
  const std::vector<char> rows = unpacked_rows(bytes, samples, numbers);
  Words words(rows.size() / 8);
  if (!rows.empty()) std::memcpy(words.data(), rows.data(), rows.size());
  return words;
}

Words random_words(std::size_t count) {
  std::mt19937_64 random(3);
  Words words(count);
  for (std::uint64_t& word : words) word = random();
  return words;
}

TEST(PackedRows, GiveEveryBitAgain) {
  for (const std::size_t numbers : {1U, 2U, 13U, 60U}) {
    for (const std::size_t samples : {1U, 2U, 7U, 100U, 4096U}) {
      const Words words = random_words(numbers * samples);
      EXPECT_EQ(unpacked(packed(words, numbers), samples, numbers), words) << numbers << " " << samples;
    }
  }
  EXPECT_TRUE(unpacked(packed({}, 3), 0, 3).empty());
}

TEST(PackedRows, AreTakenFromWhereverTheyLie) {
  const Words ring = random_words(40);  // rows of 3 in strides of 5
  RowPacker packer;
  std::string bytes;
  packer.pack({reinterpret_cast<const char*>(ring.data() + 1), 3, 40}, 8, bytes);
  const Words words = unpacked(bytes, 8, 3);
  for (std::size_t k = 0; k < 8; ++k) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(words[3 * k + i], ring[1 + 5 * k + i]);
  }
}

TEST(PackedRows, DoNotDependOnWhatWasPackedBefore) {
  const Words words = random_words(300);
  RowPacker packer;
  std::string bytes;
  for (int i = 0; i < 3; ++i) {
    bytes.clear();
    packer.pack({reinterpret_cast<const char*>(words.data()), 3, 24}, 100, bytes);
    EXPECT_EQ(bytes, packed(words, 3));
  }
}

TEST(PackedRows, TakeLittleRoomWhereLittleChanges) {
  Words words(100 * 20, 0x3ff123456789abcd);
  EXPECT_LT(packed(words, 20).size(), 8 * words.size() / 50);
  for (std::size_t k = 0; k < words.size(); ++k) {
    const double slow = std::sin(1e-3 * static_cast<double>(k / 20));
    std::memcpy(&words[k], &slow, 8);
  }
  EXPECT_LT(packed(words, 20).size(), 8 * words.size());
}

TEST(PackedRows, BelieveNothingThatIsClaimed) {
  const std::string good = packed(random_words(50), 5);
  EXPECT_THROW(unpacked_rows(good, 9, 5), SetupError);
  EXPECT_THROW(unpacked_rows(good, 11, 5), SetupError);
  EXPECT_THROW(unpacked_rows(good, std::size_t{1} << 60, 5), SetupError);
  EXPECT_THROW(unpacked_rows(good, 1 << 30, 1 << 30), SetupError);
  EXPECT_THROW(unpacked_rows(good + "x", 10, 5), SetupError);
  EXPECT_THROW(unpacked_rows("", 1, 1), SetupError);
  for (std::size_t cut = 0; cut < good.size(); ++cut)
    EXPECT_THROW(unpacked_rows(good.substr(0, cut), 10, 5), SetupError) << cut;
}

}  // namespace
}  // namespace flinch::internal
