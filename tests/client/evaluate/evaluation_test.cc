// Fixes compared with the ground truth: arc length, lateral offset and heading, and the output
// files.
#include "client/evaluate/evaluation.h"

#include <gmock/gmock.h>

#include <limits>

#include <nlohmann/json.hpp>

#include "client/evaluate/output.h"
#include "tests/client/fetch/memory_source.h"

namespace milepost {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// A road that runs 100 m to the north: lateral is positive to the right, to the east.
constexpr double kRoadM = 100;
constexpr double kMm = 0.001;

GeoPoint at(double east_m, double north_m) {
  static const LocalFrame frame({49.0, 8.4, 0});
  return frame.geo_from_enu({east_m, north_m, 0});
}

// A map of that road, with 200 kB in every layer.
class RoadMap : public testing::MemorySource {
 public:
  RoadMap() : MemorySource({"town", "b1"}, "layer", nlohmann::json::object()) {
    add({"road", kRoadM, {at(0, 0), at(0, kRoadM)}, {}}, {});
  }
  Result<std::vector<NearbySegment>> segments_near(const GeoPoint& /*position*/,
                                                   double /*radius_m*/) override {
    return std::vector<NearbySegment>{{{"town", "b1"}, "road", 0, 0, kRoadM}};
  }
  Result<std::uint64_t> layer_bytes(const MapVersion& /*version*/, const std::string& /*segment*/,
                                    const std::string& /*layer*/) override {
    return std::uint64_t{200'000};
  }
};

// The method's fix of a frame.
struct Pose {
  std::optional<double> along_m;
  std::optional<double> lateral_m = {};
  std::optional<double> heading_deg = {};
  std::optional<double> lateral_sigma_m = {};
};

FrameFix fix_of(const Pose& pose, const std::string& filename) {
  FrameFix frame;
  frame.filename = filename;
  frame.fix.status = pose.along_m ? FixStatus::tracking : FixStatus::lost;
  if (pose.along_m) {
    frame.fix.version = {"town", "b1"};
    frame.fix.segment = "road";
  }
  frame.fix.along_m = pose.along_m;
  frame.fix.sigma_m = 0.2;
  frame.fix.sigma_map_m = 0.05;
  frame.fix.lateral_m = pose.lateral_m;
  frame.fix.lateral_sigma_m = pose.lateral_sigma_m;
  frame.fix.heading_deg = pose.heading_deg;
  return frame;
}

// Frames 10 m apart, 2 m right of the road's line, headed a little left of north.
Drive northward_drive(std::size_t frames) {
  Drive drive;
  for (std::size_t i = 0; i < frames; ++i) {
    Frame frame;
    frame.position = at(2, 10 * static_cast<double>(i + 1));
    frame.heading_deg = 359;
    drive.frames.push_back(frame);
  }
  return drive;
}

MethodEvaluation evaluated(const std::vector<Pose>& poses) {
  std::vector<FrameFix> fixes;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    fixes.push_back(fix_of(poses[i], std::string(1, static_cast<char>('a' + i)) + ".jpg"));
  }
  RoadMap map;
  auto result = evaluate_fixes("m", "layer", northward_drive(poses.size()), fixes, map);
  EXPECT_TRUE(result);
  return *result;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = text.find('\n', from);
    lines.push_back(text.substr(from, end - from));
    from = end + 1;
  }
  return lines;
}

TEST(Evaluation, LateralOffsetIsFromTheLineAndPositiveToTheRight) {
  const MethodEvaluation evaluation = evaluated({{10.1, 2.3}, {19.9, 1.9}});
  EXPECT_NEAR(*evaluation.fixes[0].truth_along_m, 10, kMm);
  EXPECT_NEAR(*evaluation.fixes[0].error_m, 0.1, kMm);
  EXPECT_NEAR(*evaluation.fixes[0].truth_lateral_m, 2, kMm);
  EXPECT_NEAR(*evaluation.fixes[0].lateral_error_m, 0.3, kMm);
  EXPECT_NEAR(*evaluation.fixes[1].lateral_error_m, -0.1, kMm);
}

TEST(Evaluation, HeadingErrorsAreTheShorterTurn) {
  const MethodEvaluation evaluation =
      evaluated({{10, {}, 1}, {20, {}, 358.5}, {30, {}, 179}, {40, {}, 180}});
  std::vector<double> errors_deg;
  for (const EvaluatedFix& fix : evaluation.fixes) errors_deg.push_back(*fix.heading_error_deg);
  EXPECT_THAT(errors_deg, ElementsAre(2, -0.5, 180, -179));
}

TEST(Evaluation, SummarizesAbsoluteErrorsOfTheFramesThatHaveThem) {
  std::vector<Pose> poses;
  for (int i = 0; i < 5; ++i) {  // lateral errors 0.0, -0.1, 0.2, -0.3, 0.4; heading 0, -1, 2, ...
    const double error = (i % 2 == 0 ? 0.1 : -0.1) * i;
    poses.push_back({10.0 * (i + 1), 2 + error, wrapped_360(359 + 10 * error), 0.125});
  }
  poses.push_back({60});
  poses.push_back({});
  const Summary summary = evaluated(poses).summary;
  EXPECT_EQ(summary.localized_frames, 6U);
  EXPECT_NEAR(summary.lateral_error_m.mean, 0.2, kMm);
  EXPECT_NEAR(summary.lateral_error_m.p95, 0.38, kMm);
  EXPECT_NEAR(summary.lateral_error_m.max, 0.4, kMm);
  EXPECT_NEAR(summary.lateral_within_2_sigma, 0.6, 1e-9);
  EXPECT_NEAR(summary.heading_error_deg.mean, 2, 1e-9);
  EXPECT_NEAR(summary.heading_error_deg.p95, 3.8, 1e-9);
  EXPECT_NEAR(summary.heading_error_deg.max, 4, 1e-9);
  EXPECT_TRUE(summary.knows_lateral());
}

