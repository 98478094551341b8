#include "client/localize/segment_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include <nlohmann/json.hpp>

#include "tests/client/localize/landmark_road.h"
#include "tests/client/localize/layer_of_tiles.h"

namespace milepost {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const Codebook& codebook() {
  static const Codebook trained = Codebook::trained(testing::unlike_descriptors(8, 1), 0.01);
  return trained;
}

nlohmann::json sound_parameters() {
  return {{"items", "landmarks"},
          {"focal_px", {400, 900}},
          {"codebook", nlohmann::json::parse(codebook().to_json())}};
}

// A map of one road with one layer.
class MapWithLayer : public testing::LayerOfTiles {
 public:
  explicit MapWithLayer(std::string parameters)
      : LayerOfTiles({}), parameters_(std::move(parameters)) {}

  Result<MapDescription> describe(const MapVersion& version) override {
    return MapDescription{version, {{"tracklets", parameters_}}, to_json(FeatureParameters())};
  }
  Result<SegmentDescription> segment(const MapVersion& /*version*/,
                                     const std::string& /*segment*/) override {
    return SegmentDescription{"road", 111, {{49, 8.4, 110}, {49.001, 8.4, 110}}, {}};
  }

 private:
  std::string parameters_;
};

Result<SegmentSession> session_of(const nlohmann::json& parameters,
                                  const std::string& layer = "tracklets") {
  return open_session(
      {std::make_shared<MapWithLayer>(parameters.dump()), {"town", "build"}, "road", layer});
}

std::string message(const nlohmann::json& parameters) {
  const auto session = session_of(parameters);
  if (session) return "no error";
  EXPECT_EQ(session.error().code, ErrorCode::corrupt);
  return session.error().line();
}

TEST(SegmentSession, OfLandmarksHasACodebook) {
  const auto session = session_of(sound_parameters());
  ASSERT_TRUE(session.ok()) << session.error().line();
  EXPECT_EQ(session->items, LayerItems::landmarks);
  EXPECT_EQ(session->codebook, codebook());
  EXPECT_EQ(session->map_focal_px, 600);
  EXPECT_NEAR(session->line.length_m(), 111.2, 0.1);
}

TEST(SegmentSession, OfOtherItemsHasNone) {
  const auto session = session_of({{"items", "tracklets"}, {"focal_px", {400, 400}}});
  ASSERT_TRUE(session.ok()) << session.error().line();
  EXPECT_EQ(session->items, LayerItems::tracklets);
  EXPECT_FALSE(session->codebook);
}

TEST(SegmentSession, OfLandmarksWithoutASoundCodebookIsCorrupt) {
  const std::vector<std::function<void(nlohmann::json&)>> ways_to_break = {
      [](auto& json) { json.erase("codebook"); },
      [](auto& json) { json["codebook"] = 5; },
      [](auto& json) { json["codebook"] = nlohmann::json::array(); },
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
                      HasSubstr("build the map anew"), Not(HasSubstr("\n"))));
  }
}

TEST(SegmentSession, OfBrokenParametersIsCorrupt) {
  EXPECT_THAT(message("landmarks"), HasSubstr("no JSON object"));
  nlohmann::json parameters = sound_parameters();
  parameters["items"] = "houses";
  EXPECT_THAT(message(parameters), HasSubstr("items"));
  parameters = sound_parameters();
  parameters["focal_px"] = {400};
  EXPECT_THAT(message(parameters), HasSubstr("focal_px"));
  parameters["focal_px"] = {400, -400};
  EXPECT_THAT(message(parameters), HasSubstr("focal_px"));
}

TEST(SegmentSession, ALayerThatTheMapLacksIsNamed) {
  const auto session = session_of(sound_parameters(), "frames");
  ASSERT_FALSE(session.ok());
  EXPECT_EQ(session.error().code, ErrorCode::invalid_input);
  EXPECT_THAT(session.error().line(), AllOf(HasSubstr("'frames'"), HasSubstr("--lab")));
}

}  // namespace
}  // namespace milepost
