// Subcommands: which one runs, what --help and --version print, what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "schema/command/command.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

struct Called {
  int code = 0;
  std::string output;
  std::string errors;
};

class ProgramTest : public ::testing::Test {
 protected:
  Called call(std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "milepost-test");
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    Called called;
    called.code =
        run_program("milepost-test", "Tests.", {{"count", add_count()}, {"idle", add_idle}},
                    static_cast<int>(arguments.size()), arguments.data());
    called.output = ::testing::internal::GetCapturedStdout();
    called.errors = ::testing::internal::GetCapturedStderr();
    return called;
  }

  void expect_refused(const std::vector<const char*>& arguments, const std::string& line) {
    const Called called = call(arguments);
    EXPECT_EQ(called.code, kExitWrongCall);
    EXPECT_EQ(called.errors, line + "\n");
    EXPECT_THAT(called.output, IsEmpty());
    EXPECT_EQ(counted_, 0);
  }

  int counted_ = 0;

 private:
  std::function<RunCommand(CLI::App&)> add_count() {
    return [this](CLI::App& app) -> RunCommand {
      app.description("Counts.\n\nUp to a number.");
      const auto number = std::make_shared<int>(0);
      add_number(app, "--number", *number, "N", "The number", 0, 10);
      app.add_option("--name", "A name")->required()->option_text("NAME");
      return [this, number] {
        counted_ = *number;
        return 7;
      };
    };
  }

  static RunCommand add_idle(CLI::App& app) {
    app.description("Does nothing.");
    return [] { return kExitDone; };
  }
};

TEST_F(ProgramTest, RunsTheNamedCommand) {
  EXPECT_EQ(call({"count", "--name", "a", "--number", "4"}).code, 7);
  EXPECT_EQ(counted_, 4);
  EXPECT_EQ(call({"idle"}).code, kExitDone);
}

TEST_F(ProgramTest, ItsHelpListsTheCommandsByTheirFirstLine) {
  for (const char* flag : {"--help", "-h"}) {
    const Called called = call({flag});
    EXPECT_EQ(called.code, kExitDone);
    EXPECT_THAT(called.output,
                AllOf(HasSubstr("Tests."), HasSubstr("milepost-test [OPTIONS] COMMAND"),
                      HasSubstr("count       Counts.\n"), Not(HasSubstr("Up to")),
                      HasSubstr("idle"), HasSubstr("'milepost-test COMMAND --help'")));
  }
}

TEST_F(ProgramTest, TheHelpOfACommandHasItsOptions) {
  const Called called = call({"count", "--help"});
  EXPECT_EQ(called.code, kExitDone);
  EXPECT_THAT(called.output,
              AllOf(HasSubstr("Up to a number."), HasSubstr("Usage: milepost-test count"),
                    HasSubstr("--number N"), HasSubstr("--name NAME"), HasSubstr("--config FILE"),
                    Not(HasSubstr("COMMAND --help"))));
}

TEST_F(ProgramTest, TellsTheVersion) {
  EXPECT_THAT(call({"--version"}).output, HasSubstr("milepost-test 0."));
  EXPECT_THAT(call({"count", "--version"}).output, HasSubstr("milepost-test count 0."));
}

TEST_F(ProgramTest, RefusesWrongCallsInOneLine) {
  expect_refused({}, "milepost-test: a command is missing; see 'milepost-test --help'");
  expect_refused({"cuont"}, "milepost-test: 'cuont' is not a command; see 'milepost-test --help'");
  expect_refused({"count"},
                 "milepost-test count: --name is required; see 'milepost-test count --help'");
  expect_refused({"count", "--name", "a", "--nmuber", "4"},
                 "milepost-test count: The following arguments were not expected: 4 --nmuber; see "
                 "'milepost-test count --help'");
}

class ProgramConfigTest : public ProgramTest {
 protected:
  std::string write(const std::string& text) {
    const auto file = folder_.path() / "test.conf";
    std::ofstream(file) << text;
    return file.string();
  }

  testing::TempFolder folder_;
};

TEST_F(ProgramConfigTest, OptionsOnTheCommandLineTakePrecedenceOverAFile) {
  const std::string file = write("# a comment\nname = b\nnumber = 3\n");
  EXPECT_EQ(call({"count", "--config", file.c_str()}).code, 7);
  EXPECT_EQ(counted_, 3);
  EXPECT_EQ(call({"count", "--config", file.c_str(), "--number", "5"}).code, 7);
  EXPECT_EQ(counted_, 5);
}

TEST_F(ProgramConfigTest, RefusesUnknownKeysAndFiles) {
  const std::string file = write("nmuber = 3\n");
  const Called unknown = call({"count", "--name", "a", "--config", file.c_str()});
  EXPECT_EQ(unknown.code, kExitWrongCall);
  EXPECT_THAT(unknown.errors,
              HasSubstr("milepost-test count: --config: the file has the unknown key "
                        "'nmuber'; see"));
  const Called missing = call({"count", "--name", "a", "--config", "missing.conf"});
  EXPECT_EQ(missing.code, kExitWrongCall);
  EXPECT_THAT(missing.errors, HasSubstr("missing.conf"));
  EXPECT_EQ(counted_, 0);
}

}  // namespace
}  // namespace milepost
