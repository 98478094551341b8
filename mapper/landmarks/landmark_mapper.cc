#include "mapper/landmarks/landmark_mapper.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Median and spread of ln(s * depth / f).
struct LogSize {
  double median = 0;
  double sigma = 0;
};

LogSize log_size_of(const PixelTrack& track, const std::vector<double>& scales_px,
                    const std::vector<CameraPose>& poses, const Eigen::Vector3d& enu_m,
                    double focal_px) {
  std::vector<double> logs;
  logs.reserve(track.size());
  for (std::size_t i = 0; i < track.size(); ++i) {
    const double depth_m = seen_from(poses[track[i].frame], enu_m).z();
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
    : camera_(camera.pinhole), settings_(settings) {}

void LandmarkMapper::add_frame(const Frame& frame, double along_m) {
  frames_.push_back({along_m, frame.position, frame.heading_deg * kRadPerDeg, 0, 0});
}

void LandmarkMapper::add_tracks(const std::vector<Track>& tracks) {
  for (const Track& track : tracks) {
    WaitingTrack waiting;
    for (const Observation& observation : track) {
      // A track that stayed open for longer than frames are kept goes by its later sights.
      if (observation.along_m < frames_.front().along_m) continue;
      const auto frame =
          std::lower_bound(frames_.begin(), frames_.end(), observation.along_m,
                           [](const RecordedPose& pose, double m) { return pose.along_m < m; });
      waiting.sights.push_back({static_cast<std::size_t>(frame - frames_.begin()),
                                {observation.feature.x_px, observation.feature.y_px}});
      waiting.scales_px.push_back(observation.feature.scale_px);
    }
    if (waiting.sights.size() < 2) continue;
    Tracklet mean;
    set_from_track(track, mean);
    waiting.descriptor = mean.descriptor;
    waiting.along = mean.along;
    tracks_.push_back(std::move(waiting));
  }
}

std::vector<MappedLandmark> LandmarkMapper::take_mapped(bool finished) {
  std::vector<MappedLandmark> mapped;
  const std::size_t full = settled_ + settings_.window_frames + settings_.overlap_frames;
  if (frames_.size() >= full) settle(full, full - settings_.overlap_frames, mapped);
  if (finished && settled_ < frames_.size()) settle(frames_.size(), frames_.size(), mapped);
  return mapped;
}

double LandmarkMapper::oldest_waiting_along_m() const {
  double oldest_m = std::numeric_limits<double>::infinity();
  for (const WaitingTrack& track : tracks_) {
    if (!track.mapped) oldest_m = std::min(oldest_m, track.along.from_m);
  }
  return oldest_m;
}

// Adjusts the first `frames` of those that are kept and maps the tracks that have settled by it.
void LandmarkMapper::settle(std::size_t frames, std::size_t settled_after,
                            std::vector<MappedLandmark>& mapped) {
  const LocalFrame local(frames_.front().position);
  std::vector<CameraPose> poses;
  poses.reserve(frames);
  for (std::size_t i = 0; i < frames; ++i) {
    const RecordedPose& recorded = frames_[i];
    const EnuPoint at = local.enu_from_geo(recorded.position);
    poses.push_back({{at.east_m, at.north_m, at.up_m},
                     recorded.heading_rad,
                     recorded.pitch_rad,
                     recorded.roll_rad});
  }
  std::vector<PixelTrack> inside;
  for (const WaitingTrack& track : tracks_) {
    if (track.sights.back().frame < frames) inside.push_back(track.sights);
  }
  adjust_poses(poses, settled_, inside, camera_, settings_.adjustment);

  for (std::size_t i = settled_; i < settled_after; ++i) {
    const CameraPose& pose = poses[i];
    frames_[i].position = local.geo_from_enu({pose.enu_m.x(), pose.enu_m.y(), pose.enu_m.z()});
    frames_[i].heading_rad = pose.heading_rad;
    frames_[i].pitch_rad = pose.pitch_rad;
    frames_[i].roll_rad = pose.roll_rad;
  }
  settled_ = settled_after;
  for (WaitingTrack& track : tracks_) {
    if (track.mapped || track.sights.back().frame >= settled_) continue;
    track.mapped = true;
    const auto placed =
        triangulate(track.sights, poses, camera_, settings_.adjustment.pixel_sigma_px);
    if (!placed || placed->rms_px > settings_.max_rms_px) continue;
    const Eigen::Vector3d from_first = placed->enu_m - poses[track.sights.front().frame].enu_m;
    const double distance_m = from_first.norm();
    const Eigen::Vector3d ray = from_first / distance_m;
    const double depth_sigma_m =
        std::sqrt(ray.dot(placed->covariance_m2 * ray)) *
        std::max(1.0, placed->rms_px / settings_.adjustment.pixel_sigma_px);
    if (distance_m > settings_.max_distance_m) continue;
    if (depth_sigma_m > settings_.max_depth_sigma * distance_m) continue;
    const LogSize size =
        log_size_of(track.sights, track.scales_px, poses, placed->enu_m, camera_.focal_px());
    mapped.push_back({track.descriptor,
                      local.geo_from_enu({placed->enu_m.x(), placed->enu_m.y(), placed->enu_m.z()}),
                      distance_m, depth_sigma_m, std::exp(size.median), size.sigma, track.along,
                      track.sights.size()});
  }
  forget_settled();
}

// Keeps as many settled frames as hold the next window in place, and all that a track waits for.
void LandmarkMapper::forget_settled() {
  std::size_t gone = settled_ - std::min(settled_, settings_.overlap_frames);
  for (const WaitingTrack& track : tracks_) {
    if (!track.mapped) gone = std::min(gone, track.sights.front().frame);
  }
  std::erase_if(tracks_, [&](const WaitingTrack& track) {
    return track.mapped && track.sights.front().frame < gone;
  });
  for (WaitingTrack& track : tracks_) {
    for (Sight& sight : track.sights) sight.frame -= gone;
  }
  frames_.erase(frames_.begin(), frames_.begin() + static_cast<std::ptrdiff_t>(gone));
  settled_ -= gone;
}

}  // namespace milepost
