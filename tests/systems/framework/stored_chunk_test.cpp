#include "systems/framework/stored_chunk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>

#include "tests/support/problems_of.h"

namespace flinch::internal {
namespace {

/// As the filters shuffle and deflate of HDF5 store numbers.
template <class T>
std::vector<unsigned char> stored(const std::vector<T>& numbers) {
  std::vector<unsigned char> planes(numbers.size() * sizeof(T));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, &numbers[i], sizeof(T));
    for (std::size_t byte = 0; byte < sizeof(T); ++byte) planes[byte * numbers.size() + i] = bytes[byte];
  }
  uLongf size = compressBound(planes.size());
  std::vector<unsigned char> packed(size);
  EXPECT_EQ(compress2(packed.data(), &size, planes.data(), planes.size(), 1), Z_OK);
  packed.resize(size);
  return packed;
}

const std::vector<double> table = {1.5, -2.25, 3e-7, 4e12, -0.0, 6.125, 7.0, 8.0};  // 4 rows of 2

StoredChunk chunk_of(std::vector<unsigned char> packed, std::size_t bytes = 8) {
  return {
      .packed = std::move(packed), .rows = 4, .columns = 2, .bytes_of_number = bytes, .first = 1, .count = 2};
}

TEST(StoredChunk, GivesTheRowsThatAreWanted) {
  std::vector<Number> rows(4);
  chunk_of(stored(table)).unpack(rows.data());
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(rows[i].real, table[2 + i]) << i;
  chunk_of(stored(std::vector<std::uint8_t>{9, 9, 1, 0, 0, 1, 9, 9}), 1).unpack(rows.data());
  EXPECT_EQ(rows[0].integer, 1);
  EXPECT_EQ(rows[1].integer, 0);
  EXPECT_EQ(rows[3].integer, 1);
}

TEST(StoredChunk, IsRefusedWhereItHasNotItsFullSize) {
  std::vector<Number> rows(4);
  const auto complaint = [&rows](const StoredChunk& chunk) {
    return test::problems_of([&] { chunk.unpack(rows.data()); });
  };
  const auto is_refused = ::testing::ElementsAre(::testing::HasSubstr("does not unpack to the 64 bytes"));
  std::vector<double> shorter = table, longer = table;
  shorter.pop_back();
  longer.push_back(9.0);
  EXPECT_THAT(complaint(chunk_of(stored(shorter))), is_refused);
  EXPECT_THAT(complaint(chunk_of(stored(longer))), is_refused);
  std::vector<unsigned char> torn = stored(table);
  torn.resize(torn.size() / 2);
  EXPECT_THAT(complaint(chunk_of(torn)), is_refused);
  EXPECT_THAT(complaint(chunk_of({})), is_refused);
  EXPECT_THAT(complaint(chunk_of({1, 2, 3})), is_refused);
  StoredChunk huge = chunk_of(stored(table));
  huge.rows = 1'000'000'000'000;
  EXPECT_EQ(complaint(huge).size(), 1U) << "no memory is asked for";
}

}  // namespace
}  // namespace flinch::internal
