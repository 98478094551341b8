#include "mapper/aerial/footprints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "schema/base/file.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::TempFolder;

// A square of 0.001 degrees about a place, counterclockwise, as a ring of GeoJSON.
constexpr const char* kSquare =
    "[[8.4, 49], [8.401, 49], [8.401, 49.001], [8.4, 49.001], [8.4, 49]]";
constexpr const char* kHole =
    "[[8.4002, 49.0002], [8.4008, 49.0002], [8.4008, 49.0008], [8.4002, 49.0008], [8.4002, "
    "49.0002]]";

Result<std::vector<Wall>> read(const std::string& text) {
  const TempFolder folder;
  EXPECT_TRUE(write_text_file(folder / "town.geojson", text).ok());
  return read_footprints(folder / "town.geojson");
}

std::string geometry(const std::string& type, const std::string& coordinates) {
  return R"({"type": ")" + type + R"(", "coordinates": )" + coordinates + "}";
}

std::string polygon(const std::string& rings) { return geometry("Polygon", "[" + rings + "]"); }

std::string refusal(const std::string& text) {
  const Result<std::vector<Wall>> walls = read(text);
  return walls.ok() ? "" : walls.error().line();
}

// Whether a point lies to the right of the wall, looking from begin to end.
bool is_right_of(const Wall& wall, double longitude_deg, double latitude_deg) {
  return (wall.end.longitude_deg - wall.begin.longitude_deg) *
                 (latitude_deg - wall.begin.latitude_deg) -
             (wall.end.latitude_deg - wall.begin.latitude_deg) *
                 (longitude_deg - wall.begin.longitude_deg) <
         0;
}

TEST(Footprints, TheBuildingIsOnTheRight) {
  const auto walls = read(polygon(std::string(kSquare) + ", " + kHole));
  ASSERT_TRUE(walls.ok());
  ASSERT_EQ(walls->size(), 8U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(is_right_of((*walls)[i], 8.4005, 49.0005));
  for (std::size_t i = 4; i < 8; ++i) EXPECT_FALSE(is_right_of((*walls)[i], 8.4005, 49.0005));
}

TEST(Footprints, TheBuildingIsOnTheRightHoweverTheRingRuns) {
  for (const char* const ring :
       {"[[8.4, 49], [8.409, 49.001], [8.402, 49.008], [8.4, 49]]",
        "[[8.4, 49], [8.402, 49.008], [8.409, 49.001], [8.4, 49]]",
        "[[8.409, 49.001], [8.4, 49], [8.402, 49.008], [8.409, 49.001]]"}) {
    const auto walls = read(polygon(ring));
    ASSERT_TRUE(walls.ok());
    ASSERT_EQ(walls->size(), 3U);
    for (const Wall& wall : *walls) EXPECT_TRUE(is_right_of(wall, 8.4035, 49.003)) << ring;
  }
}

TEST(Footprints, CollectionsAndMultiPolygonsAreReadAndOthersPassedOver) {
  const std::string square = std::string("[") + kSquare + "]";
  const auto walls = read(R"({"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {}, "geometry": )" +
                          geometry("MultiPolygon", "[" + square + ", " + square + "]") + R"(},
    {"type": "Feature", "properties": {}, "geometry": null},
    {"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": [8, 49]}},
    {"type": "Feature", "geometry": {"type": "GeometryCollection", "geometries": [)" +
                          polygon(kSquare) + "]}}]}");
  ASSERT_TRUE(walls.ok()) << walls.error().line();
  EXPECT_EQ(walls->size(), 12U);
}

TEST(Footprints, ReferencesOtherThanWgs84AreRefused) {
  const auto with_reference = [](const std::string& name) {
    return R"({"type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": ")" +
           name + R"("}}, "features": []})";
  };
  EXPECT_EQ(refusal(with_reference("urn:ogc:def:crs:OGC:1.3:CRS84")), "");
  EXPECT_EQ(refusal(with_reference("EPSG:4326")), "");
  EXPECT_EQ(refusal(R"({"type": "FeatureCollection", "crs": null, "features": []})"), "");
  EXPECT_THAT(refusal(with_reference("EPSG:3857")),
              AllOf(HasSubstr("town.geojson, crs"), HasSubstr("EPSG:3857"), HasSubstr("ogr2ogr")));
}

