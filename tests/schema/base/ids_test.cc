#include "schema/base/ids.h"

#include <gtest/gtest.h>

#include <string>

namespace milepost {
namespace {

TEST(Ids, TakesWhatAUrlAndAFileNameTake) {
  EXPECT_TRUE(is_segment_id("a"));
  EXPECT_TRUE(is_segment_id("Kitti_00-map.2"));
  EXPECT_TRUE(is_segment_id(std::string(64, 'x')));
}

TEST(Ids, RefusesTheRest) {
  EXPECT_FALSE(is_segment_id(""));
  EXPECT_FALSE(is_segment_id(".."));
  EXPECT_FALSE(is_segment_id(".hidden"));
  EXPECT_FALSE(is_segment_id("a/b"));
  EXPECT_FALSE(is_segment_id("a b"));
  EXPECT_FALSE(is_segment_id("stra\xC3\x9F"));
  EXPECT_FALSE(is_segment_id(std::string("a\0b", 3)));
  EXPECT_FALSE(is_segment_id(std::string(65, 'x')));
}

}  // namespace
}  // namespace milepost
