// Global localization: where a vehicle is among the building walls of a map, from images and wheels
// alone, with no receiver and no idea of its place.
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

enum class FinderStatus {
  initializing,  // no place carries the belief yet
  tracking,      // one does, and this image was weighed
  predicted,     // one does, carried on by the wheels: this image told nothing
  lost,          // one did, and does no more
};

// "initializing", "tracking", "predicted", "lost".
MILEPOST_PUBLIC const char* name_of(FinderStatus status);

// The answer for one image.
struct FinderFix {
  double timestamp_s = 0;
  FinderStatus status = FinderStatus::initializing;
  // Of the camera, where the belief is densest. WGS84; walls know no heights.
  double latitude_deg = 0;
  double longitude_deg = 0;
  double heading_deg = 0;  // clockwise from north, [0, 360)
  double sigma_m = 0;      // in each direction; while nothing is found, of the whole belief
  double heading_sigma_deg = 0;
  double mass = 0;       // part of the belief that lies there, [0, 1]
  double explained = 0;  // share of what was seen lately that the walls there explain, [0, 1]
};

// A box of WGS84 degrees that does not cross longitude 180.
struct Area {
  double west_deg = 0;
  double south_deg = 0;
  double east_deg = 0;
  double north_deg = 0;
};

// Where the vehicle is known to be at first.
struct FinderStart {
  double latitude_deg = 0;
  double longitude_deg = 0;
  double sigma_m = 0;                      // in each direction, above 0
  std::optional<double> heading_deg = {};  // within 10 degrees; none: it may look anywhere
};

struct FinderSettings {
  std::string map = {};           // which one, where several have walls; empty: the only one
  std::optional<Area> area = {};  // that the vehicle is in; none: all of the map's walls
  std::optional<FinderStart> start = {};  // none: anywhere in the area
  int particles = 2000;                   // of the filter, [10, 1000000]
  std::uint64_t seed = 1;                 // the same seed gives the same fixes
};

// Not safe to use from several threads at once. Moves, and does not copy.
class MILEPOST_PUBLIC Finder {
 public:
  // Reads the walls, from the cache or the server.
  // Errors: invalid_input, unsupported, not_found (no map with walls, no walls in the area),
  // unavailable, corrupt, io; timed_out, cancelled.
  static Result<Finder> open(const Source& source, const Camera& camera,
                             const FinderSettings& settings = {}, const Patience& patience = {});
  ~Finder();
  Finder(Finder&&) noexcept;
  Finder& operator=(Finder&&) noexcept;

  // Readings up to an image are told before it. Errors: invalid_input (not finite).
  Status observe(const OdometryReading& reading);

  // The fix of the next image. Takes a tenth of a second or so; no I/O.
  // Errors: invalid_input (as Localizer::localize).
  Result<FinderFix> find(double timestamp_s, const ImageView& image);

 private:
  struct MILEPOST_HIDDEN Impl;
  explicit Finder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost::vehicle
