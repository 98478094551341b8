// The localizer: frames and coarse positions in, fixes out.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/fetch/map_source.h"
#include "client/fetch/prefetcher.h"
#include "client/localize/coarse_position.h"
#include "client/localize/method.h"
#include "client/localize/place_odds.h"
#include "client/localize/receiver_evidence.h"
#include "schema/feature/types.h"
#include "schema/geo/odometry.h"
#include "schema/geo/route_line.h"

namespace milepost {

enum class FixStatus {
  initializing,  // not yet sure where: a fix there may be is as wide as that
  tracking,      // this frame was measured against the map
  predicted,  // this frame gave no measurement, or spoke against the place; the motion carries on
  lost,       // the place is given up; looking again around the last fix or the receiver
  off_map,    // no segment is near, or the vehicle drove over an end of its segment
};

const char* name_of(FixStatus status);

// The answer for one frame.
struct Fix {
  double timestamp_s = 0;
  FixStatus status = FixStatus::initializing;
  MapVersion version;             // empty unless a segment is known
  std::string segment;            // empty unless known
  std::optional<double> along_m;  // [0, length of the segment]
  // One standard deviation, with along_m; until a place is claimed of all that it may be about
  // here.
  double sigma_m = 0;
  // Only of methods that know the camera's pose, not just its along:
  std::optional<double> lateral_m;        // from the segment's line, positive to the right
  std::optional<double> lateral_sigma_m;  // one standard deviation
  std::optional<double> heading_deg;      // of the camera, clockwise from north, [0, 360)
  // Where the camera is: beside the line where its lateral is known, else on it, at along_m.
  std::optional<GeoPoint> position;
  int matches = 0;  // features that agreed on the measurement
};

// One frame of the query camera. Its features are asked for once the map, and with it the
// parameters of the extractor, is known; the reference is used during localize() only. Methods that
// compare whole images ask for the descriptor of schema/feature/wisurf.h and find nothing without
// it; others never ask.
struct QueryFrame {
  double timestamp_s = 0;
  std::function<const FeatureSet&(const FeatureParameters&)> features;
  std::function<const ImageDescriptor&()> image = {};
};

struct QueryCamera {
  int width_px = 0;
  int height_px = 0;  // 0: as high as wide
  double focal_x_px = 0;
  double focal_y_px = 0;
  double principal_x_px = 0;
  double principal_y_px = 0;
};

// What one tracklet said of a frame that was followed, for those who study estimates.
struct TrackletEstimate {
  PositionEstimate estimate;
  double scale_px = 0;   // of the matched feature, as the map's camera would see it
  AlongRange along;      // of the tracklet
  double r_squared = 0;  // of its regression
};

struct LocalizerSettings {
  Method method;
  double start_radius_m = 30;   // segments farther from the coarse position are not looked at
  double start_sigmas = 3;      // of the coarse position, searched along the segment
  double start_reach_m = 5;     // ... and so much more
  int min_start_support = 6;    // tracklets or landmarks that must agree before a start is weighed
  double max_coarse_age_s = 3;  // older positions start and contradict nothing
  PlaceOddsSettings odds;
  ReceiverEvidenceSettings receiver;
  int max_places = 5;            // that are weighed against each other
  int max_predicted_frames = 8;  // frames without measurement before the vehicle counts as lost
  double prefetch_m = 300;       // fetched ahead in the background; 0 turns it off
  WindowSettings window;
  // Called by localize() for each estimate of a frame that is followed by tracklets; may be empty.
  std::function<void(const TrackletEstimate&)> on_estimate = {};
};

// Not safe to use from several threads at once. Fixes depend on frames, positions and map only:
// what is missing is waited for, so the prefetcher changes times, not results.
class Localizer {
 public:
  Localizer(std::shared_ptr<MapSource> source, const QueryCamera& camera,
            const LocalizerSettings& settings);
  ~Localizer();
  Localizer(Localizer&&) noexcept;
  Localizer& operator=(Localizer&&) noexcept;

  // What the receiver says; of several the latest counts.
  void observe(const CoarsePosition& position);

  // What the wheels say, of methods that carry on by them (milepost) the motion between frames. A
  // reading is told before the first frame that is later than it; readings ascend, and others are
  // left out.
  void observe(const Odometry& odometry);

  // The fix of the next frame. REQUIRES: timestamps ascend strictly.
  // Errors: what the map source says when there is nothing to go on with (unavailable, corrupt,
  // ...), and invalid_input where the map lacks the method's layer. The localizer stays usable: the
  // next frame may succeed. Once tracking, a source that fails is noted and driven on without.
  Result<Fix> localize(const QueryFrame& frame);

  // The latest failure of the source that did not keep localize() from answering.
  const std::optional<Error>& noted_error() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost
