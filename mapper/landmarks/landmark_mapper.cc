#include "mapper/landmarks/landmark_mapper.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "schema/base/median.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

// Median and standard deviation of ln(s * depth / f).
struct LogSize {
  double median = 0;
  double sigma = 0;
};

LogSize log_size_of(const FeatureTrack& track, const std::vector<double>& scales_px,
                    const std::vector<CameraPose>& poses, const Eigen::Vector3d& enu_m,
                    double focal_px) {
  std::vector<double> logs;
  logs.reserve(track.size());
  for (std::size_t i = 0; i < track.size(); ++i) {
    const double depth_m = point_in_camera(poses[track[i].frame], enu_m).z();
    logs.push_back(std::log(scales_px[i] * depth_m / focal_px));
  }
  LogSize size{median_of(logs), 0};
  double squares = 0;
  for (const double log : logs) squares += (log - size.median) * (log - size.median);
  size.sigma = std::sqrt(squares / static_cast<double>(logs.size() - 1));
  return size;
}

}  // namespace

LandmarkMapper::LandmarkMapper(const Camera& camera, const LandmarkSettings& settings)
    : camera_(camera.pinhole),
      settings_(settings),
      vehicles_ahead_(settings.vehicles_ahead, camera.pinhole) {}

void LandmarkMapper::add_frame(const Frame& frame, double along_m) {
  frames_.push_back({along_m,
                     frame.position,
                     frame.heading_deg * kRadPerDeg,
                     frame.pitch_deg * kRadPerDeg,
                     frame.roll_deg * kRadPerDeg,
                     {}});
}

void LandmarkMapper::add_tracks(const std::vector<Track>& tracks) {
  for (const Track& track : tracks) {
    PendingTrack waiting;
    for (const Observation& observation : track) {
      // A track that stayed open for longer than frames are kept uses its later observations.
      if (observation.along_m < frames_.front().along_m) continue;
      const auto frame =
          std::lower_bound(frames_.begin(), frames_.end(), observation.along_m,
                           [](const AdjustedFrame& at, double m) { return at.along_m < m; });
      waiting.observations.push_back({static_cast<std::size_t>(frame - frames_.begin()),
                                      {observation.feature.x_px, observation.feature.y_px},
                                      observation.feature.magnification});
      waiting.scales_px.push_back(observation.feature.scale_px);
    }
    if (waiting.observations.size() < 2) continue;
    Tracklet mean;
    set_from_track(track, mean);
    waiting.descriptor = mean.descriptor;
    waiting.along = mean.along;
    tracks_.push_back(std::move(waiting));
  }
}

std::vector<MappedLandmark> LandmarkMapper::take_mapped(bool finished) {
  const std::size_t full = final_ + settings_.window_frames + settings_.overlap_frames;
  if (frames_.size() >= full) finalize(full, full - settings_.overlap_frames);
  if (finished && final_ < frames_.size()) finalize(frames_.size(), frames_.size());
  if (finished) return take_placed_before(std::numeric_limits<double>::infinity());
  if (final_ == 0) return {};
  return take_placed_before(frames_[final_ - 1].along_m - vehicles_ahead_.reach_m());
}

std::vector<MappedLandmark> LandmarkMapper::take_placed_before(double along_m) {
  std::vector<MappedLandmark> taken;
  while (!placed_.empty() && placed_.front().landmark.along.to_m < along_m) {
    Placed& next = placed_.front();
    if (!vehicles_ahead_.hold(next.seen, next.landmark.depth_m))
      taken.push_back(std::move(next.landmark));
    placed_.pop_front();
  }
  double oldest_m = along_m;
  for (const Placed& waiting : placed_) oldest_m = std::min(oldest_m, waiting.seen.along_m);
  vehicles_ahead_.forget_before(oldest_m);
  return taken;
}

