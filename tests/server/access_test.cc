// Tokens, limits, parts, codings and origins, over sockets.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "server/message/content_coding.h"
#include "tests/server/server_fixture.h"

namespace milepost::server {
namespace {

using ::testing::AnyOf;
using ::testing::Eq;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class AccessTest : public ServerTest {
 protected:
  // The value of Authorization of a new token, for all maps without any.
  std::string token(const std::string& name, std::set<std::string, std::less<>> maps,
                    std::chrono::sys_seconds expires = {}) {
    TokenEntry entry;
    entry.name = name;
    entry.all_maps = maps.empty();
    entry.maps = std::move(maps);
    entry.expires = expires;
    auto made = *Tokens::generate(entry);
    Tokens tokens = *tokens_->now();
    tokens.add(std::move(made.entry));
    tokens_->replace(std::make_shared<const Tokens>(std::move(tokens)));
    return "Authorization: Bearer " + made.token + "\r\n";
  }
  void start_with_tokens() {
    ServerSettings settings;
    settings.tokens = tokens_;
    start(settings);
  }
  Reply get(const std::string& target, const std::string& headers = "") const {
    return fetch(port_, target, headers);
  }
  std::string tile_path(int index) const {
    return segment_path() + "/tiles/tracklets/" + std::to_string(index);
  }
  // Paths of the map, each in another way through the server.
  std::vector<std::string> paths_of_town() const {
    return {"/v1/maps/town",    "/v1/maps/town/builds/" + town_.build + "/manifest",
            segment_path(),     tile_path(0),
            range_path(0, 300), areas_path(),
            "/v1/maps/%74own",  "http://host" + tile_path(1)};
  }

  const std::shared_ptr<CurrentTokens> tokens_ =
      std::make_shared<CurrentTokens>(std::make_shared<const Tokens>());
};

TEST_F(AccessTest, WithoutATokenNothingOfAMapIsAnswered) {
  const std::string valid = token("valid", {"town"});
  start_with_tokens();
  std::vector<std::string> paths = paths_of_town();
  for (const char* path : {"/v1/maps", "/v1/segments?near=49,8&radius_m=100", "/v1/maps/absent",
                           "/metrics", "/viewer/maps/town/builds/0/walls/1"}) {
    paths.emplace_back(path);
  }
  for (int round = 0; round < 2; ++round) {  // the second one with everything in memory
    for (const std::string& path : paths) {
      const Reply refused = get(path);
      EXPECT_EQ(refused.status, 401) << path;
      EXPECT_EQ(refused.header("www-authenticate"), "Bearer realm=\"milepost\"") << path;
      EXPECT_EQ(refused.header("cache-control"), "no-store") << path;
      const Reply unknown = get(path, "Authorization: Bearer mp_0123\r\n");
      EXPECT_EQ(unknown.status, 401) << path;
      EXPECT_THAT(unknown.header("www-authenticate"), HasSubstr("invalid_token")) << path;
    }
    for (const std::string& path : paths_of_town()) EXPECT_EQ(get(path, valid).status, 200) << path;
  }
  for (const char* path : {"/healthz", "/readyz", "/openapi.yaml", "/"}) {
    EXPECT_EQ(get(path).status, 200) << path;
  }
}

TEST_F(AccessTest, ATokenIsForItsMaps) {
  const std::string of_town = token("of_town", {"town"});
  const std::string of_other = token("of_other", {"other"});
  const std::string of_all = token("of_all", {});
  write_town(folder_.path() / "other.map", 500, 2);
  start_with_tokens();
  for (int round = 0; round < 2; ++round) {
    for (const std::string& path : paths_of_town()) {
      EXPECT_EQ(get(path, of_town).status, 200) << path;
      EXPECT_EQ(get(path, of_all).status, 200) << path;
      EXPECT_EQ(get(path, of_other).status, 403) << path;
    }
    EXPECT_EQ(get("/v1/maps/absent", of_town).status, 403);
    EXPECT_EQ(get("/v1/maps/absent", of_all).status, 404);
    EXPECT_EQ(get("/metrics", of_town).status, 403);
    EXPECT_EQ(get("/metrics", of_all).status, 200);
  }
}

TEST_F(AccessTest, ListsHaveWhatTheTokenIsFor) {
  const std::string of_town = token("of_town", {"town"});
  const std::string of_all = token("of_all", {});
  const std::string of_none = token("of_none", {"absent"});
  write_town(folder_.path() / "other.map", 500, 2);
  start_with_tokens();
  const auto maps_of = [&](const std::string& headers) {
    return nlohmann::json::parse(get("/v1/maps", headers).body).at("maps").size();
  };
  const auto segments_of = [&](const std::string& headers) {
    return nlohmann::json::parse(get("/v1/segments?near=49,8&radius_m=100", headers).body)
        .at("segments")
        .size();
  };
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(maps_of(of_all), 2U);
    EXPECT_EQ(maps_of(of_town), 1U);
    EXPECT_EQ(maps_of(of_none), 0U);
    EXPECT_EQ(segments_of(of_all), 4U);
    EXPECT_EQ(segments_of(of_town), 2U);
    EXPECT_EQ(segments_of(of_none), 0U);
  }
}

TEST_F(AccessTest, ATokenThatIsTakenBackOrExpiresIsRefusedAtOnce) {
  const std::string one = token("one", {});
  start_with_tokens();
  Connection connection(port_);
  connection.send_get(tile_path(0), one);
  EXPECT_EQ(connection.receive().status, 200);
  tokens_->replace(std::make_shared<const Tokens>());
  connection.send_get(tile_path(0), one);
  EXPECT_EQ(connection.receive().status, 401);
  const std::string old = token("old", {}, *parse_utc("2026-01-01"));
  const Reply expired = get(tile_path(0), old);
  EXPECT_EQ(expired.status, 401);
  EXPECT_THAT(expired.body, HasSubstr("expired"));
}

TEST_F(AccessTest, NoSharedCacheKeepsWhatATokenIsAskedFor) {
  const std::string one = token("one", {});
  start_with_tokens();
  EXPECT_EQ(get(tile_path(0), one).header("cache-control"), "private, max-age=31536000, immutable");
  EXPECT_EQ(get("/v1/maps", one).header("cache-control"), "private, no-cache");
  EXPECT_THAT(get("/").header("cache-control"), Eq("no-cache"));
}

TEST_F(AccessTest, TwoTokensInARequestAreNone) {
  const std::string one = token("one", {});
  start_with_tokens();
  EXPECT_EQ(get(tile_path(0), one + one).status, 400);
}

TEST_F(AccessTest, WithoutTheListOfFaultsEverybodyMaySeeThatItIsReady) {
  const std::string all = token("all", {});
  start_with_tokens();
  EXPECT_EQ(get("/readyz").body, "ok\n");
  EXPECT_EQ(get("/readyz", all).body, "ok\n");
}

TEST_F(AccessTest, AClientThatAsksTooOftenWaits) {
  ServerSettings settings;
  settings.rate = {0.5, 3};
  settings.tokens = tokens_;
  const std::string one = token("one", {});
  const std::string two = token("two", {});
  start(settings);
  Connection connection(port_);
  for (int i = 0; i < 3; ++i) {
    connection.send_get("/healthz", one);
    EXPECT_EQ(connection.receive().status, 200);
  }
  connection.send_get("/healthz", one);
  const Reply refused = connection.receive();
  EXPECT_EQ(refused.status, 429);
  EXPECT_THAT(refused.header("retry-after"), AnyOf(Eq("1"), Eq("2")));
  EXPECT_EQ(refused.header("content-type"), "application/problem+json");
  connection.send_get("/healthz", two);  // has a limit of its own
  EXPECT_EQ(connection.receive().status, 200);
  // Guesses count for the address.
  for (int i = 0; i < 3; ++i) EXPECT_EQ(get("/v1/maps", "Authorization: Bearer x\r\n").status, 401);
  EXPECT_EQ(get("/v1/maps", "Authorization: Bearer x\r\n").status, 429);
  Connection elsewhere(port_, "127.0.0.2");
  elsewhere.send_get("/healthz");
  EXPECT_EQ(elsewhere.receive().status, 200);
}

TEST_F(AccessTest, APartOfATile) {
  start();
  const std::string whole = frames(2, 2);
  const std::string size = std::to_string(whole.size());
  for (int round = 0; round < 2; ++round) {
    const Reply all = get(tile_path(2));
    EXPECT_EQ(all.status, 200);
    EXPECT_EQ(all.header("accept-ranges"), "bytes");
    const Reply part = get(tile_path(2), "Range: bytes=10-19\r\n");
    EXPECT_EQ(part.status, 206);
    EXPECT_EQ(part.header("content-range"), "bytes 10-19/" + size);
    EXPECT_EQ(part.header("etag"), all.header("etag"));
    EXPECT_EQ(part.body, whole.substr(10, 10));
    EXPECT_EQ(get(tile_path(2), "Range: bytes=990-\r\n").body, whole.substr(990));
    EXPECT_EQ(get(tile_path(2), "Range: bytes=-7\r\n").body, whole.substr(whole.size() - 7));
    EXPECT_EQ(get(tile_path(2), "Range: bytes=0-1,4-5\r\n").body, whole);
    const Reply beyond = get(tile_path(2), "Range: bytes=" + size + "-\r\n");
    EXPECT_EQ(beyond.status, 416);
    EXPECT_EQ(beyond.header("content-range"), "bytes */" + size);
    const std::string same = "If-Range: " + all.header("etag") + "\r\n";
    EXPECT_EQ(get(tile_path(2), "Range: bytes=5-5\r\n" + same).body, whole.substr(5, 1));
    EXPECT_EQ(get(tile_path(2), "Range: bytes=5-5\r\nIf-Range: \"old\"\r\n").body, whole);
    EXPECT_EQ(get(tile_path(2), "Range: bytes=5-5\r\nIf-None-Match: " + all.header("etag") + "\r\n")
                  .status,
              304);
  }
}

TEST_F(AccessTest, PartsAreOfSingleTilesAndOfGetAlone) {
  start();
  EXPECT_EQ(get(range_path(0, 300), "Range: bytes=0-4\r\n").body, frames(0, 3));
  EXPECT_EQ(get("/v1/maps/town", "Range: bytes=0-4\r\n").status, 200);
  const std::string cell = areas_path() + "/walls/" + std::to_string(kTownCells[0]);
  EXPECT_EQ(get(cell, "Range: bytes=1-2\r\n").body,
            std::string(as_text(town_.cells[0])).substr(1, 2));
  Connection connection(port_);
  connection.send("HEAD " + tile_path(0) + " HTTP/1.1\r\nHost: h\r\nRange: bytes=0-4\r\n\r\n");
  const Reply head = connection.receive(true);
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.header("content-length"), "1000");
}

