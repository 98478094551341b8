// Options for one number: their help text, and the values that they reject.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "schema/command/command.h"

namespace milepost {
namespace {

using ::testing::ContainsRegex;
using ::testing::Not;

TEST(NumberOption, ItsHelpIsInWordsAndPlainDigits) {
  CLI::App app;
  int features = 1000;
  float contrast = 0.04F;
  double length_m = 0.5;
  add_number(app, "--features", features, "N", "Features kept of a frame", 0, 1000000);
  add_number(app, "--contrast", contrast, "X", "Least contrast", 0, 1);
  add_number(app, "--length-m", length_m, "M", "Length", 0.01, 1e6);
  const std::string help = app.help();
  EXPECT_THAT(help, ContainsRegex("--features N +Features kept of a frame "
                                  "\\(0 to 1000000, default 1000\\)\n"));
  EXPECT_THAT(help, ContainsRegex("--contrast X +Least contrast \\(0 to 1, default 0.04\\)\n"));
  EXPECT_THAT(help, ContainsRegex("--length-m M +Length \\(0.01 to 1000000, default 0.5\\)\n"));
  EXPECT_THAT(help, Not(ContainsRegex("INT|FLOAT|e\\+")));
}

TEST(NumberOption, RefusesWhatIsOutOfRange) {
  CLI::App app;
  int value = 3;
  add_number(app, "--value", value, "N", "A value", 1, 5);
  for (const char* word : {"0", "6", "two", "2.5"}) {
    EXPECT_THROW(app.parse(std::string("--value ") + word), CLI::ParseError) << word;
  }
  for (const int taken : {1, 5}) {
    app.parse("--value " + std::to_string(taken));
    EXPECT_EQ(value, taken);
  }
}

TEST(InDigits, WritesAnyNumberInFull) {
  EXPECT_EQ(in_digits(-12), "-12");
  EXPECT_EQ(in_digits(256U), "256");
  EXPECT_EQ(in_digits(0.1), "0.1");
  EXPECT_EQ(in_digits(1e-3F), "0.001");
  EXPECT_EQ(in_digits(-1.7976931348623157e308).size(), 310U);
}

}  // namespace
}  // namespace milepost
