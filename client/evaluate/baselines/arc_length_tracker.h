// Tracks arc length from frame to frame, as the tracklet methods do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "client/localize/estimate.h"
#include "client/localize/tracked_pose.h"
#include "schema/base/range.h"

namespace milepost {

// A tracker starts from a measurement; then each frame requests a prediction, searches its region
// and passes back the measurement from there, or none. Not safe to use from several threads at
// once.
class ArcLengthTracker {
 public:
  virtual ~ArcLengthTracker() = default;

  virtual std::unique_ptr<ArcLengthTracker> clone() const = 0;
  virtual void start(double timestamp_s, const Measurement& measurement) = 0;
  // The predicted position at a time after the last frame.
  virtual TrackedPose predict(double timestamp_s) const = 0;
  // The range in which tracklets are searched at that time.
  virtual AlongRange search_region(double timestamp_s) const = 0;
  // Advances the belief to a frame and updates it with the measurement, if given. Returns whether
  // the measurement was used.
  virtual bool advance(double timestamp_s, const std::optional<Measurement>& measurement) = 0;
  virtual TrackedPose pose() const = 0;
};

// `none` uses each measurement alone; `kalman` is Eqs 9 to 11; `particle` is section 5.4.
enum class PaperFilter { none, kalman, particle };

// The paper's: candidate region between the last position and rho predicted steps ahead (section
// 4.2.2), constant velocity (Eq. 16), and a filter. The first frames use the measurements only
// (section 4.2.4).
struct PaperTrackerSettings {
  PaperFilter filter = PaperFilter::kalman;
  double rho = 2.0;           // section 4.2.2
  double min_region_m = 2.0;  // half width, for when the vehicle stands or Eq. 16 is noisy
  double max_speed_mps = 50;  // bounds Eq. 16, and the region until a velocity is known
  double sigma_w_m = 0.5;     // transition noise, Eq. 17
  double innovation_threshold_m = 1.0;  // section 4.2.3
  double weight_within = 0.1;           // factor of the measurement's variance up to the threshold
  double weight_beyond = 1;             // ... and beyond it
  int first_frames = 3;                 // by visual measurements only
  // A frame with fewer inlier tracklets is only predicted with Eq. 16: according to section 4.2.3
  // few matches have large errors that their variance does not show.
  int min_support = 10;
  std::size_t particles = 4000;  // section 5.4
  std::uint64_t seed = 1;        // of the random numbers
};
std::unique_ptr<ArcLengthTracker> make_paper_tracker(const PaperTrackerSettings& settings);

// Ours: arc length and speed with a full covariance; the search region follows the belief's sigma.
struct MotionTrackerSettings {
  double start_speed_mps = 8;  // initial belief ...
  double start_speed_sigma_mps = 10;
  double acceleration_sigma = 1.5;  // m/s^2 / sqrt(Hz)
  double min_region_m = 2.0;        // half width
  double region_sigmas = 3;
  double gate_sigmas = 5;  // a measurement farther off is rejected ...
  int max_refusals = 3;    // ... until this many in a row are
};
std::unique_ptr<ArcLengthTracker> make_motion_tracker(const MotionTrackerSettings& settings);

}  // namespace milepost
