#include "schema/base/file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::ptrdiff_t files_in(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST(File, ReadsBackWhatWasWritten) {
  const testing::TempFolder folder;
  const std::string content("a\0b\r\n\xff", 6);
  ASSERT_TRUE(write_text_file(folder / "f", content).ok());
  EXPECT_EQ(*read_text_file(folder / "f"), content);
}

TEST(File, ReplacesAFileAndLeavesNothingBeside) {
  const testing::TempFolder folder;
  ASSERT_TRUE(write_text_file(folder / "f", "old and long").ok());
  ASSERT_TRUE(write_text_file(folder / "f", "new").ok());
  EXPECT_EQ(*read_text_file(folder / "f"), "new");
  EXPECT_EQ(files_in(folder.path()), 1);
}

TEST(File, AnOpenReaderKeepsTheOldContent) {
  const testing::TempFolder folder;
  ASSERT_TRUE(write_text_file(folder / "f", "old").ok());
  std::ifstream reader(folder / "f");
  ASSERT_TRUE(write_text_file(folder / "f", "new").ok());
  std::string content;
  reader >> content;
  EXPECT_EQ(content, "old");
}

TEST(File, ReadingNamesAMissingFile) {
  const testing::TempFolder folder;
  const auto content = read_text_file(folder / "none");
  ASSERT_FALSE(content.ok());
  EXPECT_EQ(content.error().code, ErrorCode::not_found);
  EXPECT_THAT(content.error().line(), HasSubstr("none: there is no such file"));
}

TEST(File, ReadingRefusesAFolder) {
  const testing::TempFolder folder;
  const auto content = read_text_file(folder.path());
  ASSERT_FALSE(content.ok());
  EXPECT_EQ(content.error().code, ErrorCode::io);
}

TEST(File, WritingNamesAMissingFolder) {
  const testing::TempFolder folder;
  const Status status = write_text_file(folder / "none" / "f", "x");
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::io);
  EXPECT_THAT(status.error().line(), HasSubstr("none/f: cannot be written (No such file"));
}

TEST(File, APartialFileLiesHiddenBesideItsPlace) {
  const fs::path partial = partial_path_for("maps/town.map");
  EXPECT_EQ(partial.parent_path(), "maps");
  EXPECT_TRUE(partial.filename().string().starts_with(".town.map."));
  EXPECT_EQ(partial_path_for("town.map").parent_path(), ".");
}

TEST(File, AFailedPublishRemovesThePartialFile) {
  const testing::TempFolder folder;
  fs::create_directories(folder / "taken" / "full");  // a folder cannot be replaced by a file
  const fs::path partial = partial_path_for(folder / "taken");
  std::ofstream(partial) << "x";
  const Status status = publish_file(partial, folder / "taken");
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::io);
  EXPECT_THAT(status.error().line(), HasSubstr("taken: cannot be replaced"));
  EXPECT_FALSE(fs::exists(partial));
}

}  // namespace
}  // namespace milepost
