#include "client/evaluate/estimates.h"

#include <algorithm>
#include <string_view>

#include "client/evaluate/cells.h"
#include "schema/tile/codec.h"
#include "schema/tile/layer_parameters.h"

namespace milepost {
namespace {

constexpr double kReachM = 20;            // of the tracklets told, around the fix
constexpr std::size_t kRegressions = 12;  // told

std::string observation_rows(std::size_t number_of_tracklet, const ObservedTracklet& observed) {
  const Tracklet& tracklet = observed.tracklet;
  std::string rows;
  for (const Observation& observation : observed.track) {
    rows += std::to_string(number_of_tracklet) + "," + number(observation.feature.scale_px, 4) +
            "," + number(observation.along_m, 4) + "," + number(tracklet.offset_m, 6) + "," +
            number(tracklet.slope, 6) + "," + number(tracklet.r_squared, 6) + "\n";
  }
  return rows;
}

constexpr std::string_view kEstimateColumns =
    "timestamp_s,filename,along_m,sigma_m,truth_along_m,error_m,scale_px,along_begin_m,"
    "along_end_m,r_squared\n";
constexpr std::string_view kRegressionColumns =
    "tracklet,scale_px,along_m,offset_m,slope,r_squared\n";

bool begins_estimates(std::string_view head) { return head.starts_with(kEstimateColumns); }
bool begins_regressions(std::string_view head) { return head.starts_with(kRegressionColumns); }

}  // namespace

const OutputKind kEstimatesOutput = {"a table of estimates", begins_estimates, true};
const OutputKind kRegressionsOutput = {"a table of regressions", begins_regressions, true};

bool has_estimates(const std::vector<EvaluatedFix>& fixes) {
  return std::ranges::any_of(
      fixes, [](const EvaluatedFix& evaluated) { return !evaluated.frame.estimates.empty(); });
}

std::string estimates_csv(const std::vector<EvaluatedFix>& fixes) {
  std::string text(kEstimateColumns);
  for (const EvaluatedFix& evaluated : fixes) {
    if (!evaluated.error_m) continue;
    const FrameFix& frame = evaluated.frame;
    for (const TrackletEstimate& t : frame.estimates) {
      const double error_m = t.estimate.along_m - *evaluated.truth_along_m;
      text += number(frame.fix.timestamp_s, 4) + "," + frame.filename + "," +
              number(t.estimate.along_m, 4) + "," + number(t.estimate.sigma_m, 4) + "," +
              number(evaluated.truth_along_m, 4) + "," + number(error_m, 4) + "," +
              number(t.scale_px, 4) + "," + number(t.along.from_m, 4) + "," +
              number(t.along.to_m, 4) + "," + number(t.r_squared, 6) + "\n";
    }
  }
  return text;
}

Result<std::optional<std::string>> regressions_csv(MapSource& source, const Fix& fix) {
  const Result<MapDescription> map = source.describe(fix.version);
  if (!map) return map.error();
  if (!map->layers.contains(layers::kObservations)) return std::optional<std::string>();
  const AlongRange around = AlongRange{*fix.along_m, *fix.along_m}.widened(kReachM);
  const auto frames = source.tiles(fix.version, fix.segment, layers::kObservations, around);
  if (!frames) return frames.error();
  std::vector<ObservedTracklet> tracklets;
  for (const TileFrame& frame : *frames) {
    Result<ObservationTile> tile = decode_observations(frame.frame);
    if (!tile) return tile.error();
    std::ranges::move(tile->tracklets, std::back_inserter(tracklets));
  }
  std::ranges::stable_sort(tracklets, std::greater<>(),
                           [](const ObservedTracklet& observed) { return observed.track.size(); });
  std::string text(kRegressionColumns);
  for (std::size_t i = 0; i < std::min(kRegressions, tracklets.size()); ++i) {
    text += observation_rows(i, tracklets[i]);
  }
  return std::optional(std::move(text));
}

}  // namespace milepost
