#include "mapper/fusion/merging.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace milepost {

void LandmarkMerger::add(const PassLandmark& landmark) {
  const ComparedLandmark seen = compared(landmark.landmark, local_);
  Merged* best = nullptr;
  double least = kMaxSquaredDistance;
  const Eigen::Matrix3d between =
      settings_.min_sigma_m * settings_.min_sigma_m * Eigen::Matrix3d::Identity();
  for (Merged& merged : open_) {
    const bool is_near =
        landmark.landmark.along.from_m - merged.landmark.along.from_m <= settings_.reach_m;
    if (!is_near || merged.seen_in[landmark.pass]) continue;
    const Eigen::Vector3d off = seen.enu_m - merged.compared.enu_m;
    const Eigen::Matrix3d covariance = seen.covariance_m2 + merged.compared.covariance_m2 + between;
    const double cutoff = settings_.cutoff_sigmas * settings_.cutoff_sigmas;
    if (off.squaredNorm() > cutoff * covariance.trace()) continue;
    if (!are_of_one_size(seen, merged.compared)) continue;
    if (off.dot(covariance.ldlt().solve(off)) > cutoff) continue;
    const double distance = squared_distance(seen.descriptor, merged.compared.descriptor);
    if (distance >= least) continue;
    least = distance;
    best = &merged;
  }
  if (best == nullptr) {
    best = &open_.emplace_back();
    best->landmark = landmark.landmark;
    best->landmark.observations = 0;
    best->seen_in.assign(passes_, false);
    best->descriptor.assign(kDescriptorBytes, 0);
  }
  absorb(*best, landmark, seen);
}

void LandmarkMerger::absorb(Merged& merged, const PassLandmark& landmark,
                            const ComparedLandmark& compared) {
  const MappedLandmark& other = landmark.landmark;
  MappedLandmark& mean = merged.landmark;
  const auto weight = static_cast<double>(other.observations);
  const auto weight_before = static_cast<double>(mean.observations);
  merged.seen_in[landmark.pass] = true;
  const Eigen::Matrix3d information = compared.covariance_m2.inverse();
  merged.information += information;
  merged.weighted += information * compared.enu_m;
  for (std::size_t i = 0; i < merged.descriptor.size(); ++i) {
    merged.descriptor[i] += weight * other.descriptor[i];
    mean.descriptor[i] =
        static_cast<std::uint8_t>(std::lround(merged.descriptor[i] / (weight_before + weight)));
  }
  merged.log_sizes += weight * compared.log_size;
  const double log_size = merged.log_sizes / (weight_before + weight);
  const double variance = (weight_before * mean.size_sigma * mean.size_sigma +
                           weight * other.size_sigma * other.size_sigma) /
                          (weight_before + weight);
  mean.size_sigma = std::sqrt(variance);
  mean.along = mean.along.joined(other.along);
  mean.right_m = (weight_before * mean.right_m + weight * other.right_m) / (weight_before + weight);
  mean.observations += other.observations;
  mean.passes = static_cast<std::size_t>(std::ranges::count(merged.seen_in, true));
  merged.compared.covariance_m2 = mean.covariance_m2 = merged.information.inverse();
  merged.compared.enu_m = mean.covariance_m2 * merged.weighted;
  merged.compared.log_size = log_size;
  merged.compared.descriptor = root_sift(mean.descriptor);
}

MappedLandmark LandmarkMerger::finished(Merged merged) const {
  MappedLandmark& landmark = merged.landmark;
  landmark.passes_there = passes_;
  if (landmark.passes == 1) return landmark;  // exactly as it was mapped
  landmark.size_m = std::exp(merged.compared.log_size);
  const Eigen::Vector3d& at = merged.compared.enu_m;
  landmark.position = local_.geo_from_enu({at.x(), at.y(), at.z()});
  // In the direction in which it was least known.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(landmark.covariance_m2);
  landmark.depth_sigma_m =
      std::min(landmark.depth_sigma_m, std::sqrt(axes.eigenvalues().maxCoeff()));
  return landmark;
}

std::vector<MappedLandmark> LandmarkMerger::take_before(double along_m) {
  std::vector<MappedLandmark> taken;
  while (!open_.empty() && open_.front().landmark.along.from_m < along_m) {
    taken.push_back(finished(std::move(open_.front())));
    open_.pop_front();
  }
  return taken;
}

}  // namespace milepost
