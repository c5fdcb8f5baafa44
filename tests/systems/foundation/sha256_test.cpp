#include "systems/foundation/sha256.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

// The examples of FIPS 180-4, and one that ends where the length no longer fits into its block.
TEST(Sha256, IsThatOfTheStandard) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, DoesNotDependOnThePieces) {
  Sha256 hash;
  for (const char* const piece : {"abcdbcdecdefdefgefghfghighij", "", "hijkijkljklmklmnlmnomnopnopq"})
    hash.add(piece);
  EXPECT_EQ(hash.digits(), "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(Sha256, OfAFileIsThatOfItsBytes) {
  const test::TemporaryFolder folder;
  const std::string bytes(3'000'000, '\x8f');
  EXPECT_EQ(sha256_of(folder.write("long", bytes)), sha256(bytes));
  EXPECT_EQ(sha256_of(folder / "absent"), sha256(""));
}

}  // namespace
}  // namespace flinch