TEST(Footprints, WhatIsBrokenIsNamed) {
  EXPECT_THAT(refusal("{\"type\": "), HasSubstr("this is not JSON"));
  EXPECT_THAT(refusal("[[NaN, 1]]"), HasSubstr("this is not JSON"));
  EXPECT_THAT(refusal("[]"), HasSubstr("the root"));
  EXPECT_THAT(refusal(R"({"type": "FeatureCollection"})"), HasSubstr("\"features\""));
  EXPECT_THAT(refusal(R"({"type": "FeatureCollection", "features": [{"type": "Feature"}]})"),
              AllOf(HasSubstr("features[0]"), HasSubstr("\"geometry\"")));
  EXPECT_THAT(refusal(R"({"type": "Polygon"})"), HasSubstr("\"coordinates\""));
  EXPECT_THAT(refusal(polygon("[[8, 49], [8, 50], [8, 49]]")), HasSubstr("at least 4"));
  EXPECT_THAT(refusal(polygon("[[8, 49], [8.01, 49], [8.01, 49.01], [8, 49.01]]")),
              HasSubstr("last position"));
  EXPECT_THAT(refusal(polygon("[[8, 49], [8.01, 49], [null, 49.01], [8, 49]]")),
              AllOf(HasSubstr("coordinates[0][2]"), HasSubstr("[longitude, latitude]")));
  EXPECT_THAT(refusal(polygon("[[932000, 6275000], [8.01, 49], [8, 49.01], [932000, 6275000]]")),
              AllOf(HasSubstr("coordinates[0][0]"), HasSubstr("in degrees")));
  EXPECT_THAT(refusal(polygon("[[8, 49], [8.2, 49], [8.2, 49.01], [8, 49]]")),
              HasSubstr("longer than 0.1 degrees"));
  EXPECT_THAT(refusal(polygon("[[8, 49], [8.01, 49], [8.01, 49.2], [8, 49]]")),
              HasSubstr("longer than 0.1 degrees"));
  for (const char* const end : {"[8.01, 90.01]", "[180.01, 49]"}) {
    EXPECT_THAT(refusal(polygon("[[8, 49], [8.01, 49], " + std::string(end) + ", [8, 49]]")),
                AllOf(HasSubstr("coordinates[0][2]"), HasSubstr("in degrees")));
  }
  for (const char* const end : {"[8.01]", "7", R"([8.01, "49"])"}) {
    EXPECT_THAT(refusal(polygon("[[8, 49], [8.01, 49], " + std::string(end) + ", [8, 49]]")),
                AllOf(HasSubstr("coordinates[0][2]"), HasSubstr("[longitude, latitude]")));
  }
  EXPECT_THAT(refusal(R"({"type": 7})"), AllOf(HasSubstr("the root"), HasSubstr("\"type\"")));
  EXPECT_THAT(refusal(R"({"type": "FeatureCollection", "features": 7})"),
              HasSubstr("\"features\""));
  EXPECT_THAT(refusal(geometry("Polygon", "7")), HasSubstr("\"coordinates\""));
  EXPECT_THAT(refusal(geometry("MultiPolygon", "[7]")),
              AllOf(HasSubstr("coordinates[0]"), HasSubstr("a list of rings")));
  for (const char* const ring : {"7", R"({"a": 1, "b": 2, "c": 3, "d": 4})"}) {
    EXPECT_THAT(refusal(polygon(ring)),
                AllOf(HasSubstr("coordinates[0]"), HasSubstr("at least 4")));
  }
  EXPECT_EQ(read_footprints("missing.geojson").error().code, ErrorCode::not_found);
}

TEST(Footprints, RepeatedPositionsMakeNoWall) {
  const auto walls = read(polygon("[[8, 49], [8, 49], [8.01, 49], [8.01, 49.01], [8, 49]]"));
  ASSERT_TRUE(walls.ok());
  EXPECT_EQ(walls->size(), 3U);
}

}  // namespace
}  // namespace milepost
