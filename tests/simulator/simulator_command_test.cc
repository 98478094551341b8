// The program milepost-simulator, run as a user runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

#include "schema/drive/drive.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using ::testing::HasSubstr;

struct Outcome {
  int exit_code = -1;
  std::string output;  // both streams
};

Outcome run_simulator(const std::string& arguments) {
  const std::string command = std::string(MILEPOST_SIMULATOR) + " " + arguments + " 2>&1";
  Outcome outcome;
  std::FILE* pipe = ::popen(command.c_str(), "r");
  std::array<char, 4096> buffer;
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    outcome.output.append(buffer.data(), count);
  }
  outcome.exit_code = WEXITSTATUS(::pclose(pipe));
  return outcome;
}

TEST(SimulatorCommand, WritesBothDrivesAndSaysNothingInAPipe) {
  const testing::TempFolder folder;
  const Outcome outcome =
      run_simulator("--out " + folder.path().string() + " --length-m 10 --seed 7 --query");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.output, "");
  EXPECT_TRUE(read_drive(folder / "street-map").ok());
  EXPECT_TRUE(read_drive(folder / "street-query").ok());
}

TEST(SimulatorCommand, Teaches) {
  const Outcome outcome = run_simulator("--help");
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* option : {"--out", "--length-m", "--seed", "--query", "street-map"}) {
    EXPECT_THAT(outcome.output, HasSubstr(option));
  }
}

TEST(SimulatorCommand, RefusesAWrongCall) {
  EXPECT_EQ(run_simulator("").exit_code, 2);
  EXPECT_EQ(run_simulator("--out /nowhere --length-m 0").exit_code, 2);
  EXPECT_EQ(run_simulator("--out /nowhere --no-such-option").exit_code, 2);
}

TEST(SimulatorCommand, NamesWhatFailedInOneLine) {
  const Outcome outcome = run_simulator("--out /dev/null/x --length-m 10");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.output,
              ::testing::MatchesRegex("milepost-simulator: /dev/null/x/street-map/frames: cannot "
                                      "be made [^\n]*\n"));
}

}  // namespace
}  // namespace milepost
