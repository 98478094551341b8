// Carries the belief about the along position from frame to frame, as methods by tracklets do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "client/localize/estimate.h"
#include "client/localize/tracked_position.h"
#include "schema/base/range.h"

namespace milepost {

// A tracker starts from a measurement; then each frame asks for a prediction, searches its region
// and hands back what was measured there, or nothing. Not safe to use from several threads.
class Tracker {
 public:
  virtual ~Tracker() = default;

  virtual void start(double timestamp_s, const Measurement& measurement) = 0;
  // Where the camera is expected at a time after the last frame's.
  virtual TrackedPosition predict(double timestamp_s) const = 0;
  // Where tracklets are searched then.
  virtual AlongRange search_region(double timestamp_s) const = 0;
  // The belief after a frame, with what was measured in it. Whether the measurement was taken in.
  virtual bool advance(double timestamp_s, const std::optional<Measurement>& measurement) = 0;
  virtual TrackedPosition position() const = 0;
};

// None takes each measurement alone; Kalman's is Eqs 9 to 11; particles are section 5.4.
enum class PaperFilter { none, kalman, particle };

// The paper's: candidate region between the last position and rho predicted steps ahead (section
// 4.2.2), constant velocity (Eq. 16), and a filter. The first frames are taken as measured (section
// 4.2.4).
struct PaperTrackerSettings {
  PaperFilter filter = PaperFilter::kalman;
  double rho = 2.0;           // section 4.2.2
  double min_region_m = 2.0;  // to either side, where the vehicle stands or Eq. 16 is noisy
  double max_speed_mps = 50;  // bounds Eq. 16, and the region before there is a velocity
  double sigma_w_m = 0.5;     // transition noise, Eq. 17
  double innovation_threshold_m = 1.0;  // section 4.2.3
  double weight_within = 0.1;           // of the measurement's variance up to the threshold
  double weight_beyond = 1;             // ... and beyond it
  int first_frames = 3;                 // by visual estimates only
  // A frame that fewer tracklets speak for is carried by Eq. 16: section 4.2.3 says of few matches
  // that their error is high and their variance does not show it.
  int min_support = 10;
  std::size_t particles = 4000;  // section 5.4
  std::uint64_t seed = 1;        // of the particles' draws
};
std::unique_ptr<Tracker> make_paper_tracker(const PaperTrackerSettings& settings);

// Ours: along and speed with full covariance; the search region follows the belief's sigma.
struct MotionTrackerSettings {
  double start_speed_mps = 8;  // before it is known ...
  double start_speed_sigma_mps = 10;
  double acceleration_sigma = 1.5;  // m/s^2 / sqrt(Hz)
  double min_region_m = 2.0;        // to either side
  double region_sigmas = 3;
  double gate_sigmas = 5;  // a measurement farther off is not believed ...
  int max_refusals = 3;    // ... until so many in turn are
};
std::unique_ptr<Tracker> make_motion_tracker(const MotionTrackerSettings& settings);

}  // namespace milepost
