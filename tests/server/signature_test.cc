// The signature beside a map: what the server sends, and that it is no map.
#include "schema/document/signature.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <fstream>

#include "schema/base/digest.h"
#include "server/catalog/kept_builds.h"
#include "server/catalog/signature_file.h"
#include "server/message/conditional.h"
#include "server/routes/handle.h"
#include "tests/server/responses.h"
#include "tests/server/test_map.h"

namespace milepost::server {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

class ServedSignatureTest : public ::testing::Test {
 protected:
  Response get() const {
    return handle({"GET", "/v1/maps/town/builds/" + town_.build + "/manifest.sig", ""},
                  *open_catalog(folder_.path()));
  }
  void put(const std::string& text) const {
    std::ofstream(folder_.path() / "town.map.sig", std::ios::binary) << text;
  }
  std::string signature_of(const std::string& map, const std::string& build) const {
    return signature_text({map, build, 1796000000}, SecretKey(SecretKey::Seed{1}));
  }

  TemporaryFolder folder_;
  TownMap town_ = write_town(folder_.path() / "town.map");
};

TEST_F(ServedSignatureTest, IsSentAsItIs) {
  const std::string signature = signature_of("town", town_.build);
  put(signature);
  const Response response = get();
  EXPECT_EQ(response.status, 200U);
  EXPECT_EQ(text_of(response), signature);
  EXPECT_EQ(response.header("Content-Type"), "text/plain; charset=utf-8");
  EXPECT_EQ(response.header("Cache-Control"), "no-cache");
  EXPECT_EQ(response.header("ETag"), entity_tag(digest_of(as_bytes(signature))));
}

TEST_F(ServedSignatureTest, AMapIsSignedAndSignedAgainWhileItIsServed) {
  const auto catalog = open_catalog(folder_.path());
  const std::string target = "/v1/maps/town/builds/" + town_.build + "/manifest.sig";
  EXPECT_EQ(problem_status(handle({"GET", target, ""}, *catalog)), 404U);
  put(signature_of("town", town_.build));
  const Response first = handle({"GET", target, ""}, *catalog);
  EXPECT_EQ(first.status, 200U);
  const std::string tag(first.header("ETag"));
  EXPECT_EQ(handle({"GET", target, tag}, *catalog).status, 304U);
  put(signature_text({"town", town_.build, 1796000001}, SecretKey(SecretKey::Seed{1})));
  EXPECT_EQ(handle({"GET", target, tag}, *catalog).status, 200U);
}

TEST_F(ServedSignatureTest, OfAnotherBuildOrNameIsAbsent) {
  put(signature_of("town", std::string(32, '0')));
  EXPECT_EQ(problem_status(get()), 404U);
  EXPECT_THAT(detail_of(get()), HasSubstr("that of build 0000"));
  put(signature_of("village", town_.build));
  EXPECT_EQ(problem_status(get()), 404U);
  EXPECT_THAT(detail_of(get()), HasSubstr("map village"));
}

TEST_F(ServedSignatureTest, ADamagedOneIsAFailureOfTheServer) {
  for (const std::string& text :
       {std::string(), signature_of("town", town_.build).substr(0, 200), std::string(10000, 'x')}) {
    put(text);
    EXPECT_EQ(problem_status(get()), 500U);
    EXPECT_THAT(detail_of(get()), HasSubstr("town.map.sig"));
  }
}

TEST_F(ServedSignatureTest, AFifoOrAFolderIsAFailureThatBlocksNobody) {
  const auto file = folder_.path() / "town.map.sig";
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  EXPECT_EQ(problem_status(get()), 500U);
  std::filesystem::remove(file);
  std::filesystem::create_directory(file);
  EXPECT_EQ(problem_status(get()), 500U);
}

class ReplacedBuildTest : public ServedSignatureTest {
 protected:
  std::string signature_of_first() const {
    const Response response =
        handle({"GET", "/v1/maps/town/builds/" + town_.build + "/manifest.sig", ""}, *catalog_);
    return response.status == 200 ? text_of(response) : std::to_string(response.status);
  }
  void reload(const DirectoryChanges& changes) {
    catalog_ = *catalog_->reloaded(
        Catalog::Clock::now(), [](const std::string& /*line*/) {}, changes);
  }
  // Another build takes the map's place, signed or not.
  void replace(bool is_signed) {
    const TownMap next = write_town(folder_.path() / "next", 100, 2);
    if (is_signed) put(signature_of("town", next.build));
    std::filesystem::rename(folder_.path() / "next", folder_.path() / "town.map");
  }

  std::shared_ptr<const Catalog> catalog_;
};

TEST_F(ReplacedBuildTest, KeepsItsSignatureThatWasThereAtTheStart) {
  put(signature_of("town", town_.build));
  catalog_ = open_catalog(folder_.path());
  replace(true);
  EXPECT_EQ(signature_of_first(), signature_of("town", town_.build));  // not yet taken up
  reload({{}, true});
  EXPECT_EQ(catalog_->old_builds().count("town"), 1U);
  EXPECT_EQ(signature_of_first(), signature_of("town", town_.build));
  std::filesystem::remove(folder_.path() / "town.map.sig");
  EXPECT_EQ(signature_of_first(), signature_of("town", town_.build));
}

TEST_F(ReplacedBuildTest, KeepsItsSignatureThatCameLater) {
  catalog_ = open_catalog(folder_.path());
  put(signature_of("town", town_.build));
  reload({{folder_.path() / "town.map.sig"}, false});
  replace(true);
  reload({{}, true});
  EXPECT_EQ(signature_of_first(), signature_of("town", town_.build));
}

TEST_F(ReplacedBuildTest, HasTheSignatureThatIsKeptWithIt) {
  catalog_ = open_catalog(folder_.path());
  replace(true);
  reload({{}, true});
  EXPECT_EQ(signature_of_first(), "404");
  const auto kept = kept_build_file(folder_.path(), "town", town_.build);
  std::filesystem::create_directories(kept.parent_path());
  std::ofstream(signature_file_of(kept)) << signature_of("town", town_.build);
  EXPECT_EQ(signature_of_first(), signature_of("town", town_.build));
}

TEST_F(ReplacedBuildTest, ACurrentBuildWhoseSignatureWasRemovedIsNotSigned) {
  put(signature_of("town", town_.build));
  catalog_ = open_catalog(folder_.path());
  std::filesystem::remove(folder_.path() / "town.map.sig");
  EXPECT_EQ(signature_of_first(), "404");
  put(signature_of("village", town_.build));
  EXPECT_EQ(signature_of_first(), "404");
}

TEST_F(ServedSignatureTest, IsNeitherAMapNorWarnedAbout) {
  put(signature_of("town", town_.build));
  std::vector<std::string> warnings;
  const auto catalog = Catalog::open(folder_.path(), CatalogSettings(),
                                     [&](const std::string& line) { warnings.push_back(line); });
  ASSERT_TRUE(catalog.ok());
  EXPECT_EQ((*catalog)->maps().size(), 1U);
  EXPECT_EQ((*catalog)->left_out(), 0U);
  EXPECT_THAT(warnings, IsEmpty());
}

}  // namespace
}  // namespace milepost::server
