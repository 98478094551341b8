#include "schema/document/signature.h"

#include <gmock/gmock.h>

namespace milepost {
namespace {

using ::testing::HasSubstr;

const SecretKey kKey(SecretKey::Seed{1, 2, 3});
const SecretKey kOtherKey(SecretKey::Seed{1, 2, 4});
const SignedBuild kTown{"town", "0f6b0f6b0f6b0f6b0f6b0f6b0f6b0f6b", 1796112000};

std::string town_signature() { return signature_text(kTown, kKey); }

// The text with the first `from` replaced.
std::string with(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

bool is_signed_by(const std::string& text, const SecretKey& key) {
  const auto signature = signature_from(text);
  return signature.ok() && signature->is_by(key.public_key());
}

TEST(SignatureTest, TellsWhatWasSignedByWhom) {
  const auto signature = signature_from(town_signature());
  ASSERT_TRUE(signature.ok()) << signature.error().line();
  EXPECT_EQ(signature->about.map, "town");
  EXPECT_EQ(signature->about.build, kTown.build);
  EXPECT_EQ(signature->about.signed_s, 1796112000);
  EXPECT_EQ(signature->key, kKey.public_key().id());
  EXPECT_TRUE(signature->is_by(kKey.public_key()));
  EXPECT_LE(signature_text({std::string(64, 'm'), kTown.build, 999999999999}, kKey).size(),
            kMaxSignatureBytes);
}

TEST(SignatureTest, IsByNoOtherKey) { EXPECT_FALSE(is_signed_by(town_signature(), kOtherKey)); }

TEST(SignatureTest, OfAnotherKeyIsNotOursByItsName) {
  const std::string forged =
      with(signature_text(kTown, kOtherKey), kOtherKey.public_key().id(), kKey.public_key().id());
  EXPECT_TRUE(signature_from(forged).ok());
  EXPECT_FALSE(is_signed_by(forged, kKey));
}

TEST(SignatureTest, HoldsForNoOtherNameBuildOrTime) {
  for (const auto& [from, to] :
       {std::pair("map town", "map tows"), std::pair("build 0f", "build 1f"),
        std::pair("signed_s 1796112000", "signed_s 1796112001")}) {
    const std::string changed = with(town_signature(), from, to);
    EXPECT_TRUE(signature_from(changed).ok());
    EXPECT_FALSE(is_signed_by(changed, kKey)) << changed;
  }
}

TEST(SignatureTest, EveryChangedBitIsNoticed) {
  const std::string whole = town_signature();
  ASSERT_TRUE(is_signed_by(whole, kKey));
  for (std::size_t at = 0; at < 8 * whole.size(); ++at) {
    std::string changed = whole;
    changed[at / 8] = static_cast<char>(changed[at / 8] ^ (1 << at % 8));
    EXPECT_FALSE(is_signed_by(changed, kKey)) << at;
  }
}

TEST(SignatureTest, EveryTruncationIsAnErrorAndSoIsMore) {
  const std::string whole = town_signature();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_FALSE(signature_from(whole.substr(0, length)).ok()) << length;
  }
  EXPECT_THAT(signature_from(whole + "\n").error().line(), HasSubstr("something follows"));
}

TEST(SignatureTest, OnlyTheWrittenFormIsRead) {
  for (const auto& [from, to] :
       {std::pair("signed_s 17", "signed_s 017"), std::pair("signed_s 17", "signed_s -7"),
        std::pair("signed_s 17", "signed_s 17179"), std::pair("map town", "map .town"),
        std::pair("map town", "map  town"), std::pair("build 0f", "build 0F"),
        std::pair("\nbuild", "\r\nbuild"), std::pair("\nkey", "\nmap village\nkey")}) {
    EXPECT_FALSE(signature_from(with(town_signature(), from, to)).ok()) << from << " " << to;
  }
}

TEST(SigningKeyTest, ItsTextsAreReadAgain) {
  const auto secret = secret_key_from(kKey.text());
  ASSERT_TRUE(secret.ok()) << secret.error().line();
  EXPECT_EQ(secret->public_key().bytes, kKey.public_key().bytes);
  const auto open = public_key_from(kKey.public_key().text());
  ASSERT_TRUE(open.ok()) << open.error().line();
  EXPECT_EQ(open->id(), kKey.public_key().id());
}

TEST(SigningKeyTest, OneIsNotTakenForTheOther) {
  EXPECT_THAT(public_key_from(kKey.text()).error().line(), HasSubstr("KEY.pub"));
  EXPECT_FALSE(secret_key_from(kKey.public_key().text()).ok());
  EXPECT_FALSE(public_key_from("").ok());
  EXPECT_FALSE(public_key_from("milepost-public-key-1 00").ok());
}

TEST(SigningKeyTest, EachGeneratedOneIsAnother) {
  const auto first = SecretKey::generate();
  const auto second = SecretKey::generate();
  ASSERT_TRUE(first.ok() && second.ok());
  EXPECT_NE(first->public_key().id(), second->public_key().id());
}

// RFC 8032, section 7.1, test 1: the public key of a seed.
TEST(SigningKeyTest, IsEd25519) {
  const auto key = secret_key_from(
      "milepost-secret-key-1 9d61b19deffd5a60ba844af492ec2cc44449c5697b326919703bac031cae7f60");
  ASSERT_TRUE(key.ok());
  EXPECT_EQ(key->public_key().text(),
            "milepost-public-key-1 "
            "d75a980182b10ab7d54bfed3c964073a0ee172f3daa62325af021a68f707511a\n");
}

}  // namespace
}  // namespace milepost
