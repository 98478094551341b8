// Localization along mapped road: images and rough positions in, fixes out.
//
// The map comes by threads of the localizer's own, which read the cache, ask the server and decode
// tiles beside the frames. localize() takes what has arrived: it enters no file, socket or
// database, and waits for no thread that does.
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
  initializing,  // not yet sure where: what else is told is as wide as that
  tracking,      // this frame was measured against the map
  predicted,     // it was not, or spoke against the place: the motion carries on
  lost,          // the place is given up; looking again about the last one or the receiver
  off_map,       // no mapped road is near, or the vehicle drove over an end of it
};

// "initializing", "tracking", "predicted", "lost", "off-map".
MILEPOST_PUBLIC const char* name_of(FixStatus status);

// The answer for one time. Right or silent: until one place outweighs all others and "not on this
// map", sigmas are as wide as all that it may be.
struct Fix {
  double timestamp_s = 0;
  FixStatus status = FixStatus::initializing;
  // Of the road the vehicle is on; empty unless known.
  std::string map;
  std::string build;  // of the map
  std::string segment;
  // Where the camera is on it: arc length from the segment's start, [0, its length], and to the
  // right of its line.
  std::optional<double> along_m;
  double sigma_m = 0;  // one standard deviation, with along_m
  std::optional<double> lateral_m;
  std::optional<double> lateral_sigma_m;  // one standard deviation
  std::optional<Pose> pose;               // of the vehicle's reference point
  int matches = 0;                        // landmarks that agreed on the measurement
};

// A stretch of road ahead of which nothing is held, and why.
struct MissingRange {
  std::string map;
  std::string segment;
  double from_m = 0;
  double to_m = 0;
  std::optional<Error> why;  // none: it was asked for and has not arrived yet
};

// What is held of the map ahead of the latest fix.
struct MapAhead {
  double held_m = 0;                  // from there on without a gap
  std::vector<MissingRange> missing;  // of what is wanted
  std::optional<Error> failure;       // why the road about the vehicle is not known
};

struct LocalizerSettings {
  double ahead_m = 300;  // of map wanted ahead of the vehicle, [0, 5000]
};

// Not safe to use from several threads at once, but for map_ahead(). Moves, and does not copy.
class MILEPOST_PUBLIC Localizer {
 public:
  // Reads no map yet, and waits for no server.
  // Errors: invalid_input (a value out of its range, a URL or a file that is none), unsupported
  // (a lens with distortion), not_found, corrupt, io (the map file, the cache's folder).
  static Result<Localizer> open(const Source& source, const Camera& camera,
                                const LocalizerSettings& settings = {});
  // Ends within a second, whatever the server does.
  ~Localizer();
  Localizer(Localizer&&) noexcept;
  Localizer& operator=(Localizer&&) noexcept;

  // Readings are told before the first image that is later than them; of several of a kind the
  // latest counts. Errors: invalid_input (not finite, out of range, or earlier than the one
  // before): it is left out.
  Status observe(const ReceiverReading& reading);
  Status observe(const OdometryReading& reading);

  // The fix of the next image. Errors: invalid_input (the image is none, or of another size than
  // the camera's; a time that is not after the one before) and what the source says while there is
  // nothing of the map to go on with. The localizer stays usable after each.
  Result<Fix> localize(double timestamp_s, const ImageView& image);

  // Where the latest fix has come to by a time after its image, as the motion is known: `predicted`
  // where that is tracked. REQUIRES: not before the latest image.
  Fix fix_at(double timestamp_s) const;

  // May be called from any thread.
  MapAhead map_ahead() const;

  // For recorded drives, so that their fixes are the same each time: waits until the map that an
  // image of that time needs is held, or was asked for in vain. A vehicle does not.
  // Errors: timed_out, cancelled.
  Status wait_for_map(double timestamp_s, const Patience& patience = {});

 private:
  struct MILEPOST_HIDDEN Impl;
  explicit Localizer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost::vehicle
