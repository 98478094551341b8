#include "client/fetch/cell_request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace milepost::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::uint32_t kRow = 27800;
constexpr std::uint32_t kColumn = 37680;

// Cells as on a map, north up: 'x' is missing, 'o' is in the index and not missing, '.' is not in
// the index. The south-west one is at kRow, kColumn.
struct Grid {
  std::vector<CellEntry> index;
  std::set<std::uint32_t> missing;

  explicit Grid(const std::vector<std::string>& rows) {
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const std::string& cells = rows[rows.size() - 1 - row];
      for (std::size_t column = 0; column < cells.size(); ++column) {
        if (cells[column] == '.') continue;
        const std::uint32_t number = GridCell{kRow + static_cast<std::uint32_t>(row),
                                              kColumn + static_cast<std::uint32_t>(column)}
                                         .number();
        index.push_back({number, 1, 100, "digest"});
        if (cells[column] == 'x') missing.insert(number);
      }
    }
  }

  // The number of cells of each request until none is missing. Each request must bring missing
  // cells only.
  std::vector<std::size_t> requests() {
    std::vector<std::size_t> sizes;
    while (!missing.empty()) {
      const CellRequest request = request_for_first_block(index, missing);
      EXPECT_EQ(request.box.has_value(), request.expected.size() > 1);
      EXPECT_FALSE(request.expected.empty());
      for (const CellEntry& entry : request.expected) EXPECT_EQ(missing.erase(entry.cell), 1U);
      if (request.expected.empty()) break;
      sizes.push_back(request.expected.size());
    }
    return sizes;
  }
};

TEST(CellRequest, OneCellHasItsOwnUrl) {
  const Grid grid({"ooo",  //
                   "oxo",  //
                   "ooo"});
  const CellRequest request = request_for_first_block(grid.index, grid.missing);
  EXPECT_FALSE(request.box.has_value());
  ASSERT_EQ(request.expected.size(), 1U);
  EXPECT_EQ(request.expected[0].cell, (GridCell{kRow + 1, kColumn + 1}.number()));
}

TEST(CellRequest, ABlockIsAskedForFromMiddleToMiddle) {
  const Grid grid({"oooo",  //
                   "oxxo",  //
                   "oxxo",  //
                   "oooo"});
  const CellRequest request = request_for_first_block(grid.index, grid.missing);
  EXPECT_EQ(request.expected.size(), 4U);
  ASSERT_TRUE(request.box.has_value());
  EXPECT_DOUBLE_EQ(request.box->west_deg, 8.4075);
  EXPECT_DOUBLE_EQ(request.box->south_deg, 49.0075);
  EXPECT_DOUBLE_EQ(request.box->east_deg, 8.4125);
  EXPECT_DOUBLE_EQ(request.box->north_deg, 49.0125);
}

TEST(CellRequest, RowsAndColumnsAheadAreOneRequestEach) {
  EXPECT_THAT(Grid({"xxx",  //
                    "oox",  //
                    "oox"})
                  .requests(),
              ElementsAre(3, 2));
  EXPECT_THAT(Grid({"xoo",  //
                    "xoo",  //
                    "xxx"})
                  .requests(),
              ElementsAre(3, 2));
  EXPECT_THAT(Grid({"xxx",  //
                    "ooo",  //
                    "ooo"})
                  .requests(),
              ElementsAre(3));
  EXPECT_THAT(Grid({"oox",  //
                    "oox",  //
                    "oox"})
                  .requests(),
              ElementsAre(3));
}

TEST(CellRequest, PlacesWithoutACellAreNoObstacle) {
  EXPECT_THAT(Grid({"x.x",  //
                    "..x",  //
                    "x.."})
                  .requests(),
              ElementsAre(4));
}

TEST(CellRequest, BothSidesOfLongitude180AreTwoRequests) {
  Grid grid({});
  for (const std::uint32_t column : {0U, 1U, 40000U, kCellColumns - 1}) {
    grid.index.push_back({GridCell{kRow, column}.number(), 1, 100, "digest"});
    if (column != 40000) grid.missing.insert(grid.index.back().cell);
  }
  EXPECT_THAT(grid.requests(), ElementsAre(2, 1));
}

TEST(CellRequest, AlwaysBringsEachMissingCellOnce) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> kind(0, 2);
  for (int round = 0; round < 500; ++round) {
    std::vector<std::string> rows(5, std::string(5, '.'));
    for (std::string& row : rows) {
      for (char& cell : row) cell = ".ox"[kind(random)];
    }
    Grid grid(rows);
    const std::size_t missing = grid.missing.size();
    std::size_t brought = 0;
    for (const std::size_t cells : grid.requests()) brought += cells;
    EXPECT_EQ(brought, missing);
  }
}

TEST(AreaQuery, IsRefusedForABoxThatIsNone) {
  EXPECT_TRUE(check_area_query({179, -1, -179, 1}).ok());
  const Status refused = check_area_query({8, 49, std::nan(""), 50});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::invalid_input);
  EXPECT_THAT(refused.error().line(), HasSubstr("cells of a box"));
}

}  // namespace
}  // namespace milepost::testing
