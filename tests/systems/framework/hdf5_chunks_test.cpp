// Chunks of HDF5 files that do not hold what they should: HDF5 copies whole chunks from what it unpacked.
#include "systems/framework/hdf5_chunks.h"

#include <gmock/gmock.h>
#include <hdf5.h>
#include <zlib.h>

#include "systems/framework/foreign_hdf5.h"
#include "systems/framework/recording.h"
#include "tests/systems/framework/honest_recording.h"
#include "tests/systems/framework/refusal.h"

namespace flinch {
namespace {

using test::refusal;
using test::TemporaryFile;
using testing::HasSubstr;

constexpr std::size_t chunk_bytes = test::honest_samples * 3 * sizeof(double);
constexpr unsigned all_filters_skipped = 3;  // shuffling, then deflating

std::vector<unsigned char> deflated(std::size_t size) {
  const std::vector<unsigned char> plain(size, 7);
  uLongf length = compressBound(size);
  std::vector<unsigned char> packed(length);
  EXPECT_EQ(compress(packed.data(), &length, plain.data(), size), Z_OK);
  packed.resize(length);
  return packed;
}

/// What is wrong with a recording whose positions are stored in a chunk of these bytes.
std::string refusal_of(const std::vector<unsigned char>& bytes, unsigned skipped) {
  const TemporaryFile file;
  write_recording(test::honest_recording(), file.path());
  const hid_t open = H5Fopen(file.path().c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t set = H5Dopen2(open, "bench/state/position", H5P_DEFAULT);
  const hsize_t origin[2] = {0, 0};
  EXPECT_GE(H5Dwrite_chunk(set, H5P_DEFAULT, skipped, origin, bytes.size(), bytes.data()), 0);
  H5Dclose(set);
  H5Fclose(open);
  return refusal(file.path());
}

TEST(AChunk, IsReadWhereItHasAllItsBytes) {
  EXPECT_EQ(refusal_of(deflated(chunk_bytes), 0), "");
  EXPECT_EQ(refusal_of(std::vector<unsigned char>(chunk_bytes), all_filters_skipped), "");
}

TEST(AChunk, ThatIsNotPackedMustHaveAllItsBytes) {
  for (const std::size_t bytes : {std::size_t{1}, std::size_t{34}, chunk_bytes - 1, chunk_bytes + 1})
    EXPECT_THAT(refusal_of(std::vector<unsigned char>(bytes), all_filters_skipped),
                HasSubstr("does not unpack to the 1200 bytes"));
}

TEST(AChunk, ThatIsPackedMustUnpackToAllItsBytes) {
  for (const std::size_t bytes :
       {std::size_t{0}, std::size_t{100}, chunk_bytes - 1, chunk_bytes + 1, std::size_t{100'000'000}})
    EXPECT_THAT(refusal_of(deflated(bytes), 0), HasSubstr("does not unpack to the 1200 bytes")) << bytes;
  std::vector<unsigned char> torn = deflated(chunk_bytes);
  torn.resize(torn.size() / 2);
  EXPECT_THAT(refusal_of(torn, 0), HasSubstr("does not unpack"));
  EXPECT_THAT(refusal_of(std::vector<unsigned char>(500, 0xff), 0), HasSubstr("does not unpack"));
}

/// A table of another tool, whose filters `pack` chooses.
std::string refusal_of_table(void (*pack)(hid_t creation), const std::vector<double>& numbers) {
  const TemporaryFile file;
  const hid_t open = H5Fcreate(file.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  const hsize_t size = numbers.size(), chunk = 100;
  H5Pset_chunk(creation, 1, &chunk);
  pack(creation);
  const hid_t space = H5Screate_simple(1, &size, nullptr);
  const hid_t set = H5Dcreate2(open, "log", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, creation, H5P_DEFAULT);
  H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
  H5Dclose(set);
  H5Sclose(space);
  H5Pclose(creation);
  std::string why;
  try {
    EXPECT_EQ(internal::read_foreign_table(open, "log").numbers, numbers);
  } catch (const SetupError& error) {
    why = error.what();
  }
  H5Fclose(open);
  return why;
}

TEST(AForeignTable, MayBePackedInEachUsualWay) {
  std::vector<double> numbers(1234);
  for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] = 0.1 * static_cast<double>(k * k % 97);
  const auto nothing = [](hid_t) {};
  const auto deflate = [](hid_t list) { H5Pset_deflate(list, 6); };
  const auto both = [](hid_t list) {
    H5Pset_shuffle(list);
    H5Pset_deflate(list, 1);
  };
  const auto checked_before = [](hid_t list) {
    H5Pset_fletcher32(list);
    H5Pset_shuffle(list);
    H5Pset_deflate(list, 1);
  };
  const auto checked_after = [](hid_t list) {
    H5Pset_shuffle(list);
    H5Pset_deflate(list, 1);
    H5Pset_fletcher32(list);
  };
  const auto checked = [](hid_t list) { H5Pset_fletcher32(list); };
  for (void (*const pack)(hid_t) :
       std::initializer_list<void (*)(hid_t)>{nothing, deflate, both, checked_before, checked_after, checked})
    EXPECT_EQ(refusal_of_table(pack, numbers), "");
}

TEST(AForeignTable, MayNotBePackedInAnOrderThatNobodyChecks) {
  const auto shuffled_after = [](hid_t list) {
    H5Pset_deflate(list, 1);
    H5Pset_shuffle(list);
  };
  EXPECT_THAT(refusal_of_table(shuffled_after, std::vector<double>(500)),
              HasSubstr("is packed again after it was deflated"));
}

}  // namespace
}  // namespace flinch