// Adjusts the first `frames` kept frames, makes the first `final_after` of them final, and maps the
// tracks that end in them.
void LandmarkMapper::finalize(std::size_t frames, std::size_t final_after) {
  const LocalFrame local(frames_.front().position);
  std::vector<CameraPose> poses;
  poses.reserve(frames);
  for (std::size_t i = 0; i < frames; ++i) {
    const AdjustedFrame& recorded = frames_[i];
    const EnuPoint at = local.enu_from_geo(recorded.position);
    poses.push_back({{at.east_m, at.north_m, at.up_m},
                     recorded.heading_rad,
                     recorded.pitch_rad,
                     recorded.roll_rad});
  }
  std::vector<FeatureTrack> inside;
  for (const PendingTrack& track : tracks_) {
    if (track.observations.back().frame < frames) inside.push_back(track.observations);
  }
  const std::vector<ImageWitness> witness =
      adjust_poses(poses, final_, inside, camera_, settings_.adjustment);

  for (std::size_t i = final_; i < final_after; ++i) {
    const CameraPose& pose = poses[i];
    frames_[i].position = local.geo_from_enu({pose.enu_m.x(), pose.enu_m.y(), pose.enu_m.z()});
    frames_[i].heading_rad = pose.heading_rad;
    frames_[i].pitch_rad = pose.pitch_rad;
    frames_[i].roll_rad = pose.roll_rad;
    frames_[i].witness = witness[i - final_];
    adjusted_.push_back(frames_[i]);
  }
  final_ = final_after;
  for (PendingTrack& track : tracks_) {
    if (track.mapped || track.observations.back().frame >= final_) continue;
    track.mapped = true;
    const FeatureTrack& seen = track.observations;
    const VehiclesAhead::Place place{track.along.middle_m(),
                                     (seen.front().pixel + seen.back().pixel) / 2};
    vehicles_ahead_.add(place, track.along.to_m - track.along.from_m, seen.size(),
                        recession_px(seen, poses, camera_));
    const auto placed =
        triangulate(track.observations, poses, camera_, settings_.adjustment.pixel_sigma_px);
    if (!placed || placed->rms_px > settings_.max_rms_px) continue;
    const Eigen::Vector3d from_first =
        placed->enu_m - poses[track.observations.front().frame].enu_m;
    const double distance_m = from_first.norm();
    const Eigen::Vector3d ray = from_first / distance_m;
    const double misfit = std::max(1.0, placed->rms_px / settings_.adjustment.pixel_sigma_px);
    const Eigen::Matrix3d covariance_m2 = misfit * misfit * placed->covariance_m2;
    const double depth_sigma_m = std::sqrt(ray.dot(covariance_m2 * ray));
    if (distance_m > settings_.max_distance_m) continue;
    if (depth_sigma_m > settings_.max_depth_sigma * distance_m) continue;
    const LogSize size =
        log_size_of(track.observations, track.scales_px, poses, placed->enu_m, camera_.focal_px());
    const GeoPoint position =
        local.geo_from_enu({placed->enu_m.x(), placed->enu_m.y(), placed->enu_m.z()});
    placed_.push_back({{track.descriptor, position, covariance_m2, distance_m, depth_sigma_m,
                        std::exp(size.median), size.sigma, track.along, seen.size()},
                       place});
  }
  forget_final();
}

// Discards final frames, except the overlap that constrains the next window and those that a
// waiting track needs.
void LandmarkMapper::forget_final() {
  std::size_t gone = final_ - std::min(final_, settings_.overlap_frames);
  for (const PendingTrack& track : tracks_) {
    if (!track.mapped) gone = std::min(gone, track.observations.front().frame);
  }
  std::erase_if(tracks_, [&](const PendingTrack& track) {
    return track.mapped && track.observations.front().frame < gone;
  });
  for (PendingTrack& track : tracks_) {
    for (PixelObservation& observation : track.observations) observation.frame -= gone;
  }
  frames_.erase(frames_.begin(), frames_.begin() + static_cast<std::ptrdiff_t>(gone));
  final_ -= gone;
}

}  // namespace milepost
