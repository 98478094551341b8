#include "server/catalog/box_tree.h"

#include <gmock/gmock.h>

namespace milepost::server {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(BoxTree, FindsBoxesWithinTheRadius) {
  const BoxTree tree({{8, 49, 8.1, 49.1}, {8.2, 49, 8.3, 49.1}, {9, 49, 9.1, 49.1}});
  EXPECT_THAT(tree.near({49.05, 8.05, 0}, 10), ElementsAre(0));
  EXPECT_THAT(tree.near({49.05, 8.15, 0}, 5000), ElementsAre(0, 1));
  EXPECT_THAT(tree.near({49.05, 8.15, 0}, 1000), IsEmpty());
  EXPECT_THAT(BoxTree({}).near({49, 8, 0}, 10000), IsEmpty());
}

TEST(BoxTree, FindsBoxesAcrossLongitude180AndAroundThePoles) {
  const BoxTree tree({{179.9, -0.1, 179.99, 0.1},
                      {-179.99, -0.1, -179.9, 0.1},
                      {179.95, 10, -179.95, 10.1},
                      {0, 89.95, 1, 89.99}});
  EXPECT_THAT(tree.near({0, 179.999, 0}, 3000), ElementsAre(0, 1));
  EXPECT_THAT(tree.near({0, -179.999, 0}, 3000), ElementsAre(0, 1));
  EXPECT_THAT(tree.near({10.05, 180, 0}, 10), ElementsAre(2));
  EXPECT_THAT(tree.near({10.05, -180, 0}, 10), ElementsAre(2));
  EXPECT_THAT(tree.near({89.99, -120, 0}, 10000), ElementsAre(3));
}

}  // namespace
}  // namespace milepost::server
