#include "schema/base/output_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <fstream>

#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr OutputKind kRhymes = {
    "a rhyme", [](std::string_view head) { return head.starts_with("Roses"); }, true};
constexpr OutputKind kWholeRhymes = {"a rhyme", kRhymes.begins_with, false};

class OutputFile : public ::testing::Test {
 protected:
  fs::path file(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name) << content;
    return folder_ / name;
  }

  static std::string asked(const fs::path& out, const std::vector<fs::path>& inputs = {},
                           const OutputKind& kind = kRhymes) {
    const Status status = check_outputs({{"--out", out, &kind}}, inputs);
    return status.ok() ? "free" : status.error().line();
  }

  testing::TempFolder folder_;
};

TEST_F(OutputFile, MayBeNewOrOfItsKindOrEmpty) {
  EXPECT_EQ(asked(folder_ / "new.txt"), "free");
  EXPECT_EQ(asked(file("old.txt", "Roses are red")), "free");
  EXPECT_EQ(asked(file("made-by-mktemp", "")), "free");
}

TEST_F(OutputFile, OfAnotherKindIsNotReplaced) {
  const fs::path letter = file("letter.txt", "Dear reader");
  EXPECT_EQ(asked(letter), letter.string() +
                               ": the existing file is not a rhyme, so it is not replaced; "
                               "give another file with --out, or remove this one first");
  EXPECT_THAT(asked(file("short.txt", "R")), HasSubstr("is not a rhyme"));
}

TEST_F(OutputFile, IsNoInputByWhateverName) {
  const fs::path poem = file("poem.txt", "Roses are red");
  const std::string refusal =
      ": the command reads this file, and would replace it; give another file with --out";
  fs::create_directory(folder_ / "sub");
  fs::create_symlink(poem, folder_ / "link.txt");
  fs::create_symlink("link.txt", folder_ / "chain.txt");
  fs::create_hard_link(poem, folder_ / "hard.txt");
  for (const char* name : {"poem.txt", "link.txt", "chain.txt", "hard.txt", "sub/../poem.txt"}) {
    EXPECT_EQ(asked(folder_ / name, {file("other.txt", "x"), poem}),
              (folder_ / name).string() + refusal);
  }
  EXPECT_EQ(asked(fs::relative(poem), {poem}), fs::relative(poem).string() + refusal);
}

TEST_F(OutputFile, IsNoInputThatIsNotThereYet) {
  fs::create_directory(folder_ / "drive");
  fs::create_directory_symlink(folder_ / "drive", folder_ / "link");
  for (const char* name : {"drive/gps.csv", "link/gps.csv", "drive/../drive/gps.csv"}) {
    EXPECT_THAT(asked(folder_ / name, {folder_ / "drive" / "gps.csv"}),
                HasSubstr("the command reads this file"));
  }
  EXPECT_EQ(asked(folder_ / "gps.csv", {folder_ / "drive" / "gps.csv"}), "free");
}

TEST_F(OutputFile, ALinkCountsAsWhatItLeadsTo) {
  fs::create_symlink(file("rhyme.txt", "Roses are red"), folder_ / "rhyme");
  fs::create_symlink(file("letter.txt", "Dear reader"), folder_ / "letter");
  fs::create_symlink(folder_ / "nothing.txt", folder_ / "nothing");
  EXPECT_EQ(asked(folder_ / "rhyme"), "free");
  EXPECT_EQ(asked(folder_ / "nothing"), "free");
  EXPECT_THAT(asked(folder_ / "letter"), HasSubstr("is not a rhyme"));
}

TEST_F(OutputFile, IsNoFolder) {
  EXPECT_EQ(asked(folder_.path()),
            folder_.path().string() + ": this is a folder; give a file with --out");
  EXPECT_EQ(asked(folder_ / "new/"), (folder_ / "new/").string() +
                                         ": this is not the name of a file; give a file with "
                                         "--out");
  EXPECT_THAT(asked(""), HasSubstr("this is not the name of a file"));
}

TEST_F(OutputFile, NeedsItsFolder) {
  EXPECT_EQ(asked(folder_ / "none" / "new.txt"),
            (folder_ / "none" / "new.txt").string() + ": there is no folder " +
                (folder_ / "none").string() + "; create it, or give another file with --out");
}

TEST_F(OutputFile, APipeOrADeviceTakesWhatIsWrittenInOneGo) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  for (const fs::path& stream : {folder_ / "pipe", fs::path("/dev/null")}) {
    EXPECT_EQ(asked(stream), "free");
    EXPECT_EQ(asked(stream, {}, kWholeRhymes),
              stream.string() +
                  ": a rhyme is not written to a device or a pipe; give a regular file with --out");
  }
}

TEST_F(OutputFile, ASocketIsNoFile) {
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, (folder_ / "socket").c_str(), sizeof address.sun_path - 1);
  ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ::close(socket);
  EXPECT_THAT(asked(folder_ / "socket"), HasSubstr("this is not a regular file"));
}

TEST_F(OutputFile, TwoOutputsAreTwoFiles) {
  const auto asked_both = [&](const std::string& second) {
    const Status status = check_outputs(
        {{"--out", folder_ / "a.txt", &kRhymes}, {"--report", folder_ / second, &kRhymes}}, {});
    return status.ok() ? "free" : status.error().line();
  };
  EXPECT_EQ(asked_both("b.txt"), "free");
  EXPECT_EQ(asked_both("a.txt"), (folder_ / "a.txt").string() +
                                     ": --out and --report name the same file; give each a file of "
                                     "its own");
  fs::create_hard_link(file("a.txt", ""), folder_ / "b.txt");
  EXPECT_THAT(asked_both("b.txt"), HasSubstr("name the same file"));
  EXPECT_TRUE(
      check_outputs({{"--out", "/dev/null", &kRhymes}, {"--report", "/dev/null", &kRhymes}}, {})
          .ok());
}

TEST(BeginsWithoutSpace, PassesOverHowJsonIsLaidOut) {
  EXPECT_TRUE(begins_without_space("[{\"a\":1}]", "[{\"a\":"));
  EXPECT_TRUE(begins_without_space("\r\n[\n\t{ \"a\" : 1}]", "[{\"a\":"));
  EXPECT_FALSE(begins_without_space("[{\"b\":1}]", "[{\"a\":"));
  EXPECT_FALSE(begins_without_space("[{\"a\"", "[{\"a\":"));
}

}  // namespace
}  // namespace milepost
