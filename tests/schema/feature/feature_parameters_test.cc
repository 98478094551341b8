#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "schema/feature/types.h"

namespace milepost {
namespace {

using ::testing::HasSubstr;

TEST(FeatureParameters, SurviveTheMap) {
  FeatureParameters parameters;
  parameters.max_features = 700;
  parameters.contrast_threshold = 0.031;
  const auto read = feature_parameters_from_json(to_json(parameters));
  ASSERT_TRUE(read.ok()) << read.error().line();
  EXPECT_EQ(*read, parameters);
}

void expect_refused_parameter(const std::string& text, const std::string& why) {
  const auto read = feature_parameters_from_json(nlohmann::json::parse(text));
  ASSERT_FALSE(read.ok()) << text;
  EXPECT_EQ(read.error().code, ErrorCode::corrupt);
  EXPECT_THAT(read.error().line(), HasSubstr(why));
}

TEST(FeatureParameters, OfAnotherExtractorAreRefused) {
  expect_refused_parameter("[1]", "not a JSON object");
  expect_refused_parameter(R"({"kind":"orb"})", "kind");
  const std::string rest =
      R"("octave_layers":3,"contrast_threshold":0.04,"edge_threshold":10,"sigma":1.6})";
  expect_refused_parameter(R"({"kind":"sift",)" + rest, "max_features");
  expect_refused_parameter(R"({"kind":"sift","max_features":-1,)" + rest,
                           "'max_features' is out of range");
  expect_refused_parameter(R"({"kind":"sift","max_features":"many",)" + rest, "max_features");
  expect_refused_parameter(R"({"kind":"sift","max_features":5,"upright":1,)" + rest,
                           "'upright' is unknown");
}

}  // namespace
}  // namespace milepost
