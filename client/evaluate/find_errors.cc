#include "client/evaluate/find_errors.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "client/evaluate/statistics.h"

namespace milepost {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Claim {
  double error = 0;  // not negative
  double sigma = 0;
};

FindErrorFigures figures_of(const std::vector<Claim>& claims) {
  FindErrorFigures figures;
  if (claims.empty()) return figures;
  std::vector<double> errors;
  double inside = 0;
  for (const Claim& claim : claims) {
    errors.push_back(claim.error);
    if (claim.error <= 2 * claim.sigma) ++inside;
  }
  std::sort(errors.begin(), errors.end());
  const auto count = static_cast<double>(errors.size());
  figures.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / count;
  figures.p50 = quantile(errors, 0.5);
  figures.p95 = quantile(errors, 0.95);
  figures.max = errors.back();
  figures.within_2_sigma = inside / count;
  return figures;
}

}  // namespace

bool is_tracked(GlobalStatus status) {
  return status == GlobalStatus::tracking || status == GlobalStatus::predicted;
}

std::vector<FindError> find_errors(const Drive& drive, const std::vector<FoundFrame>& frames) {
  std::vector<FindError> errors;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame& truth = drive.frames[i];
    const GlobalPoseEstimate& fix = frames[i].fix;
    if (!is_valid(truth.position) || !is_valid(fix.position)) {
      errors.push_back({kNaN, kNaN});
      continue;
    }
    errors.push_back({geodesic_distance_m(truth.position, fix.position),
                      turn_deg(truth.heading_deg, fix.heading_deg)});
  }
  return errors;
}

FindSummary find_summary(const std::vector<FoundFrame>& frames,
                         const std::vector<FindError>& errors) {
  FindSummary summary;
  summary.frames = frames.size();
  std::vector<Claim> positions;
  std::vector<Claim> headings;
  std::vector<double> latencies_ms;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const GlobalPoseEstimate& fix = frames[i].fix;
    latencies_ms.push_back(frames[i].latency_ms);
    if (!is_tracked(fix.status)) continue;
    if (summary.tracked_frames++ == 0) {
      summary.found_frame = i;
      summary.found_after_s = fix.timestamp_s - frames.front().fix.timestamp_s;
    }
    const double heading_deg = std::abs(errors[i].heading_deg);
    if (std::isfinite(errors[i].position_m)) {
      positions.push_back({errors[i].position_m, fix.sigma_m});
      if (errors[i].position_m > kWrongPlaceM) ++summary.wrong_frames;
    }
    if (std::isfinite(heading_deg)) headings.push_back({heading_deg, fix.heading_sigma_deg});
  }
  summary.position_m = figures_of(positions);
  summary.heading_deg = figures_of(headings);
  std::sort(latencies_ms.begin(), latencies_ms.end());
  summary.latency_ms_p50 = quantile(latencies_ms, 0.5);
  summary.latency_ms_p99 = quantile(latencies_ms, 0.99);
  return summary;
}

}  // namespace milepost
