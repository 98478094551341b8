// What a map states beside its content: the datum of its positions, and the record of its mapping.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "schema/store/map_store.h"
#include "schema/store/sqlite.h"
#include "tests/schema/store/example_map.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using ::testing::HasSubstr;

class MapRecordTest : public ::testing::Test {
 protected:
  std::string write(const std::string& datum, const std::string& mapping) const {
    auto writer = MapWriter::create(file_);
    EXPECT_TRUE(writer.ok());
    testing::add_example(*writer);
    EXPECT_TRUE(writer->set_datum(datum).ok());
    EXPECT_TRUE(writer->set_mapping_document(mapping).ok());
    const auto build = writer->finish();
    EXPECT_TRUE(build.ok()) << (build.ok() ? "" : build.error().line());
    return *build;
  }
  void change(const std::string& sql) const {
    auto database = sqlite::Database::open(file_, sqlite::Access::read_write);
    ASSERT_TRUE(database.ok());
    ASSERT_TRUE(database->execute(sql).ok());
  }

  testing::TempFolder folder_;
  std::filesystem::path file_ = folder_ / "town.map";
};

TEST_F(MapRecordTest, BothComeBackAndBelongToTheBuild) {
  const std::string plain = write("", "");
  const std::string stated = write("ITRF2014@2020.5", "");
  EXPECT_NE(stated, plain);
  EXPECT_NE(write("ITRF2014@2020.5", R"({"drives":[]})"), stated);
  const auto map = MapReader::open(file_);
  ASSERT_TRUE(map.ok()) << map.error().line();
  EXPECT_EQ(map->datum(), "ITRF2014@2020.5");
  EXPECT_THAT(map->map_document(), HasSubstr(R"("datum":"ITRF2014@2020.5")"));
  const auto mapping = map->mapping_document();
  ASSERT_TRUE(mapping.ok());
  EXPECT_EQ(*mapping, R"({"drives":[]})");
  EXPECT_TRUE(map->verify().ok());
}

TEST_F(MapRecordTest, AMapMayStateNeither) {
  write("", "");
  const auto map = MapReader::open(file_);
  ASSERT_TRUE(map.ok());
  EXPECT_EQ(map->datum(), "");
  EXPECT_EQ(*map->mapping_document(), "");
  EXPECT_TRUE(map->verify().ok());
}

TEST_F(MapRecordTest, WhatWasChangedAfterwardsIsNotBelieved) {
  for (const char* sql : {"UPDATE meta SET value = '{\"drives\":1}' WHERE key = 'mapping'",
                          "DELETE FROM meta WHERE key = 'mapping'"}) {
    write("ETRF2000", R"({"drives":[]})");
    change(sql);
    const auto map = MapReader::open(file_);
    ASSERT_TRUE(map.ok());  // a vehicle does not need it
    EXPECT_EQ(map->mapping_document().error().code, ErrorCode::corrupt);
    EXPECT_THAT(map->verify().error().line(), HasSubstr("the record of its mapping"));
  }
  write("ETRF2000", "");
  change("INSERT INTO meta VALUES ('mapping', '{}')");
  EXPECT_FALSE(MapReader::open(file_)->verify().ok());
  write("ETRF2000", "");
  change("UPDATE meta SET value = 'ITRF2014' WHERE key = 'datum'");
  EXPECT_EQ(MapReader::open(file_).error().code, ErrorCode::corrupt);
}

TEST_F(MapRecordTest, OtherTextsAreRefused) {
  auto writer = MapWriter::create(file_);
  ASSERT_TRUE(writer.ok());
  EXPECT_FALSE(writer->set_datum("@2020").ok());
  EXPECT_FALSE(writer->set_mapping_document("[]").ok());
}

}  // namespace
}  // namespace milepost