TEST_F(AccessTest, DocumentsComeInTheCodingThatTheClientTakes) {
  start();
  for (int round = 0; round < 2; ++round) {
    const Reply plain = get(segment_path());
    EXPECT_EQ(plain.header("vary"), "Accept-Encoding");
    EXPECT_EQ(plain.header("content-encoding"), "");
    for (const ContentCoding coding : {ContentCoding::gzip, ContentCoding::zstd}) {
      const std::string name(name_of(coding));
      const std::string accept = "Accept-Encoding: " + name + "\r\n";
      const Reply reply = get(segment_path(), accept);
      EXPECT_EQ(reply.header("content-encoding"), name);
      EXPECT_EQ(reply.header("vary"), "Accept-Encoding");
      EXPECT_EQ(reply.body, *coded(plain.body, coding));
      EXPECT_LT(reply.body.size(), plain.body.size());
      const std::string tag = reply.header("etag");
      EXPECT_NE(tag, plain.header("etag"));
      EXPECT_EQ(tag, plain.header("etag").substr(0, 33) + "-" + name + "\"");
      for (const std::string& known : {tag, plain.header("etag")}) {
        const Reply same = get(segment_path(), accept + "If-None-Match: " + known + "\r\n");
        EXPECT_EQ(same.status, 304) << known;
        EXPECT_EQ(same.header("etag"), known);
        EXPECT_EQ(same.header("vary"), "Accept-Encoding");
      }
      // A copy in a coding is no copy of the document as it is.
      EXPECT_EQ(get(segment_path(), "If-None-Match: " + tag + "\r\n").status, 200);
    }
  }
}

