#include "schema/base/file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>
#include <thread>

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

TEST(File, ALinkStaysAndWhatItLeadsToIsReplaced) {
  const testing::TempFolder folder;
  fs::create_directory(folder / "sub");
  fs::create_symlink("sub/target", folder / "link");
  fs::create_symlink(folder / "link", folder / "chain");
  for (const std::string content : {"made", "replaced"}) {
    ASSERT_TRUE(write_text_file(folder / "chain", content).ok());
    EXPECT_TRUE(fs::is_symlink(folder / "chain"));
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_FALSE(fs::is_symlink(folder / "sub" / "target"));
    EXPECT_EQ(*read_text_file(folder / "sub" / "target"), content);
  }
  EXPECT_EQ(files_in(folder / "sub"), 1);
}

TEST(File, APipeIsWrittenToAndStaysAPipe) {
  const testing::TempFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::string read;
  std::thread reader([&] { std::getline(std::ifstream(folder / "pipe"), read, '\0'); });
  EXPECT_TRUE(write_text_file(folder / "pipe", "two\nlines").ok());
  reader.join();
  EXPECT_EQ(read, "two\nlines");
  EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
  EXPECT_EQ(files_in(folder.path()), 1);
}

TEST(File, APipeIsNeverReplaced) {
  const testing::TempFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const fs::path partial = partial_path_for(folder / "pipe");
  std::ofstream(partial) << "x";
  const Status status = publish_file(partial, folder / "pipe");
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().line(), HasSubstr("pipe: cannot be replaced (it is not a regular"));
  EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
  EXPECT_FALSE(fs::exists(partial));
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
