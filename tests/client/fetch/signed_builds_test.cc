// With keys, the client uses builds that they have signed and no others.
#include "client/fetch/signed_builds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/client/fetch/misbehaving_server.h"

namespace milepost::testing {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const SecretKey kOperator(SecretKey::Seed{1});
const SecretKey kSomeone(SecretKey::Seed{2});
constexpr std::int64_t kMonday_s = 1796000000;
constexpr std::int64_t kTuesday_s = kMonday_s + 86400;

bool is_of_build(const std::string& target) { return target.find("/builds/") != std::string::npos; }
bool is_signature(const std::string& target) { return target.ends_with("/manifest.sig"); }

class SignedBuildsTest : public MisbehavingServerTest {
 protected:
  SignedBuildsTest() { keys_ = {kOperator.public_key()}; }

  std::string signature_by(const SecretKey& key, std::int64_t signed_s = kMonday_s) const {
    return signature_text({"town", map_.build(), signed_s}, key);
  }

  Status tiles_of(MapSource& source, const MapVersion& version) const {
    const auto tiles = source.tiles(version, "s1", "tracklets", {30, 90});
    return tiles ? ok_status() : Status(tiles.error());
  }
  Status tiles_come() { return tiles_of(*open_source(), map_.version()); }

  void expect_refused(const std::string& signature, const std::string& what) {
    map_.signature = signature;
    const Status refused = tiles_come();
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::corrupt);
    EXPECT_THAT(refused.error().line(), HasSubstr(what));
    EXPECT_THAT(refused.error().line(), HasSubstr("/manifest.sig"));
    // Nothing of it was even requested.
    EXPECT_THAT(requests(is_of_build), Each(HasSubstr("/manifest.sig")));
    const std::size_t before = requests(is_of_build).size();
    EXPECT_EQ(before, 2U);  // the second past caches
    EXPECT_THAT(pauses_s_, IsEmpty());
  }

  // The same map with another tile: another build.
  void build_anew() { map_.index.front().items += 1; }
};

TEST_F(SignedBuildsTest, ASignedBuildIsUsed) {
  map_.signature = signature_by(kOperator);
  EXPECT_TRUE(tiles_come().ok());
  EXPECT_THAT(requests(is_signature), SizeIs(1));
  EXPECT_TRUE(is_signature(requests(is_of_build).front()));
  EXPECT_TRUE(tiles_come().ok());
  EXPECT_THAT(requests(is_signature), SizeIs(1));  // the second time it came from the cache
}

TEST_F(SignedBuildsTest, AnyOfSeveralKeysWillDo) {
  map_.signature = signature_by(kOperator);
  keys_ = {kSomeone.public_key(), kOperator.public_key()};
  EXPECT_TRUE(tiles_come().ok());
}

TEST_F(SignedBuildsTest, WithoutKeysNoSignatureIsAskedFor) {
  keys_.clear();
  map_.signature = signature_by(kSomeone);
  EXPECT_TRUE(tiles_come().ok());
  EXPECT_THAT(requests(is_signature), IsEmpty());
}

TEST_F(SignedBuildsTest, AnotherKeyIsRefused) {
  expect_refused(signature_by(kSomeone), "names key " + kSomeone.public_key().id());
}

TEST_F(SignedBuildsTest, AnotherMapsSignatureIsRefused) {
  expect_refused(signature_text({"village", map_.build(), kMonday_s}, kOperator), "'village'");
}

TEST_F(SignedBuildsTest, AnotherBuildsSignatureIsRefused) {
  expect_refused(signature_text({"town", std::string(32, '0'), kMonday_s}, kOperator),
                 "one of build 0000");
}

TEST_F(SignedBuildsTest, ATruncatedSignatureIsRefused) {
  const std::string whole = signature_by(kOperator);
  expect_refused(whole.substr(0, whole.size() - 2), "is truncated");
}

TEST_F(SignedBuildsTest, AnotherTextIsRefused) { expect_refused("hello", "does not begin"); }

TEST_F(SignedBuildsTest, ATooLongTextIsRefused) {
  expect_refused(signature_by(kOperator) + std::string(1000, ' '), "this is no signature");
}

TEST_F(SignedBuildsTest, AnUnsignedBuildIsRefused) { expect_refused("", "is not signed"); }

TEST_F(SignedBuildsTest, DamageInACacheOnTheWayIsMended) {
  map_.signature = signature_by(kOperator);
  std::string damaged = map_.signature;
  damaged[damaged.size() - 5] ^= 1;
  answer_next("manifest.sig", {{.body = damaged}});
  EXPECT_TRUE(tiles_come().ok());
  EXPECT_THAT(requests(is_signature), SizeIs(2));
  EXPECT_THAT(pauses_s_, IsEmpty());
}

