#include "base/digest.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace roadbook {
namespace {

TEST(Digest, AgreesWithTheVectorsOfFips180) {
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Digest, PiecesGiveTheDigestOfTheWholeAndHexStartsAfresh) {
  Sha256 digest;
  EXPECT_EQ(digest.update("a").update("bc").hex(), sha256_hex("abc"));
  EXPECT_EQ(digest.update("abc").hex(), sha256_hex("abc"));
  EXPECT_EQ(digest.update(std::uint64_t{0x6362616164636261}).hex(), sha256_hex("abcdaabc"));
}

TEST(Digest, AFileThatIsNotThereIsAStorageError) {
  EXPECT_THROW((void)sha256_file_hex("/no/such/file"), StorageError);
}

}  // namespace
}  // namespace roadbook
