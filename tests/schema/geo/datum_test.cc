#include "schema/geo/datum.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace milepost {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

Datum datum(const std::string& text) { return *Datum::from(text); }

TEST(Datum, IsAFrameWithOrWithoutAnEpoch) {
  EXPECT_EQ(datum("ETRF2000").name, "ETRF2000");
  EXPECT_FALSE(datum("ETRF2000").epoch.has_value());
  EXPECT_EQ(datum("ITRF2014@2020.5").epoch, 2020.5);
  EXPECT_EQ(datum("NAD83(2011)").text(), "NAD83(2011)");
  EXPECT_EQ(datum("ITRF2014@2020.50").text(), "ITRF2014@2020.5");
  EXPECT_FALSE(Datum().is_stated());
}

TEST(Datum, OtherTextsAreRefused) {
  for (const char* text : {"", "@2020", "ITRF2014@", "ITRF2014@now", "ITRF2014@20", "ITRF2014@1e9",
                           "ITRF2014@2020@2021", "a\nb", "\xff"}) {
    const auto read = Datum::from(text);
    ASSERT_FALSE(read.ok()) << text;
    EXPECT_THAT(read.error().line(), HasSubstr("no datum"));
  }
  EXPECT_FALSE(Datum::from(std::string(65, 'a')).ok());
}

TEST(Datum, OneFrameAgreesWithinHalfAYear) {
  EXPECT_TRUE(agree(datum("ITRF2014@2020.5"), datum("ITRF2014@2020.9")));
  EXPECT_FALSE(agree(datum("ITRF2014@2020.5"), datum("ITRF2014@2021.2")));
  EXPECT_FALSE(agree(datum("ITRF2014@2020.5"), datum("ETRF2000")));
  EXPECT_TRUE(agree(datum("ITRF2014@2020.5"), datum("ITRF2014")));
  EXPECT_TRUE(agree(datum("ITRF2014@2020.5"), Datum()));
}

TEST(Datum, AnErrorNamesBothAndTheMend) {
  EXPECT_TRUE(check_agree(datum("ETRF2000"), "a", datum("ETRF2000"), "b").ok());
  const Status mixed =
      check_agree(datum("ETRF2000"), "monday/drive.json", datum("ITRF2014@2020.5"), "map 'town'");
  ASSERT_FALSE(mixed.ok());
  EXPECT_THAT(mixed.error().line(),
              AllOf(HasSubstr("monday/drive.json"), HasSubstr("ETRF2000"), HasSubstr("map 'town'"),
                    HasSubstr("--to-datum ITRF2014@2020.5")));
}

}  // namespace
}  // namespace milepost
