#include "server/log/log_writer.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <array>
#include <string>
#include <thread>

namespace milepost::server {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

// A pipe of one page. The write end stays open, as LogWriter requires.
class LogWriterTest : public ::testing::Test {
 protected:
  LogWriterTest() {
    if (pipe(ends_.data()) != 0) abort();
    fcntl(ends_[1], F_SETPIPE_SZ, 4096);
  }
  ~LogWriterTest() override { close_reader(); }

  void close_reader() {
    if (ends_[0] >= 0) ::close(ends_[0]);
    ends_[0] = -1;
  }

  // The output of the pipe up to the end of `last`.
  std::string read_until(const std::string& last) const {
    std::string text;
    for (char c = 0; !text.ends_with(last) && ::read(ends_[0], &c, 1) == 1;) text += c;
    return text;
  }

  static std::string line(std::uint64_t number) {
    std::string text = std::to_string(number);
    return text + std::string(99 - text.size(), '.') + '\n';
  }

  std::array<int, 2> ends_{};
};

// The number in a line that reports missing lines; 0 for any other.
std::uint64_t missing_lines(const std::string& text) {
  const std::string start = "milepost-server: ";
  const bool speaks =
      text.starts_with(start) && text.ends_with(
                                     " lines of the log are missing before this one; they could "
                                     "not be written\n");
  return speaks ? std::stoull(text.substr(start.size())) : 0;
}

// Waits, because the writer has its own thread.
void expect_dropped(const LogWriter& writer, std::uint64_t lines) {
  for (int i = 0; i < 3000 && writer.dropped() < lines; ++i) std::this_thread::sleep_for(10ms);
  EXPECT_EQ(writer.dropped(), lines);
}

TEST_F(LogWriterTest, WritesEveryLineInOrder) {
  LogWriter writer(ends_[1]);
  std::string all;
  for (int i = 0; i < 1000; ++i) {
    writer.write(line(i));
    all += line(i);
  }
  EXPECT_EQ(read_until(line(999)), all);
  EXPECT_TRUE(writer.close(1h));
  EXPECT_EQ(writer.dropped(), 0U);
}

TEST_F(LogWriterTest, NeverWaitsAndSaysWhatIsMissing) {
  LogWriter writer(ends_[1], 10'000);
  constexpr std::uint64_t kLines = 10'000;
  for (std::uint64_t i = 0; i < kLines; ++i) writer.write(line(i));
  const std::uint64_t dropped = writer.dropped();
  EXPECT_GT(dropped, kLines / 2);
  std::uint64_t reported = 0;
  std::uint64_t written = 0;
  while (written + reported < kLines) {
    const std::string text = read_until("\n");
    const std::uint64_t missing = missing_lines(text);
    reported += missing;
    if (missing == 0) {
      EXPECT_EQ(text, line(written + reported));  // each gap is reported in its place
      ++written;
    }
  }
  EXPECT_EQ(reported, dropped);
  writer.write(line(1));
  EXPECT_EQ(read_until("\n"), line(1));
  EXPECT_EQ(writer.dropped(), dropped);
}

TEST_F(LogWriterTest, LinesThatAreRefusedAreCounted) {
  const int full = ::open("/dev/full", O_WRONLY);
  ASSERT_GE(full, 0);
  LogWriter writer(full);
  writer.write("one\n");
  expect_dropped(writer, 1);
  writer.write("two\n");
  expect_dropped(writer, 2);
  ASSERT_EQ(dup2(ends_[1], full), full);  // now there is room again
  writer.write("three\n");
  EXPECT_EQ(read_until("written\n"),
            "three\nmilepost-server: 2 lines of the log are missing before this one; they could "
            "not be written\n");
  EXPECT_TRUE(writer.close(1h));
  ::close(full);
}

TEST_F(LogWriterTest, ReaderThatGoesAwayIsNoSignal) {
  close_reader();
  LogWriter writer(ends_[1]);
  writer.write("one\n");
  expect_dropped(writer, 1);
}

TEST_F(LogWriterTest, DescriptorThatAnotherProcessMadeNonBlockingLosesNothing) {
  ASSERT_EQ(fcntl(ends_[1], F_SETFL, O_NONBLOCK), 0);
  LogWriter writer(ends_[1]);
  for (int i = 0; i < 1000; ++i) writer.write(line(i));
  std::this_thread::sleep_for(20ms);
  EXPECT_THAT(read_until(line(999)), HasSubstr(line(500)));
  EXPECT_EQ(writer.dropped(), 0U);
}

TEST_F(LogWriterTest, CloseGivesUpOnAPipeThatNobodyReads) {
  LogWriter writer(ends_[1]);
  for (int i = 0; i < 1000; ++i) writer.write(line(i));
  EXPECT_FALSE(writer.close(10ms));
  writer.write("too late\n");
  EXPECT_EQ(writer.dropped(), 1U);
}

}  // namespace
}  // namespace milepost::server
