// The tracklets around the vehicle: decoded tiles of one layer of one segment, with an index.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "client/fetch/map_source.h"
#include "schema/feature/descriptor_index.h"
#include "schema/tile/tracklet.h"

namespace milepost {

struct WindowSettings {
  double ahead_m = 60;   // fetched beyond what is needed, so that not every frame asks the source
  double behind_m = 60;  // kept behind what is needed
  IndexSettings index;
};

// Not safe to use from several threads at once.
class TrackletWindow {
 public:
  TrackletWindow(std::shared_ptr<MapSource> source, MapVersion version, std::string segment,
                 std::string layer, const WindowSettings& settings);

  // Makes sure that every tracklet whose along range meets `range` is held; fetches and lets go.
  // After an error what was held is held still. Errors: those of MapSource::tiles, corrupt (a
  // tile).
  Status cover(const AlongRange& range);

  // Valid until the next cover().
  const std::vector<Tracklet>& tracklets() const { return tracklets_; }
  ScaleModel model() const { return model_; }
  const DescriptorIndex& index() const { return *index_; }  // over tracklets(), in their order
  const AlongRange& covered() const { return covered_; }

 private:
  void rebuild();

  std::shared_ptr<MapSource> source_;
  MapVersion version_;
  std::string segment_;
  std::string layer_;
  WindowSettings settings_;

  AlongRange covered_{0, -1};
  std::map<std::uint32_t, TrackletTile> tiles_;
  ScaleModel model_ = ScaleModel::inverse_scale;
  std::vector<Tracklet> tracklets_;
  std::vector<Descriptor> descriptors_;
  std::unique_ptr<DescriptorIndex> index_;
};

}  // namespace milepost
