// Localization along mapped roads: images and GNSS positions in, fixes out.
//
// Background threads of the localizer read the cache, query the server and decode tiles while
// images are processed. localize() uses the map data that has arrived: it accesses no file, socket
// or database and never waits for a thread that does.
#pragma once

#include <milepost/camera.h>
#include <milepost/export.h>
#include <milepost/image.h>
#include <milepost/patience.h>
#include <milepost/pose.h>
#include <milepost/readings.h>
#include <milepost/result.h>
#include <milepost/source.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace milepost::vehicle {

enum class FixStatus {
  initializing,  // the hypotheses are not decided yet: the sigmas cover all of them
  tracking,      // this image was measured against the map
  predicted,     // no measurement, or one that contradicts the pose: propagated by the motion
  lost,          // the pose was rejected, and its motion does not tell where it is now;
                 // relocalizing around the last fix or the GNSS position
  off_map,       // no mapped road is near, or the vehicle left it: the pose is carried on by motion
};

// "initializing", "tracking", "predicted", "lost", "off-map".
MILEPOST_PUBLIC const char* name_of(FixStatus status);

// The pose estimate for one time. A pose is claimed only once one hypothesis outweighs all others
// and "not on this map" (a sequential test); until then the sigmas cover all hypotheses.
struct Fix {
  double timestamp_s = 0;
  FixStatus status = FixStatus::initializing;
  // Of the road the vehicle is on; empty unless known.
  std::string map;
  std::string build;  // of the map
  std::string segment;
  // Position of the camera in Frenet coordinates: arc length from the segment's start, in [0,
  // length of the segment], and lateral offset from its line, positive to the right.
  std::optional<double> along_m;
  // One standard deviation of along_m, valid only with it: in the world, and against the map, as if
  // its own positions were exact. The difference is an error that fixes close together share.
  double sigma_m = 0;
  double sigma_map_m = 0;
  std::optional<double> lateral_m;
  std::optional<double> lateral_sigma_m;  // one standard deviation, in the world
  std::optional<Pose> pose;               // of the vehicle's reference point
  // Of the pose: the reference frame that the map states for its positions, with the epoch where
  // one is stated ("ITRF2014@2020.5"). Empty: the map states none, or there is no pose.
  std::string datum;
  int matches = 0;  // number of inlier landmarks of the measurement
};

// A range of road ahead whose map data is not held, and why.
struct MissingRange {
  std::string map;
  std::string segment;
  double from_m = 0;
  double to_m = 0;
  std::optional<Error> why;  // none: requested, not received yet
};

// The map data held ahead of the latest fix.
struct MapAhead {
  double held_m = 0;  // contiguous length of road held, starting at the fix, whichever way it turns
  std::vector<MissingRange> missing;  // wanted, but not held
  std::optional<Error> failure;       // why the roads around the vehicle are unknown
};

// A position on the way that the vehicle is expected to take.
struct RoutePoint {
  double latitude_deg = 0;   // [-90, 90], WGS84
  double longitude_deg = 0;  // [-180, 180], WGS84
};

struct LocalizerSettings {
  double ahead_m = 300;  // length of road to prefetch ahead of the vehicle, [0, 5000]
};

// Not safe to use from several threads at once, except for map_ahead(). Movable, not copyable.
class MILEPOST_PUBLIC Localizer {
 public:
  // Reads no map data yet and does not wait for a server.
  // Errors: invalid_input (a value out of range, an invalid URL, a lens that is none, not a map
  // file), not_found, corrupt, io (the map file, the cache directory).
  static Result<Localizer> open(const Source& source, const Camera& camera,
                                const LocalizerSettings& settings = {});
  // Returns within a second, even if the server hangs.
  ~Localizer();
  Localizer(Localizer&&) noexcept;
  Localizer& operator=(Localizer&&) noexcept;

  // Adds a sensor reading. Pass each reading before the first image with a later timestamp, in
  // order of time. Of several GNSS readings the latest is used.
  // Errors: invalid_input (not finite, out of range, or out of order): the reading is ignored.
  Status observe(const ReceiverReading& reading);
  Status observe(const OdometryReading& reading);

  // The way that the vehicle is expected to take, in driving order, within 15 m of the road: the
  // map along it is fetched before that of other branches. It is no evidence of where the vehicle
  // is, which may leave it. Replaces an earlier route; an empty one withdraws it.
  // Errors: invalid_input (one point, one out of range, no length): the earlier route stays.
  Status expect_route(const std::vector<RoutePoint>& route);

  // The fix of the next image.
  // Errors: invalid_input (no image data, an image size other than the camera's, a timestamp that
  // is not finite or not later than the previous image's); the error of the map source while there
  // is no map data to continue with. The localizer remains usable after any error.
  Result<Fix> localize(double timestamp_s, const ImageView& image);

  // The latest fix propagated by the estimated motion to a time after its image, with the status
  // `predicted` if it is tracked. REQUIRES: not before the latest image.
  Fix fix_at(double timestamp_s) const;

  // Safe to call from any thread.
  MapAhead map_ahead() const;

  // For reproducible results on recorded drives, not for use in a vehicle: blocks until the map
  // data for an image at that time is held, or requesting it has failed.
  // Errors: timed_out, cancelled.
  Status wait_for_map(double timestamp_s, const Patience& patience = {});

 private:
  struct MILEPOST_HIDDEN Impl;
  explicit Localizer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost::vehicle
