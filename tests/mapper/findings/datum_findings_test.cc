#include "mapper/findings/datum_findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace milepost {
namespace {

using ::testing::HasSubstr;

Drive drive(const std::string& name, const std::string& datum) {
  Drive made;
  made.name = name;
  made.folder = "drives/" + name;
  made.frames.resize(3);
  if (!datum.empty()) made.datum = *Datum::from(datum);
  return made;
}

TEST(DatumFindings, DrivesOfOneDatumGiveIt) {
  const auto both = common_datum({drive("b", "ITRF2014@2020.4"), drive("a", "ITRF2014@2020.5")});
  ASSERT_TRUE(both.ok());
  EXPECT_EQ(both->text(), "ITRF2014@2020.5");  // of the first by name, whatever their order
  EXPECT_FALSE(common_datum({drive("a", "")})->is_stated());
  EXPECT_TRUE(datum_findings({drive("a", "ETRF2000"), drive("b", "ETRF2000")}).empty());
  EXPECT_TRUE(datum_findings({drive("a", "")}).empty());
}

TEST(DatumFindings, TwoDatumsCannotBeMixed) {
  const auto mixed = common_datum({drive("a", "ITRF2014@2020.5"), drive("b", "ETRF2000")});
  ASSERT_FALSE(mixed.ok());
  EXPECT_THAT(mixed.error().line(), HasSubstr("drives/b/drive.json"));
  EXPECT_THAT(mixed.error().line(), HasSubstr("--to-datum ITRF2014@2020.5"));
}

TEST(DatumFindings, ADriveThatStatesNoneIsToldBesideOthers) {
  const auto findings = datum_findings({drive("a", ""), drive("b", "ETRF2000")});
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].kind, "datum_not_stated");
  EXPECT_EQ(findings[0].where, "drives/a/drive.json");
  EXPECT_EQ(findings[0].count, 3U);
}

}  // namespace
}  // namespace milepost
