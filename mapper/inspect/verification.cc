#include "mapper/inspect/verification.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <nlohmann/json.hpp>

#include "schema/base/digits.h"
#include "schema/base/json.h"
#include "schema/document/mapping_record.h"
#include "schema/geo/geodesy.h"
#include "schema/tile/codec.h"
#include "schema/tile/layer_items.h"
#include "schema/tile/layer_parameters.h"

namespace milepost {
namespace {

constexpr const char* kMend = "build the map anew";

GeoPoint position_of(const StoredVertex& vertex) {
  return {vertex.latitude_deg, vertex.longitude_deg, vertex.altitude_m};
}

class Verification {
 public:
  explicit Verification(const MapReader& map) : map_(map) {}

  std::vector<Finding> run() {
    if (const Status sound = map_.verify(); !sound) tell("damage", "", sound.error().line());
    for (const std::string& id : map_.segment_ids()) {
      const Result<StoredSegment> segment = map_.segment(id);
      if (!segment) {
        tell("damage", "segment " + id, segment.error().what);
        continue;
      }
      line(*segment);
      links(*segment);
      tiles(*segment);
    }
    walls();
    record();
    return std::move(findings_);
  }

 private:
  // Of the mapping. That it is the build's has been checked.
  void record() {
    const Result<std::string> document = map_.mapping_document();
    if (!document || document->empty()) return;
    if (const auto read = mapping_record_from(*document); !read)
      tell("malformed_record", "", read.error().what);
  }

  void tell(const std::string& kind, const std::string& place, const std::string& what) {
    const std::string where = map_.file().string() + (place.empty() ? "" : ", " + place);
    findings_.push_back({kind, where, 0, 1, what, kMend});
  }

  void line(const StoredSegment& segment) {
    constexpr double kPart = 0.01;
    constexpr double kMarginM = 0.05;
    const std::string place = "segment " + segment.id;
    if (segment.vertices.size() < 2) {
      tell("line", place, "has no line");
      return;
    }
    for (std::size_t i = 1; i < segment.vertices.size(); ++i) {
      const StoredVertex& from = segment.vertices[i - 1];
      const StoredVertex& to = segment.vertices[i];
      const double apart_m = geodesic_distance_m(position_of(from), position_of(to));
      const double along_m = to.along_m - from.along_m;
      if (std::abs(apart_m - along_m) <= kPart * apart_m + kMarginM) continue;
      tell("line", place + ", vertex " + std::to_string(i),
           "lies " + fixed(apart_m, 2) + " m from the one before, " + fixed(along_m, 2) +
               " m along the line");
      return;
    }
    if (std::abs(segment.vertices.back().along_m - segment.length_m) > kMarginM) {
      tell("line", place,
           "ends at " + fixed(segment.vertices.back().along_m, 2) + " m, its length is " +
               fixed(segment.length_m, 2) + " m");
    }
  }

  // A successor begins beside the end of the segment: roads of one direction lie side by side.
  void links(const StoredSegment& segment) {
    constexpr double kMostM = 30;
    for (const Successor& successor : segment.successors) {
      if (!successor.map.empty()) continue;  // another map's
      const std::string place = "segment " + segment.id;
      const auto& ids = map_.segment_ids();
      if (!std::ranges::binary_search(ids, successor.segment)) {
        tell("link", place, "goes on to '" + successor.segment + "', which is not in the map");
        continue;
      }
      const Result<StoredSegment> next = map_.segment(successor.segment);
      if (!next || next->vertices.empty() || segment.vertices.empty()) continue;  // told elsewhere
      const double apart_m = geodesic_distance_m(position_of(segment.vertices.back()),
                                                 position_of(next->vertices.front()));
      if (apart_m <= kMostM) continue;
      tell("link", place,
           "goes on to '" + successor.segment + "', which begins " + fixed(apart_m, 0) + " m away");
    }
  }

  void tiles(const StoredSegment& segment) {
    for (const auto& [layer, parameters] : map_.layers()) {
      const auto index = map_.tile_index(segment.id, layer);
      if (!index) {
        tell("damage", "segment " + segment.id + ", layer " + layer, index.error().what);
        continue;
      }
      const Result<nlohmann::json> json = read_json(parameters);
      const std::string items = json ? items_named_in(*json) : "";
      for (const TileEntry& entry : *index) {
        const std::string place =
            "segment " + segment.id + ", layer " + layer + ", tile " + std::to_string(entry.index);
        const auto frame = map_.tile(segment.id, layer, entry);
        if (!frame) {
          tell("damage", place, frame.error().what);
          continue;
        }
        tile(segment, entry, items, *frame, place);
      }
    }
  }

  void tile(const StoredSegment& segment, const TileEntry& entry, const std::string& items,
            const Bytes& frame, const std::string& place) {
    const auto check = [&](const auto& tile, const auto& held) {
      if (!tile) {
        tell("tile", place, tile.error().what);
      } else if (tile->segment != segment.id || tile->index != entry.index) {
        tell("tile", place,
             "is tile " + std::to_string(tile->index) + " of segment '" + tile->segment + "'");
      } else if (held(*tile).size() != entry.items) {
        tell("tile", place,
             "holds " + std::to_string(held(*tile).size()) + " items, not " +
                 std::to_string(entry.items));
      }
    };
    if (items == name_of(LayerItems::landmarks)) {
      const auto tile = decode_landmarks(frame);
      check(
          tile, [](const LandmarkTile& each) -> const auto& { return each.landmarks; });
      if (!tile) return;
      for (const Landmark& landmark : tile->landmarks) {
        if (entry.along.from_m <= landmark.along.from_m && landmark.along.to_m <= entry.along.to_m)
          continue;
        tell("tile", place, "holds a landmark beyond its range");
        return;
      }
    } else if (items == name_of(LayerItems::tracklets)) {
      check(
          decode_tile(frame),
          [](const TrackletTile& each) -> const auto& { return each.tracklets; });
    } else if (items == name_of(LayerItems::observations)) {
      const auto tile = decode_observations(frame);
      if (!tile) tell("tile", place, tile.error().what);
    } else {
      const auto tile = decode_frames(frame);
      if (!tile) tell("tile", place, tile.error().what);
    }
  }

  void walls() {
    for (const auto& [layer, parameters] : map_.layers()) {
      const auto index = map_.cell_index(layer);
      if (!index) {
        tell("damage", "layer " + layer, index.error().what);
        continue;
      }
      for (const CellEntry& entry : *index) {
        const std::string place = "layer " + layer + ", cell " + std::to_string(entry.cell);
        const auto frame = map_.cell(layer, entry);
        if (!frame) {
          tell("damage", place, frame.error().what);
          continue;
        }
        const auto tile = decode_walls(*frame);
        if (!tile) tell("tile", place, tile.error().what);
      }
    }
  }

  const MapReader& map_;
  std::vector<Finding> findings_;
};

}  // namespace

std::vector<Finding> contradictions_in(const MapReader& map) { return Verification(map).run(); }

}  // namespace milepost