TEST(Evaluation, AShareWithinTwoSigmaIsOfTheFramesThatClaimASigma) {
  EXPECT_NEAR(evaluated({{10, 2.1, {}, 0.1}, {20, 2.5}}).summary.lateral_within_2_sigma, 1, 1e-9);
}

TEST(Evaluation, AMethodWithoutLateralOffsetHasNoFigureOfIt) {
  const MethodEvaluation evaluation = evaluated({{10}, {20}});
  EXPECT_FALSE(evaluation.summary.knows_lateral());
  const auto summary = nlohmann::json::parse(summary_json({evaluation})).at(0);
  for (const char* key : {"mean_lateral_error_m", "p95_lateral_error_m", "max_lateral_error_m",
                          "lateral_within_2_sigma", "mean_heading_error_deg",
                          "p95_heading_error_deg", "max_heading_error_deg"}) {
    EXPECT_TRUE(summary.at(key).is_null()) << key;
  }
  EXPECT_THAT(lines_of(summary_text({evaluation})).at(1),
              ::testing::EndsWith(" -       -           -"));
}

TEST(Evaluation, SummaryAppendsItsNewFiguresToTheOldOnes) {
  const MethodEvaluation evaluation = evaluated({{10, 2.25, 0, 0.2}, {20, 2.25, 0, 0.2}});
  const auto list = nlohmann::ordered_json::parse(summary_json({evaluation}));
  std::vector<std::string> keys;
  for (const auto& [key, value] : list.at(0).items()) keys.push_back(key);
  EXPECT_THAT(
      keys, ElementsAre("method", "mean_error_m", "std_error_m", "max_error_m", "p50_error_m",
                        "p95_error_m", "frames", "localized_frames", "within_2_sigma",
                        "map_kb_per_m", "latency_ms_p50", "latency_ms_p99", "mean_lateral_error_m",
                        "p95_lateral_error_m", "max_lateral_error_m", "lateral_within_2_sigma",
                        "mean_heading_error_deg", "p95_heading_error_deg", "max_heading_error_deg",
                        "mean_distance_m", "p95_distance_m", "max_distance_m",
                        "wrong_segment_frames", "within_2_sigma_map"));
  EXPECT_NEAR(list.at(0).at("mean_lateral_error_m"), 0.25, kMm);
  EXPECT_NEAR(list.at(0).at("max_heading_error_deg"), 1, 1e-9);
  const std::string text = summary_text({evaluation});
  EXPECT_THAT(lines_of(text).at(0), HasSubstr("lateral m   p95 m heading deg"));
  EXPECT_THAT(lines_of(text).at(1), HasSubstr("0.250   0.250        1.00"));
}

TEST(Evaluation, AShareIsWithinTheSigmaInTheWorldAnotherWithinThatAgainstTheMap) {
  const Summary summary = evaluated({{10.125}, {20}}).summary;
  EXPECT_DOUBLE_EQ(summary.within_2_sigma, 1);
  EXPECT_DOUBLE_EQ(summary.within_2_sigma_map, 0.5);
}

TEST(Evaluation, FixesHaveTheirNewColumnsAfterTheOldOnes) {
  const MethodEvaluation evaluation = evaluated({{10.125, 2.25, 0, 0.2}, {20}});
  std::vector<FrameFix> fixes;
  for (const EvaluatedFix& fix : evaluation.fixes) fixes.push_back(fix.frame);
  const std::string columns =
      "timestamp_s,filename,status,segment,along_m,sigma_m,latitude_deg,longitude_deg,matches,"
      "latency_ms,";
  const std::vector<std::string> localized = lines_of(fixes_csv(fixes));
  EXPECT_EQ(localized.at(0), columns + "lateral_m,heading_deg,lateral_sigma_m,sigma_map_m");
  EXPECT_EQ(localized.at(1),
            "0.0000,a.jpg,tracking,road,10.1250,0.2000,,,0,0.00,2.2500,0.0000,0.2000,0.0500");
  EXPECT_EQ(localized.at(2), "0.0000,b.jpg,tracking,road,20.0000,0.2000,,,0,0.00,,,,0.0500");
  const std::vector<std::string> lines = lines_of(evaluated_fixes_csv(evaluation.fixes));
  EXPECT_EQ(lines.at(0),
            columns +
                "truth_along_m,error_m,lateral_m,heading_deg,lateral_sigma_m,"
                "truth_lateral_m,lateral_error_m,heading_error_deg,truth_segment,distance_m,"
                "sigma_map_m");
  EXPECT_EQ(lines.at(1),
            localized.at(1).substr(0, localized.at(1).find(",2.2500")) +
                ",10.0000,0.1250,2.2500,0.0000,0.2000,2.0000,0.2500,1.0000,road,,0.0500");
  EXPECT_THAT(lines.at(2), StartsWith("0.0000,b.jpg,"));
  EXPECT_THAT(lines.at(2), ::testing::EndsWith(",20.0000,0.0000,,,,2.0000,,,road,,0.0500"));
}

}  // namespace
}  // namespace milepost
