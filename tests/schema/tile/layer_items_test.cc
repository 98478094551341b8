#include "schema/tile/layer_items.h"

#include <gtest/gtest.h>

namespace milepost {
namespace {

TEST(LayerItems, AreNamedAsFormatMdSays) {
  EXPECT_EQ(layer_items_named("tracklets"), LayerItems::tracklets);
  EXPECT_EQ(layer_items_named("observations"), LayerItems::observations);
  EXPECT_EQ(layer_items_named("frames"), LayerItems::frames);
  EXPECT_EQ(layer_items_named("landmarks"), LayerItems::landmarks);
  EXPECT_STREQ(name_of(LayerItems::landmarks), "landmarks");
  EXPECT_FALSE(layer_items_named("signs").has_value());
}

}  // namespace
}  // namespace milepost
