#include "schema/base/digest.h"

#include <gtest/gtest.h>

namespace milepost {
namespace {

// From Python: hashlib.blake2b(b"abc", digest_size=16).hexdigest()
TEST(Digest, IsBlake2bOf16Bytes) {
  EXPECT_EQ(digest_of(as_bytes("abc")), "cf4ab791c62b8d2b2109c90275287816");
  EXPECT_EQ(digest_of({}), "cae66941d9efbd404e4d88758ea67670");
}

TEST(Digest, KnowsItsForm) {
  EXPECT_TRUE(is_digest("cf4ab791c62b8d2b2109c90275287816"));
  EXPECT_FALSE(is_digest("cf4ab791c62b8d2b2109c9027528781"));
  EXPECT_FALSE(is_digest("cf4ab791c62b8d2b2109c902752878160"));
  EXPECT_FALSE(is_digest("CF4AB791C62B8D2B2109C90275287816"));
  EXPECT_FALSE(is_digest("gf4ab791c62b8d2b2109c90275287816"));
}

// From Python: hashlib.blake2b(struct.pack("<Q2sQd", 2, b"ab", 7, -0.5), digest_size=16)

}  // namespace
}  // namespace milepost
