#include "schema/document/mapping_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace milepost {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

MappingRecord a_record() {
  const PoseFit fit{12, 400, 380, 0.5, 0.01, 0.02, 0.1};
  return {{{"monday", fit}},
          {{"monday-0", {{0, 10, "monday", fit}, {10, 20, "monday", {}}}}},
          {{"poor_fit", "monday", "frames", "only 3 % fit", "check the camera", 0, 12}}};
}

TEST(MappingRecord, ComesBackAsItWasWritten) {
  const auto read = mapping_record_from(mapping_document(a_record()));
  ASSERT_TRUE(read.ok()) << read.error().line();
  EXPECT_EQ(*read, a_record());
  const auto nothing = mapping_record_from(mapping_document({}));
  ASSERT_TRUE(nothing.ok());
  EXPECT_EQ(*nothing, MappingRecord());
}

TEST(MappingRecord, ErrorsAreRoundedToATenthOfAMillimetre) {
  MappingRecord record = a_record();
  record.drives[0].fit.plan_rms_m = 0.012345678;
  EXPECT_THAT(mapping_document(record), HasSubstr(R"("plan_rms_m":0.0123,)"));
}

TEST(MappingRecord, WhatIsMalformedIsRefused) {
  const json whole = json::parse(mapping_document(a_record()));
  for (const char* path :
       {"/drives", "/segments", "/findings", "/drives/0/frames", "/drives/0/drive",
        "/drives/0/up_rms_m", "/segments/0/segment", "/segments/0/stretches",
        "/segments/0/stretches/0/from_m", "/findings/0/kind", "/findings/0/count"}) {
    for (const json& other : {json(), json(-1), json("text"), json::array({1})}) {
      json changed = whole;
      json& place = changed.at(json::json_pointer(path));
      if (place.type() == other.type() || (place.is_number() && other.is_number())) continue;
      place = other;
      const auto read = mapping_record_from(changed.dump());
      ASSERT_FALSE(read.ok()) << path << " " << other;
      EXPECT_EQ(read.error().code, ErrorCode::corrupt);
    }
  }
  EXPECT_FALSE(mapping_record_from("[]").ok());
  EXPECT_FALSE(mapping_record_from("{").ok());
}

}  // namespace
}  // namespace milepost
