// What a drive's images say of its recorded poses.
#pragma once

#include <cmath>
#include <cstddef>

namespace milepost {

// Sums over frames and tracks, so that those of parts add up.
struct ImageWitness {
  std::size_t frames = 0;  // that were adjusted
  // Squares of how far the adjusted poses are from the recorded ones, the mounting's yaw aside.
  double plan_m2 = 0;  // east and north together
  double up_m2 = 0;
  double heading_deg2 = 0;
  std::size_t tracks = 0;        // that could be triangulated with the adjusted poses ...
  std::size_t fitting = 0;       // ... that fit them ...
  std::size_t observations = 0;  // ... in so many frames ...
  double reprojection_px2 = 0;   // ... the squares of their distances there

  double plan_rms_m() const { return root_of_mean(plan_m2, frames); }
  double up_rms_m() const { return root_of_mean(up_m2, frames); }
  double heading_rms_deg() const { return root_of_mean(heading_deg2, frames); }
  double reprojection_rms_px() const { return root_of_mean(reprojection_px2, observations); }
  double fitting_share() const {
    return tracks == 0 ? 1 : static_cast<double>(fitting) / static_cast<double>(tracks);
  }

  ImageWitness& operator+=(const ImageWitness& other) {
    frames += other.frames;
    plan_m2 += other.plan_m2;
    up_m2 += other.up_m2;
    heading_deg2 += other.heading_deg2;
    tracks += other.tracks;
    fitting += other.fitting;
    observations += other.observations;
    reprojection_px2 += other.reprojection_px2;
    return *this;
  }

 private:
  static double root_of_mean(double squares, std::size_t count) {
    return count == 0 ? 0 : std::sqrt(squares / static_cast<double>(count));
  }
};

}  // namespace milepost
