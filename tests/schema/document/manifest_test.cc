#include "schema/document/manifest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "schema/base/digest.h"

namespace milepost {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

Manifest example() {
  return {ListedDocument::of("the map"),
          ListedDocument::of("the cells"),
          {{"s2", ListedDocument::of("two")}, {"s1", ListedDocument::of("one")}}};
}

TEST(Manifest, ListsEveryDocument) {
  const std::string one = digest_of(as_bytes("one"));
  EXPECT_THAT(manifest_document(example()),
              HasSubstr(R"("segments":[{"bytes":3,"digest":")" + one + R"(","segment":"s1"},)"));
  const auto read = manifest_from(manifest_document(example()));
  ASSERT_TRUE(read.ok()) << read.error().line();
  EXPECT_TRUE(read->map.is("the map"));
  EXPECT_TRUE(read->areas.is("the cells"));
  ASSERT_EQ(read->segments.size(), 2U);
  EXPECT_TRUE(read->segments.at("s2").is("two"));
  EXPECT_EQ(manifest_document(*read), manifest_document(example()));
}

TEST(Manifest, AListedDocumentIsItselfOnly) {
  const ListedDocument listed = ListedDocument::of("49.0101");
  EXPECT_TRUE(listed.is("49.0101"));
  EXPECT_FALSE(listed.is("49.0102"));
  EXPECT_FALSE(listed.is("49.010"));
  EXPECT_FALSE(listed.is(""));
}

TEST(Manifest, FurtherKeysAreAllowed) {
  json document = json::parse(manifest_document(example()));
  document["signed_by"] = "a key";
  document["segments"][0]["passes"] = 2;
  EXPECT_TRUE(manifest_from(document.dump()).ok());
}

TEST(Manifest, EveryWrongFieldIsRefused) {
  const std::vector<std::pair<std::string, std::function<void(json&)>>> changes = {
      {"older format", [](json& d) { d["format"] = 2; }},
      {"newer format", [](json& d) { d["format"] = 4; }},
      {"no format", [](json& d) { d.erase("format"); }},
      {"no map", [](json& d) { d.erase("map"); }},
      {"map a digest", [](json& d) { d["map"] = d["map"]["digest"]; }},
      {"areas without bytes", [](json& d) { d["areas"].erase("bytes"); }},
      {"no bytes", [](json& d) { d["areas"]["bytes"] = 0; }},
      {"bytes negative", [](json& d) { d["areas"]["bytes"] = -1; }},
      {"bytes absurd", [](json& d) { d["areas"]["bytes"] = 1ULL << 40U; }},
      {"digest short", [](json& d) { d["map"]["digest"] = "00"; }},
      {"no segments", [](json& d) { d.erase("segments"); }},
      {"segments an object", [](json& d) { d["segments"] = json::object(); }},
      {"segment a number", [](json& d) { d["segments"][0] = 1; }},
      {"segment without a name", [](json& d) { d["segments"][0].erase("segment"); }},
      {"segment a path", [](json& d) { d["segments"][0]["segment"] = "../x"; }},
      {"segment twice", [](json& d) { d["segments"][0]["segment"] = "s2"; }},
      {"segment without a digest", [](json& d) { d["segments"][0].erase("digest"); }},
  };
  for (const auto& [name, change] : changes) {
    SCOPED_TRACE(name);
    json document = json::parse(manifest_document(example()));
    change(document);
    const auto read = manifest_from(document.dump());
    ASSERT_FALSE(read.ok());
    EXPECT_EQ(read.error().code, ErrorCode::corrupt);
    EXPECT_THAT(read.error().line(), HasSubstr("the manifest: "));
    EXPECT_THAT(read.error().line(), HasSubstr("build the map anew"));
  }
  for (const char* text : {"", "[]", "<html>", "{"}) EXPECT_FALSE(manifest_from(text).ok()) << text;
}

}  // namespace
}  // namespace milepost