TEST_F(AccessTest, TilesAndShortDocumentsAreSentAsTheyAre) {
  start();
  for (const std::string& path : {tile_path(0), range_path(0, 300), std::string("/v1/maps")}) {
    const Reply reply = get(path, "Accept-Encoding: gzip, zstd\r\n");
    EXPECT_EQ(reply.header("content-encoding"), "") << path;
    EXPECT_EQ(reply.header("vary"), "") << path;
  }
}

TEST_F(AccessTest, PagesOfAllowedOriginsMayRead) {
  ServerSettings settings;
  settings.allowed_origins = {"https://maps.example.org"};
  settings.tokens = tokens_;
  start(settings);
  Connection connection(port_);
  connection.send(
      "OPTIONS /v1/maps HTTP/1.1\r\nHost: h\r\nOrigin: https://maps.example.org\r\n"
      "Access-Control-Request-Method: GET\r\n"
      "Access-Control-Request-Headers: authorization\r\n\r\n");
  const Reply preflight = connection.receive();
  EXPECT_EQ(preflight.status, 204);
  EXPECT_EQ(preflight.header("access-control-allow-origin"), "https://maps.example.org");
  EXPECT_THAT(preflight.header("access-control-allow-headers"), HasSubstr("Authorization"));
  EXPECT_EQ(preflight.header("content-length"), "");
  connection.send_get("/v1/maps", "Origin: https://maps.example.org\r\n");
  const Reply refused =
      connection.receive();  // readable, too: the page learns that a token is needed
  EXPECT_EQ(refused.status, 401);
  EXPECT_EQ(refused.header("access-control-allow-origin"), "https://maps.example.org");
  connection.send_get("/healthz", "Origin: https://evil.example.org\r\n");
  const Reply other = connection.receive();
  EXPECT_EQ(other.header("access-control-allow-origin"), "");
  EXPECT_EQ(other.header("vary"), "Origin");
}

TEST_F(AccessTest, OptionsTellsTheMethods) {
  start();
  for (const std::string target : {"*", "/v1/maps", "/healthz", "/v1/maps/absent"}) {
    Connection connection(port_);
    connection.send("OPTIONS " + target + " HTTP/1.1\r\nHost: h\r\n\r\n");
    const Reply reply = connection.receive();
    EXPECT_EQ(reply.status, 204) << target;
    EXPECT_EQ(reply.header("allow"), "GET, HEAD, OPTIONS") << target;
    EXPECT_EQ(reply.header("access-control-allow-origin"), "") << target;
    connection.send_get("/healthz");
    EXPECT_EQ(connection.receive().body, "ok\n");
  }
  Connection connection(port_);
  connection.send("OPTIONS /nothing HTTP/1.1\r\nHost: h\r\n\r\n");
  EXPECT_EQ(connection.receive().status, 404);
}

}  // namespace
}  // namespace milepost::server
