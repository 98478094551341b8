#include "client/fetch/segment_layer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include <nlohmann/json.hpp>

#include "tests/client/fetch/memory_source.h"
#include "tests/support/descriptors.h"

namespace milepost {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const PcaProjection& projection() {
  static const PcaProjection trained =
      PcaProjection::trained(testing::unlike_descriptors(8, 1), 0.01);
  return trained;
}

nlohmann::json sound_parameters() {
  return {{"items", "landmarks"}, {"focal_px", {400, 900}}, {"codebook", projection().to_json()}};
}

Result<std::shared_ptr<const SegmentLayer>> read_layer(const nlohmann::json& parameters,
                                                       const std::string& layer = "tracklets") {
  const MapVersion town = {"town", "build"};
  const auto source = std::make_shared<testing::MemorySource>(town, "tracklets", parameters);
  source->add({"road", 111, {{49, 8.4, 110}, {49.001, 8.4, 110}}, {{"next", "village"}}}, {});
  const auto read = read_build_layer(*source, town, layer);
  if (!read) return read.error();
  return read_segment_layer(*source, {town, "road"}, layer, *read);
}

std::string message(const nlohmann::json& parameters) {
  const auto layer = read_layer(parameters);
  if (layer) return "no error";
  EXPECT_EQ(layer.error().code, ErrorCode::corrupt);
  return layer.error().line();
}

TEST(SegmentLayer, OfLandmarksHasACodebook) {
  const auto layer = read_layer(sound_parameters());
  ASSERT_TRUE(layer.ok()) << layer.error().line();
  EXPECT_EQ((*layer)->parameters().items, LayerItems::landmarks);
  EXPECT_EQ((*layer)->parameters().projection, projection());
  EXPECT_EQ((*layer)->parameters().focal_px(), 600);
  EXPECT_EQ((*layer)->parameters().camera_model, CameraModel::pinhole);
  EXPECT_NEAR((*layer)->line.length_m(), 111.2, 0.1);
  EXPECT_EQ((*layer)->successors, (std::vector<Successor>{{"next", "village"}}));
}

TEST(SegmentLayer, OfOtherItemsHasNone) {
  const auto layer = read_layer({{"items", "tracklets"}, {"focal_px", {400, 400}}});
  ASSERT_TRUE(layer.ok()) << layer.error().line();
  EXPECT_EQ((*layer)->parameters().items, LayerItems::tracklets);
  EXPECT_FALSE((*layer)->parameters().projection);
}

TEST(SegmentLayer, OfLandmarksWithoutASoundCodebookIsCorrupt) {
  const std::vector<std::function<void(nlohmann::json&)>> ways_to_break = {
      [](auto& json) { json.erase("codebook"); },
      [](auto& json) { json["codebook"] = 5; },
      [](auto& json) { json["codebook"] = nlohmann::json::array(); },
      [](auto& json) { json["codebook"].erase("version"); },
      [](auto& json) { json["codebook"].erase("step"); },
      [](auto& json) { json["codebook"]["step"] = -1; },
      [](auto& json) { json["codebook"]["axes"] = "AAAA"; },
      [](auto& json) { json["codebook"]["colour"] = "blue"; },
  };
  for (const auto& break_it : ways_to_break) {
    nlohmann::json parameters = sound_parameters();
    break_it(parameters);
    EXPECT_THAT(message(parameters),
                AllOf(HasSubstr("map 'town', layer 'tracklets'"), HasSubstr("codebook"),
                      HasSubstr("rebuild the map"), Not(HasSubstr("\n"))));
  }
}

TEST(SegmentLayer, OfBrokenParametersIsCorrupt) {
  EXPECT_THAT(message("landmarks"), HasSubstr("not a JSON object"));
  nlohmann::json parameters = sound_parameters();
  parameters["items"] = "houses";
  EXPECT_THAT(message(parameters), HasSubstr("items"));
  parameters = sound_parameters();
  parameters["focal_px"] = {400};
  EXPECT_THAT(message(parameters), HasSubstr("focal_px"));
  for (const auto& [x_px, y_px] :
       std::vector<std::pair<double, double>>{{400, -400}, {-400, -400}, {0, 400}, {400, 1e7}}) {
    parameters["focal_px"] = {x_px, y_px};
    EXPECT_THAT(message(parameters), HasSubstr("focal_px"));
  }
  parameters = sound_parameters();
  for (const nlohmann::json& model : {nlohmann::json("fisheye"), nlohmann::json(7)}) {
    parameters["camera_model"] = model;
    EXPECT_THAT(message(parameters), HasSubstr("camera_model"));
  }
  parameters["camera_model"] = "pinhole";
  EXPECT_EQ(message(parameters), "no error");
}

TEST(SegmentLayer, ALayerThatTheMapLacksIsNamed) {
  const auto layer = read_layer(sound_parameters(), "frames");
  ASSERT_FALSE(layer.ok());
  EXPECT_EQ(layer.error().code, ErrorCode::invalid_input);
  EXPECT_THAT(layer.error().line(), AllOf(HasSubstr("'frames'"), HasSubstr("--lab")));
}

}  // namespace
}  // namespace milepost
