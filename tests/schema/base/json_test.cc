#include "schema/base/json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace milepost {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

std::string nested(std::size_t depth) { return repeated("[", depth) + repeated("]", depth); }

std::string refusal(const std::string& text, const JsonLimits& limits = {}) {
  const Result<nlohmann::json> json = read_json(text, limits);
  return json ? "accepted" : json.error().line();
}

TEST(Json, IsReadAsTheLibraryReadsIt) {
  const std::string text =
      R"({"a": [1, -2, 0.5, true, null, "x", {"b": {}}, []], "a2": 18446744073709551615, "": ""})";
  const Result<nlohmann::json> json = read_json(text);
  ASSERT_TRUE(json) << json.error().line();
  EXPECT_EQ(*json, nlohmann::json::parse(text));
}

TEST(Json, OfASingleValueIsRead) {
  EXPECT_EQ(*read_json("7"), 7);
  EXPECT_EQ(*read_json("\"x\""), "x");
  EXPECT_EQ(*read_json(" [] "), nlohmann::json::array());
}

TEST(Json, KeepsTheLastOfEqualMembers) { EXPECT_EQ((*read_json(R"({"a":1,"a":[2]})"))["a"][0], 2); }

TEST(Json, KeepsTheOrderWhereAsked) {
  EXPECT_EQ(read_ordered_json(R"({"b":1,"a":2})")->dump(), R"({"b":1,"a":2})");
}

TEST(Json, ThatIsBrokenIsNamedByItsByte) {
  EXPECT_THAT(refusal("{\"a\": ]}"), AllOf(StartsWith("byte 7: this is not JSON ("),
                                           HasSubstr("unexpected ']'"), HasSubstr("correct")));
  EXPECT_THAT(refusal(""), StartsWith("byte 1: this is not JSON"));
  EXPECT_THAT(refusal("[1] 2"), StartsWith("byte 5: this is not JSON"));
  EXPECT_THAT(refusal("[NaN]"), StartsWith("byte 2: this is not JSON"));
  EXPECT_THAT(refusal("[1e999]"), HasSubstr("this is not JSON"));
  EXPECT_THAT(refusal("\"\xff\""), HasSubstr("this is not JSON"));
}

TEST(Json, ErrorsAreOneShortLine) {
  const std::string line = refusal("[\"" + repeated("long\\u0020", 10000) + "\n\"]");
  EXPECT_LT(line.size(), 400U);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_THAT(refusal("[\"Stra\xdf"), HasSubstr("last read: '\"Stra?')"));
}

TEST(Json, DeepNestingIsRefused) {
  EXPECT_EQ(refusal(nested(32)), "accepted");
  EXPECT_THAT(refusal(nested(33)), HasSubstr("it is nested more than 32 deep"));
  EXPECT_THAT(refusal(nested(1'000'000)), HasSubstr("nested more than 32 deep"));
  EXPECT_THAT(refusal(repeated("[", 2'000'000)), HasSubstr("nested more than 32 deep"));
  EXPECT_THAT(refusal(repeated("{\"a\":", 100'000)), HasSubstr("nested more than 32 deep"));
}

TEST(Json, ManyValuesAreRefused) {
  const JsonLimits few{.values = 4};
  EXPECT_EQ(refusal("[1, 2, 3]", few), "accepted");
  EXPECT_THAT(refusal("[1, 2, 3, 4]", few), HasSubstr("it holds more than 4 values"));
  EXPECT_THAT(refusal("[[], [], [], []]", few), HasSubstr("it holds more than 4 values"));
}

TEST(Json, ObjectsOfManyMembersAreRefused) {
  const JsonLimits few{.members = 2};
  EXPECT_EQ(refusal(R"({"a": 1, "b": {"c": 1, "d": 2}})", few), "accepted");
  EXPECT_THAT(refusal(R"({"a": 1, "b": 2, "c": 3})", few), HasSubstr("more than 2 members"));
}

TEST(Json, LongTextsAreRefusedUnread) {
  EXPECT_THAT(refusal("not JSON", {.bytes = 7}), HasSubstr("it is longer than 7 bytes"));
}

}  // namespace
}  // namespace milepost
