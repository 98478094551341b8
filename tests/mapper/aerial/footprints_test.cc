#include "mapper/aerial/footprints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <utility>

#include "schema/base/file.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::TempFolder;

// A square of 0.001 degrees about a place, counterclockwise, as a ring of GeoJSON.
constexpr const char* kSquare =
    "[[8.4, 49], [8.401, 49], [8.401, 49.001], [8.4, 49.001], [8.4, 49]]";
constexpr const char* kHole =
    "[[8.4002, 49.0002], [8.4008, 49.0002], [8.4008, 49.0008], [8.4002, 49.0008], [8.4002, "
    "49.0002]]";

Result<std::vector<Wall>> read(const std::string& text) {
  Result<Footprints> footprints = footprints_in(text, "town.geojson");
  if (!footprints.ok()) return footprints.error();
  return std::move(footprints->walls);
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
  for (const char* const end : {"[8.01, 90.01]", "[360.01, 49]"}) {
    EXPECT_THAT(refusal(polygon("[[8, 49], [8.01, 49], " + std::string(end) + ", [8, 49]]")),
                AllOf(HasSubstr("coordinates[0][2]"), HasSubstr("in degrees")));
  }
  EXPECT_THAT(refusal(polygon("[[8, 49], [8.01, 49], [180.01, 49], [8, 49]]")),
              HasSubstr("longer than 0.1 degrees"));
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

TEST(Footprints, TheFileIsRead) {
  const TempFolder folder;
  ASSERT_TRUE(write_text_file(folder / "town.geojson", polygon(kSquare)).ok());
  const Result<Footprints> footprints = read_footprints(folder / "town.geojson");
  ASSERT_TRUE(footprints.ok());
  EXPECT_EQ(footprints->walls.size(), 4U);
  EXPECT_EQ(footprints->contents, "1 Polygon");
  std::filesystem::resize_file(folder / "town.geojson", 512'000'001);  // sparse
  EXPECT_THAT(read_footprints(folder / "town.geojson").error().line(),
              AllOf(HasSubstr("town.geojson"), HasSubstr("larger than 512 MB")));
}

std::string contents(const std::string& text) {
  const Result<Footprints> footprints = footprints_in(text, "town.geojson");
  return footprints.ok() ? footprints->contents : footprints.error().line();
}

TEST(Footprints, WhatAFileHoldsIsCounted) {
  const std::string point = geometry("Point", "[8, 49]");
  const std::string line = geometry("LineString", "[[8, 49], [8.1, 49]]");
  EXPECT_EQ(contents(R"({"type": "GeometryCollection", "geometries": []})"), "no features");
  EXPECT_EQ(contents(R"({"type": "GeometryCollection", "geometries": [)" + point + "," + line +
                     "," + point + "]}"),
            "1 LineString, 2 Points and no Polygon");
  EXPECT_EQ(contents(R"({"type": "Feature", "geometry": null})"),
            "1 feature without a geometry and no Polygon");
  EXPECT_EQ(contents(polygon(kSquare)), "1 Polygon");
}

TEST(Footprints, OtherFormatsAreCalledByTheirNames) {
  EXPECT_THAT(contents(R"({"type": "Topology", "arcs": []})"),
              AllOf(HasSubstr("TopoJSON"), HasSubstr("ogr2ogr")));
  EXPECT_THAT(contents(R"({"version": 0.6, "elements": []})"), HasSubstr("Overpass JSON"));
  EXPECT_THAT(contents(R"({"geometryType": "x", "features": []})"), HasSubstr("Esri JSON"));
  EXPECT_THAT(contents(geometry("MULTIPOLYGON", "[]")), HasSubstr("written \"MultiPolygon\""));
  EXPECT_THAT(contents(geometry("Building\\n", "[]")),
              HasSubstr("\"Building\\n\" is not a GeoJSON type"));
  EXPECT_THAT(contents(std::string("\x1e") + polygon(kSquare) + "\n"), HasSubstr("per line"));
  EXPECT_THAT(contents(polygon(kSquare) + "\r\n" + polygon(kSquare)), HasSubstr("per line"));
  EXPECT_THAT(contents("{\"type\":\n{"), Not(HasSubstr("per line")));
}

TEST(Footprints, AReferenceThatIsNoObjectIsRefused) {
  for (const char* const reference :
       {"\"EPSG:4326\"", "[\"EPSG:4326\"]", "4326", "true", "{}", R"({"properties": []})",
        R"({"properties": {"name": 4326}})", R"({"properties": {"name": null}})"}) {
    EXPECT_THAT(refusal(R"({"type": "FeatureCollection", "features": [], "crs": )" +
                        std::string(reference) + "}"),
                AllOf(HasSubstr("town.geojson, crs"), HasSubstr("properties.name")));
  }
}

TEST(Footprints, NestingIsBounded) {
  const auto nested = [](const std::string& open, const std::string& close, int times) {
    std::string text;
    for (int i = 0; i < times; ++i) text += open;
    for (int i = 0; i < times; ++i) text += close;
    return text;
  };
  EXPECT_THAT(refusal(nested("[", "]", 100000)), HasSubstr("nested more than 64 deep"));
  EXPECT_THAT(refusal(nested(R"({"type": "GeometryCollection", "geometries": [)", "]}", 100000)),
              HasSubstr("nested more than 64 deep"));
  EXPECT_EQ(refusal(nested(R"({"type": "GeometryCollection", "geometries": [)", "]}", 30)), "");
}

// The building is on the right of the part of a ring's wall that goes from latitude to latitude.
TEST(Footprints, ARingMayGoAcross180) {
  for (const char* const ring :
       {"[[179.9999, -16.5], [-179.9999, -16.5], [-179.9999, -16.4999], [179.9999, -16.4999], "
        "[179.9999, -16.5]]",
        "[[179.9999, -16.5], [180.0001, -16.5], [180.0001, -16.4999], [179.9999, -16.4999], "
        "[179.9999, -16.5]]",
        "[[-180.0001, -16.4999], [-179.9999, -16.4999], [-179.9999, -16.5], [-180.0001, -16.5], "
        "[-180.0001, -16.4999]]"}) {
    const auto walls = read(polygon(ring));
    ASSERT_TRUE(walls.ok()) << walls.error().line();
    ASSERT_EQ(walls->size(), 4U);
    for (const Wall& wall : *walls) {
      for (const WallEnd& end : {wall.begin, wall.end}) {
        EXPECT_NEAR(std::abs(end.longitude_deg), 179.9999, 1e-9);
      }
      if (wall.begin.longitude_deg * wall.end.longitude_deg < 0) continue;
      const bool is_northward = wall.end.latitude_deg > wall.begin.latitude_deg;
      EXPECT_EQ(is_northward, wall.begin.longitude_deg > 0) << ring;
    }
  }
}

TEST(Footprints, TheCutAlong180IsNoWall) {
  const std::string west =
      "[[179.9999, 1], [180, 1], [180, 1.0001], [179.9999, 1.0001], "
      "[179.9999, 1]]";
  const std::string east =
      "[[-180, 1], [-179.9999, 1], [-179.9999, 1.0001], [-180, 1.0001], "
      "[-180, 1]]";
  const std::string apart =
      "[[-180, 2], [-179.9999, 2], [-179.9999, 2.0001], [-180, 2.0001], "
      "[-180, 2]]";
  EXPECT_EQ(read(geometry("MultiPolygon", "[[" + west + "], [" + east + "]]"))->size(), 6U);
  EXPECT_EQ(read(geometry("MultiPolygon", "[[" + west + "], [" + apart + "]]"))->size(), 8U);
  EXPECT_EQ(read(polygon(west))->size(), 4U);
}

TEST(Footprints, ARingMayGoAroundAPole) {
  for (const double pole : {1.0, -1.0}) {
    std::string ring;
    for (const int longitude : {0, 90, 180, -90, 0}) {
      ring += (ring.empty() ? "[[" : ", [") + std::to_string(longitude) + ", " +
              std::to_string(pole * 89.9995) + "]";
    }
    const auto walls = read(polygon(ring + "]"));
    ASSERT_TRUE(walls.ok()) << walls.error().line();
    ASSERT_EQ(walls->size(), 4U);
    // With the building on the right one goes clockwise as seen from above: westward about the
    // northern pole.
    const Wall& wall = walls->front();
    const double east_deg =
        std::remainder(wall.end.longitude_deg - wall.begin.longitude_deg, 360.0);
    EXPECT_EQ(east_deg<0, pole> 0);
  }
}

TEST(Footprints, RepeatedPositionsMakeNoWall) {
  const auto walls = read(polygon("[[8, 49], [8, 49], [8.01, 49], [8.01, 49.01], [8, 49]]"));
  ASSERT_TRUE(walls.ok());
  EXPECT_EQ(walls->size(), 3U);
}

}  // namespace
}  // namespace milepost
