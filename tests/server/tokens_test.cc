#include "server/access/tokens.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace milepost::server {
namespace {

using std::chrono::hours;
using std::chrono::sys_seconds;
using ::testing::HasSubstr;

const sys_seconds kNow = *parse_utc("2026-12-01T12:00:00Z");

Tokens::NewToken made(const std::string& name, std::set<std::string, std::less<>> maps,
                      sys_seconds expires = {}) {
  TokenEntry entry;
  entry.name = name;
  entry.all_maps = maps.empty();
  entry.maps = std::move(maps);
  entry.expires = expires;
  return *Tokens::generate(entry);
}

Grant grant_of(const Tokens& tokens, const std::string& authorization) {
  return tokens.grant(authorization, kNow);
}

TEST(TokensTest, AGrantIsForTheMapsOfItsToken) {
  Tokens tokens;
  const auto some = made("some", {"town", "village"});
  const auto all = made("all", {});
  tokens.add(some.entry);
  tokens.add(all.entry);
  const Grant grant = grant_of(tokens, "Bearer " + some.token);
  EXPECT_TRUE(grant.is_valid());
  EXPECT_FALSE(grant.is_for_everything());
  EXPECT_TRUE(grant.is_for("town"));
  EXPECT_TRUE(grant.is_for("village"));
  EXPECT_FALSE(grant.is_for("city"));
  EXPECT_EQ(grant.token()->name, "some");
  EXPECT_TRUE(grant_of(tokens, "bEARER   " + all.token).is_for_everything());
}

TEST(TokensTest, NothingElseIsAToken) {
  Tokens tokens;
  const auto one = made("one", {"town"});
  tokens.add(one.entry);
  EXPECT_FALSE(grant_of(tokens, "").is_of_bad_token());
  EXPECT_FALSE(grant_of(tokens, "").is_valid());
  std::vector<std::string> others = {"Basic " + one.token,
                                     one.token,
                                     "Bearer",
                                     "Bearer ",
                                     "Bearer " + one.token + "0",
                                     "Bearer " + one.token + " ",
                                     "Bearer " + made("two", {"town"}).token,
                                     "Bearer " + one.entry.sha256};
  for (std::size_t i = 0; i < one.token.size(); ++i) {
    std::string other = one.token;
    other[i] = other[i] == '0' ? '1' : '0';
    others.push_back("Bearer " + other);
    others.push_back("Bearer " + one.token.substr(0, i));
  }
  for (const std::string& other : others) {
    const Grant grant = grant_of(tokens, other);
    EXPECT_FALSE(grant.is_valid()) << other;
    EXPECT_TRUE(grant.is_of_bad_token()) << other;
    EXPECT_FALSE(grant.is_for("town")) << other;
    EXPECT_EQ(grant.token(), nullptr) << other;
  }
}

TEST(TokensTest, AnExpiredTokenIsNone) {
  Tokens tokens;
  const auto one = made("one", {}, kNow);
  tokens.add(one.entry);
  const std::string authorization = "Bearer " + one.token;
  EXPECT_TRUE(tokens.grant(authorization, kNow - hours(1)).is_valid());
  EXPECT_FALSE(tokens.grant(authorization, kNow).is_valid());
  EXPECT_TRUE(tokens.grant(authorization, kNow).is_of_expired_token());
  const auto lasting = made("lasting", {}, *parse_utc("9999-12-31"));
  tokens.add(lasting.entry);
  EXPECT_TRUE(tokens.grant("Bearer " + lasting.token, kNow).is_valid());
}

TEST(TokensTest, TheFileHoldsNoToken) {
  Tokens tokens;
  const auto one = made("one", {"town"}, kNow);
  const auto two = made("two", {});
  tokens.add(one.entry);
  tokens.add(two.entry);
  const std::string text = tokens.text();
  EXPECT_EQ(text.find(one.token.substr(20)), std::string::npos);
  const auto again = Tokens::parse(text, "file");
  ASSERT_TRUE(again.ok()) << again.error().line();
  EXPECT_EQ((*again)->text(), text);
  EXPECT_TRUE((*again)->grant("Bearer " + one.token, kNow - hours(1)).is_for("town"));
  EXPECT_TRUE((*again)->grant("Bearer " + two.token, kNow).is_for_everything());
}

TEST(TokensTest, WhatIsWrongInTheFileIsNamed) {
  Tokens tokens;
  tokens.add(made("one", {"town"}, kNow).entry);
  const nlohmann::json good = nlohmann::json::parse(tokens.text());
  ASSERT_TRUE(Tokens::parse(good.dump(), "f").ok());
  const auto fault = [](const nlohmann::json& json) {
    const auto parsed = Tokens::parse(json.dump(), "f");
    return parsed.ok() ? "none" : parsed.error().line();
  };
  const auto with = [&](const char* key, const nlohmann::json& value) {
    nlohmann::json json = good;
    json["tokens"][0][key] = value;
    return json;
  };
  EXPECT_THAT(fault(with("secret", "x")), HasSubstr("f, token 1: has an unknown key 'secret'"));
  EXPECT_THAT(fault(with("id", "5D1F5D1F5D1F5D1F")), HasSubstr("no id"));
  EXPECT_THAT(fault(with("sha256", "00")), HasSubstr("no sha256"));
  EXPECT_THAT(fault(with("name", "a b")), HasSubstr("no name"));
  EXPECT_THAT(fault(with("maps", "town")), HasSubstr("no 'maps'"));
  EXPECT_THAT(fault(with("maps", {"../town"})), HasSubstr("cannot be one"));
  EXPECT_THAT(fault(with("expires", 5)), HasSubstr("no time"));
  EXPECT_THAT(fault(with("expires", "2026-02-30T00:00:00Z")), HasSubstr("no time"));
  nlohmann::json twice = good;
  twice["tokens"].push_back(good["tokens"][0]);
  EXPECT_THAT(fault(twice), HasSubstr("token 2: has the id or the name of another"));
  EXPECT_THAT(fault({{"tokens", nlohmann::json::array()}, {"more", 1}}),
              HasSubstr("is not a list"));
  EXPECT_FALSE(Tokens::parse("{", "f").ok());
}

TEST(TokensTest, TimesHaveOneForm) {
  EXPECT_EQ(utc_text(*parse_utc("2027-01-02")), "2027-01-02T00:00:00Z");
  EXPECT_EQ(utc_text(*parse_utc("2027-01-02T03:04:05Z")), "2027-01-02T03:04:05Z");
  for (const char* text :
       {"", "2027", "2027-1-2", "2027-13-01", "2027-02-30", "2027-01-02T03:04:05",
        "2027-01-02T03:04:05Z ", "1969-01-01", "2027-01-02 03:04:05Z"}) {
    EXPECT_FALSE(parse_utc(text).ok()) << text;
  }
}

}  // namespace
}  // namespace milepost::server
