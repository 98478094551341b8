// Global localization: the pose of a vehicle among the building walls of a map from images and
// wheel odometry alone, without GNSS and without an initial pose (Monte Carlo localization).
#pragma once

#include <milepost/camera.h>
#include <milepost/export.h>
#include <milepost/image.h>
#include <milepost/patience.h>
#include <milepost/readings.h>
#include <milepost/result.h>
#include <milepost/source.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace milepost::vehicle {

enum class GlobalStatus {
  initializing,  // not converged to one mode yet
  tracking,      // converged; this image gave a measurement
  predicted,     // converged; propagated by odometry: this image gave no measurement
  lost,          // was converged, is no longer
};

// "initializing", "tracking", "predicted", "lost".
MILEPOST_PUBLIC const char* name_of(GlobalStatus status);

// The pose estimate for one image.
struct GlobalFix {
  double timestamp_s = 0;
  GlobalStatus status = GlobalStatus::initializing;
  // Position of the camera at the densest mode, WGS84. No altitude is estimated.
  double latitude_deg = 0;
  double longitude_deg = 0;
  double heading_deg = 0;  // clockwise from north, [0, 360)
  double sigma_m = 0;      // standard deviation per axis; until converged, of all particles
  double heading_sigma_deg = 0;
  double mode_probability = 0;  // probability of the mode, [0, 1]
  double inlier_ratio = 0;      // share of recent measurements explained at the mode, [0, 1]
};

// A box in WGS84 degrees with west < east and south < north; it does not cross longitude 180.
struct Area {
  double west_deg = 0;
  double south_deg = 0;
  double east_deg = 0;
  double north_deg = 0;
};

// Prior of the vehicle's initial pose.
struct PosePrior {
  double latitude_deg = 0;
  double longitude_deg = 0;
  double sigma_m = 0;                      // standard deviation per axis, above 0
  std::optional<double> heading_deg = {};  // standard deviation 10 degrees; none: unknown
};

struct GlobalLocalizerSettings {
  std::string map = {};                 // name of the map; may be empty if only one has walls
  std::optional<Area> area = {};        // that contains the vehicle; none: the whole map
  std::optional<PosePrior> start = {};  // none: anywhere in the area
  int particles = 2000;                 // of the particle filter, [10, 1000000]
  std::uint64_t seed = 1;               // equal inputs and seeds give equal fixes
};

// Not safe to use from several threads at once. Movable, not copyable.
class MILEPOST_PUBLIC GlobalLocalizer {
 public:
  // Reads the walls from the cache, the server or the map file. Blocks, within `patience`.
  // Errors: invalid_input, not_found (no map with walls, no walls in the area), unavailable,
  // corrupt, io; timed_out, cancelled.
  static Result<GlobalLocalizer> open(const Source& source, const Camera& camera,
                                      const GlobalLocalizerSettings& settings = {},
                                      const Patience& patience = {});
  ~GlobalLocalizer();
  GlobalLocalizer(GlobalLocalizer&&) noexcept;
  GlobalLocalizer& operator=(GlobalLocalizer&&) noexcept;

  // Adds an odometry reading. Pass all readings up to an image before that image.
  // Errors: invalid_input (a value is not finite).
  Status observe(const OdometryReading& reading);

  // The pose estimate for the next image. Takes about 0.1 s and does no I/O.
  // Errors: invalid_input (the image or its timestamp, as Localizer::localize).
  Result<GlobalFix> find(double timestamp_s, const ImageView& image);

  // Of the fixes' positions: the reference frame that the map states, with the epoch where one is
  // stated ("ITRF2014@2020.5"). Empty: the map states none.
  const std::string& datum() const;

 private:
  struct MILEPOST_HIDDEN Impl;
  explicit GlobalLocalizer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost::vehicle