TEST_F(SignedBuildsTest, ABusyServerIsAskedAgain) {
  map_.signature = signature_by(kOperator);
  answer_next("manifest.sig", {{.status = 503}});
  EXPECT_TRUE(tiles_come().ok());
  EXPECT_THAT(pauses_s_, SizeIs(1));
}

TEST_F(SignedBuildsTest, ACachedMapIsRefusedOnceThereIsAKey) {
  keys_.clear();
  EXPECT_TRUE(tiles_come().ok());
  EXPECT_TRUE(open_source()->describe(map_.version()).ok());
  keys_ = {kOperator.public_key()};
  const std::size_t before = requests(is_of_build).size();
  EXPECT_EQ(tiles_come().error().code, ErrorCode::corrupt);
  EXPECT_EQ(requests(is_of_build).size(), before + 2);  // for the signature, twice
  // Without a server the cache knows no map that may be used, ...
  server_.stop();
  const auto source = open_source();
  EXPECT_EQ(source->maps().error().code, ErrorCode::unavailable);
  EXPECT_FALSE(source->segments_near({49.0009, 8.4, 0}, 50).ok());
  EXPECT_EQ(tiles_come().error().code, ErrorCode::unavailable);
  // ... but without a key it does.
  keys_.clear();
  EXPECT_THAT(*open_source()->maps(), ElementsAre(map_.version()));
}

TEST_F(SignedBuildsTest, ACachedMapIsAcceptedBySignatureWithoutBeingFetchedAgain) {
  keys_.clear();
  EXPECT_TRUE(tiles_come().ok());
  const std::size_t before = requests(is_of_build).size();
  keys_ = {kOperator.public_key()};
  map_.signature = signature_by(kOperator);
  EXPECT_TRUE(tiles_come().ok());
  EXPECT_EQ(requests(is_of_build).size(), before + 1);
}

TEST_F(SignedBuildsTest, ASignedMapInTheCacheNeedsNoServer) {
  map_.signature = signature_by(kOperator);
  EXPECT_TRUE(tiles_come().ok());
  EXPECT_TRUE(open_source()->describe(map_.version()).ok());
  server_.stop();
  const auto source = open_source();
  EXPECT_THAT(*source->maps(), ElementsAre(map_.version()));
  EXPECT_EQ(source->segments_near({49.0009, 8.4, 0}, 50)->size(), 1U);
  EXPECT_TRUE(tiles_of(*source, map_.version()).ok());
}

TEST_F(SignedBuildsTest, AfterAChangeOfKeysTheNewSignatureIsFetched) {
  map_.signature = signature_by(kSomeone);
  keys_ = {kSomeone.public_key()};
  EXPECT_TRUE(tiles_come().ok());
  keys_ = {kOperator.public_key()};
  map_.signature = signature_by(kOperator, kTuesday_s);
  EXPECT_TRUE(tiles_come().ok());
  EXPECT_TRUE(tiles_come().ok());
  EXPECT_THAT(requests(is_signature), SizeIs(2));
}

TEST_F(SignedBuildsTest, ABuildThatWasSignedEarlierDoesNotComeBack) {
  const MapVersion old_version = map_.version();
  map_.signature = signature_by(kOperator, kMonday_s);
  const std::string old_signature = map_.signature;
  const auto source = open_source();
  EXPECT_TRUE(tiles_of(*source, old_version).ok());
  build_anew();
  map_.signature = signature_by(kOperator, kTuesday_s);
  EXPECT_TRUE(tiles_of(*source, map_.version()).ok());
  // Who drives by the old one may go on until it is replaced, ...
  EXPECT_TRUE(tiles_of(*source, old_version).ok());
  // ... but nobody starts with it, neither from the cache nor from a server that goes back.
  map_ = FakeMap();
  map_.signature = old_signature;
  const Status refused = tiles_come();
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::gone);
  EXPECT_THAT(refused.error().line(), HasSubstr("signed later"));
  // Unless it is signed again.
  map_.signature = signature_by(kOperator, kTuesday_s + 1);
  EXPECT_TRUE(tiles_come().ok());
}

TEST_F(SignedBuildsTest, AnEarlierSignatureOfAServerIsRefusedWithoutTheOldMapInTheCache) {
  const MapVersion old_version = map_.version();
  build_anew();
  map_.signature = signature_by(kOperator, kTuesday_s);
  EXPECT_TRUE(tiles_come().ok());
  map_ = FakeMap();
  map_.signature = signature_by(kOperator, kMonday_s);
  EXPECT_EQ(tiles_of(*open_source(), old_version).error().code, ErrorCode::gone);
  EXPECT_THAT(requests(is_of_build).back(), HasSubstr(old_version.build + "/manifest.sig"));
}

}  // namespace
}  // namespace milepost::testing
