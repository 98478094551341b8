#include "schema/document/map_documents.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace milepost {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string kDigest = "00112233445566778899aabbccddeeff";

// The bytes are part of the format: whoever changes them changes every build.
TEST(MapDocuments, TheMapsBytes) {
  const auto document =
      map_document({.layers = {{"walls", "{}"}, {"tracklets", R"({"b": 1.0, "a":2})"}},
                    .feature_json = R"({"kind": "sift"})",
                    .bounds = {8.4, 49, 8.5, 49.25},
                    .segments = 2,
                    .length_m = 1834.2});
  ASSERT_TRUE(document.ok()) << document.error().line();
  EXPECT_EQ(
      *document,
      R"({"bounds":{"east_deg":8.5,"north_deg":49.25,"south_deg":49,"west_deg":8.4},)"
      R"("feature":{"kind":"sift"},"layer_parameters":{"tracklets":{"a":2,"b":1},"walls":{}},)"
      R"("layers":["tracklets","walls"],"length_m":1834.2,"segment_count":2})");
}

TEST(MapDocuments, ParametersThatAreNoObjectAreNamed) {
  const auto layer = map_document({.layers = {{"walls", "[]"}}});
  ASSERT_FALSE(layer.ok());
  EXPECT_EQ(layer.error().code, ErrorCode::corrupt);
  EXPECT_THAT(layer.error().line(), HasSubstr("layer walls: the parameters are not a JSON object"));
  EXPECT_THAT(map_document({.layers = {}, .feature_json = "{"}).error().line(),
              HasSubstr("feature parameters: this is not JSON"));
}

TEST(MapDocuments, ASegmentsBytes) {
  const StoredSegment segment{"s1",
                              940,
                              {{49.0101, 8.4011, 110.2, 0}, {49.0103, 8.4011, 110, 940}},
                              {{"s2"}, {"s9", "village"}},
                              {{"morning", 40, 980}},
                              {0.15, 100, true}};
  EXPECT_EQ(segment_document(
                segment, {{"tracklets", {{3, {-1.5, 61.5}, 1480, 70211, kDigest}}}, {"walls", {}}}),
            R"({"assumed":true,"length_m":940,"line":[[49.0101,8.4011,110.2,0],)"
            R"([49.0103,8.4011,110,940]],"passes":[{"drive":"morning","from_m":40,"to_m":980}],)"
            R"("position_correlation_m":100,"position_sigma_m":0.15,"segment":"s1",)"
            R"("successors":[{"segment":"s2"},{"map":"village","segment":"s9"}],)"
            R"("tiles":{"tracklets":[{"bytes":70211,"digest":"00112233445566778899aabbccddeeff",)"
            R"("from_m":-1.5,"index":3,"items":1480,"to_m":61.5}]}})");
}

TEST(MapDocuments, WhatASegmentDoesNotSayIsLeftOut) {
  const std::string document = segment_document({"s1", 1, {}, {}}, {});
  for (const char* key : {"assumed", "position_sigma_m", "position_correlation_m"}) {
    EXPECT_THAT(document, Not(HasSubstr(key)));
  }
  EXPECT_THAT(document, HasSubstr(R"("tiles":{})"));
}

TEST(MapDocuments, TheCellsBytes) {
  EXPECT_EQ(areas_document({{"walls", {{2001637680, 812, 9120, kDigest}}}, {"trees", {}}}),
            R"({"cells":{"walls":[{"bytes":9120,"cell":2001637680,)"
            R"("digest":"00112233445566778899aabbccddeeff","east_deg":8.405,"items":812,)"
            R"("north_deg":49.005,"south_deg":49,"west_deg":8.4}]}})");
  EXPECT_EQ(areas_document({}), R"({"cells":{}})");
}

}  // namespace
}  // namespace milepost
