// Gathers tracklets into tiles and lets go of each tile as soon as it is complete.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "schema/tile/tracklet.h"

namespace milepost {

// Not safe to use from several threads.
class TileAssembler {
 public:
  TileAssembler(std::string segment, ScaleModel model, double tile_length_m);

  void add(const Tracklet& tracklet);
  // The tiles that no tracklet beginning at `along_m` or later belongs to, ascending; each once.
  std::vector<TrackletTile> take_complete(double along_m);
  // The rest.
  std::vector<TrackletTile> take_all();

 private:
  std::string segment_;
  ScaleModel model_;
  double tile_length_m_;
  std::map<std::uint32_t, TrackletTile> tiles_;
};

}  // namespace milepost
