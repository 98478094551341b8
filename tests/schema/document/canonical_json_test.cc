#include "schema/document/canonical_json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include <nlohmann/json.hpp>

namespace milepost {
namespace {

using nlohmann::json;

std::string written(double number) { return canonical_json(json(number)); }

// RFC 8785, appendix B.
TEST(CanonicalJson, WritesNumbersAsTheStandardDoes) {
  EXPECT_EQ(written(0), "0");
  EXPECT_EQ(written(-0.0), "0");
  EXPECT_EQ(written(5e-324), "5e-324");
  EXPECT_EQ(written(-5e-324), "-5e-324");
  EXPECT_EQ(written(1.7976931348623157e308), "1.7976931348623157e+308");
  EXPECT_EQ(written(9007199254740992), "9007199254740992");
  EXPECT_EQ(written(295147905179352830000.0), "295147905179352830000");
  EXPECT_EQ(written(9.999999999999997e22), "9.999999999999997e+22");
  EXPECT_EQ(written(1e23), "1e+23");
  EXPECT_EQ(written(999999999999999700000.0), "999999999999999700000");
  EXPECT_EQ(written(1e21), "1e+21");
  EXPECT_EQ(written(0.000001), "0.000001");
  EXPECT_EQ(written(9.999999999999997e-7), "9.999999999999997e-7");
  EXPECT_EQ(written(333333333.33333325), "333333333.33333325");
  EXPECT_EQ(written(-0.0000033333333333333333), "-0.0000033333333333333333");
  EXPECT_EQ(written(1424953923781206.2), "1424953923781206.2");
  EXPECT_EQ(written(49), "49");
  EXPECT_EQ(written(8.4), "8.4");
}

TEST(CanonicalJson, ANumberIsRestoredToTheBit) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t bits = random();
    double number = 0;
    std::memcpy(&number, &bits, sizeof number);
    if (!std::isfinite(number)) continue;
    ASSERT_EQ(json::parse(written(number)).get<double>(), number) << written(number);
  }
}

// RFC 8785, 3.2.2 and 3.2.3.
TEST(CanonicalJson, WritesTextAndMembersInOneWay) {
  EXPECT_EQ(
      canonical_json(json::parse(R"({"b": [ 1 , 2.50, true , null], "a" : {"z":1,"\u0041":2}})")),
      R"({"a":{"A":2,"z":1},"b":[1,2.5,true,null]})");
  EXPECT_EQ(canonical_json(json::parse(R"("\u20ac$\u000F\u000aA'\u0042\u0022\u005c\\\"\/")")),
            "\"\u20ac$\\u000f\\nA'B\\\"\\\\\\\\\\\"/\"");
  EXPECT_EQ(canonical_json(json::object()), "{}");
  EXPECT_EQ(canonical_json(json::array()), "[]");
  EXPECT_EQ(canonical_json(18446744073709551615ULL), "18446744073709551615");
}

TEST(CanonicalJson, HowTheTextWasWrittenPlaysNoPart) {
  EXPECT_EQ(canonical_json(json::parse(R"({"focal_px": [400.0, 9E2], "k": 1.10})")),
            canonical_json(json::parse(R"({"k":1.1,"focal_px":[400,900]})")));
}

}  // namespace
}  // namespace milepost
