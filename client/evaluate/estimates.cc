#include "client/evaluate/estimates.h"

#include <algorithm>
#include <string_view>

#include "schema/base/csv_text.h"
#include "schema/tile/codec.h"
#include "schema/tile/layer_parameters.h"

namespace milepost {
namespace {

constexpr double kReachM = 20;            // of the tracklets listed, around the fix
constexpr std::size_t kRegressions = 12;  // listed

void add_observations(CsvText& csv, std::size_t number, const ObservedTracklet& observed) {
  const Tracklet& tracklet = observed.tracklet;
  for (const Observation& observation : observed.track) {
    csv.cell(static_cast<long long>(number)).rounded(observation.feature.scale_px, 4);
    csv.rounded(observation.along_m, 4).rounded(tracklet.offset_m, 6);
    csv.rounded(tracklet.slope, 6).rounded(tracklet.r_squared, 6).end_row();
  }
}

constexpr std::string_view kEstimateColumns =
    "timestamp_s,filename,along_m,sigma_m,truth_along_m,error_m,scale_px,along_begin_m,"
    "along_end_m,r_squared";
constexpr std::string_view kRegressionColumns =
    "tracklet,scale_px,along_m,offset_m,slope,r_squared";

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
  CsvText csv(kEstimateColumns);
  for (const EvaluatedFix& evaluated : fixes) {
    if (!evaluated.error_m) continue;
    const FrameFix& frame = evaluated.frame;
    for (const TrackletEstimate& t : frame.estimates) {
      csv.rounded(frame.fix.timestamp_s, 4).cell(frame.filename);
      csv.rounded(t.estimate.along_m, 4).rounded(t.estimate.sigma_m, 4);
      csv.rounded(evaluated.truth_along_m, 4);
      csv.rounded(t.estimate.along_m - *evaluated.truth_along_m, 4).rounded(t.scale_px, 4);
      csv.rounded(t.along.from_m, 4).rounded(t.along.to_m, 4).rounded(t.r_squared, 6).end_row();
    }
  }
  return csv.text();
}

Result<std::optional<std::string>> regressions_csv(MapSource& source, const Fix& fix) {
  const Result<MapDescription> map = source.describe(fix.version);
  if (!map) return map.error();
  if (!map->layers.contains(layers::kObservations)) return std::optional<std::string>();
  const AlongRange around = AlongRange{*fix.along_m, *fix.along_m}.widened(kReachM);
  const auto encoded = source.tiles(fix.version, fix.segment, layers::kObservations, around);
  if (!encoded) return encoded.error();
  std::vector<ObservedTracklet> tracklets;
  for (const EncodedTile& each : *encoded) {
    Result<ObservationTile> tile = decode_observations(each.bytes);
    if (!tile) return tile.error();
    std::ranges::move(tile->tracklets, std::back_inserter(tracklets));
  }
  std::ranges::stable_sort(tracklets, std::greater<>(),
                           [](const ObservedTracklet& observed) { return observed.track.size(); });
  CsvText csv(kRegressionColumns);
  for (std::size_t i = 0; i < std::min(kRegressions, tracklets.size()); ++i) {
    add_observations(csv, i, tracklets[i]);
  }
  return std::optional(csv.text());
}

}  // namespace milepost
