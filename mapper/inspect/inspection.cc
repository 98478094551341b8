#include "mapper/inspect/inspection.h"

#include <algorithm>
#include <cmath>
#include <system_error>

#include <nlohmann/json.hpp>

#include "schema/base/digits.h"
#include "schema/base/json.h"
#include "schema/tile/codec.h"
#include "schema/tile/layer_items.h"
#include "schema/tile/layer_parameters.h"

namespace milepost {
namespace {

using Json = nlohmann::ordered_json;

// Stretches of 10 m and more where at each metre fewer landmarks were seen than a fix needs.
std::vector<AlongRange> gaps_of(const std::vector<AlongRange>& seen, double length_m) {
  constexpr int kFewest = 20;
  constexpr double kStepM = 2;
  constexpr double kLeastM = 10;
  std::vector<int> counts(static_cast<std::size_t>(std::ceil(length_m / kStepM)) + 1, 0);
  for (const AlongRange& range : seen) {
    const auto first = static_cast<std::size_t>(std::max(0.0, range.from_m / kStepM));
    for (std::size_t i = first; i < counts.size() && static_cast<double>(i) * kStepM <= range.to_m;
         ++i)
      ++counts[i];
  }
  std::vector<AlongRange> gaps;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] >= kFewest) continue;
    const double from_m = static_cast<double>(i) * kStepM;
    while (i + 1 < counts.size() && counts[i + 1] < kFewest) ++i;
    const double to_m = std::min(length_m, static_cast<double>(i) * kStepM);
    if (to_m - from_m >= kLeastM) gaps.push_back({from_m, to_m});
  }
  return gaps;
}

Result<SegmentInspection> inspect_segment(const MapReader& map, const std::string& id) {
  SegmentInspection segment;
  Result<StoredSegment> stored = map.segment(id);
  if (!stored) return stored.error();
  segment.stored = std::move(*stored);
  std::vector<AlongRange> seen;
  if (map.layers().contains(layers::kLandmarks)) {
    const auto index = map.tile_index(id, layers::kLandmarks);
    if (!index) return index.error();
    for (const TileEntry& entry : *index) {
      const auto frame = map.tile(id, layers::kLandmarks, entry);
      if (!frame) return frame.error();
      const auto tile = decode_landmarks(*frame);
      if (!tile) return tile.error();
      segment.bytes += entry.bytes;
      segment.landmarks += tile->landmarks.size();
      for (const Landmark& landmark : tile->landmarks) {
        if (landmark.passes > 1) ++segment.repeated;
        seen.push_back(landmark.along);
      }
    }
  }
  segment.gaps = gaps_of(seen, segment.stored.length_m);
  return segment;
}

Json json_of(const SegmentInspection& segment) {
  const StoredSegment& stored = segment.stored;
  Json json = {{"id", stored.id},
               {"length_m", stored.length_m},
               {"landmarks", segment.landmarks},
               {"seen_by_two_or_more", segment.repeated},
               {"bytes", segment.bytes}};
  const PositionError& error = stored.position_error;
  json["position_sigma_m"] = error.sigma_m ? Json(*error.sigma_m) : Json(nullptr);
  json["assumed"] = error.is_assumed;
  json["passes"] = Json::array();
  for (const StoredPass& pass : stored.passes) json["passes"].push_back(pass.drive);
  json["successors"] = Json::array();
  for (const Successor& successor : stored.successors)
    json["successors"].push_back(successor.map.empty() ? successor.segment
                                                       : successor.map + "/" + successor.segment);
  json["gaps"] = Json::array();
  for (const AlongRange& gap : segment.gaps) json["gaps"].push_back({gap.from_m, gap.to_m});
  return json;
}

double kb_per_m(std::uint64_t bytes, double length_m) {
  return length_m > 0 ? static_cast<double>(bytes) / 1000 / length_m : 0;
}

std::string counted(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

}  // namespace

double MapInspection::length_m() const {
  double sum_m = 0;
  for (const SegmentInspection& segment : segments) sum_m += segment.stored.length_m;
  return sum_m;
}

double MapInspection::gaps_m() const {
  double sum_m = 0;
  for (const SegmentInspection& segment : segments) {
    for (const AlongRange& gap : segment.gaps) sum_m += gap.to_m - gap.from_m;
  }
  return sum_m;
}

Result<MapInspection> inspect(const MapReader& map) {
  MapInspection inspected;
  inspected.file = map.file().string();
  inspected.build = map.build();
  std::error_code error;
  inspected.bytes = std::filesystem::file_size(map.file(), error);
  inspected.bounds = map.bounds();
  inspected.datum = map.datum();
  for (const auto& [name, parameters] : map.layers()) {
    const Result<nlohmann::json> json = read_json(parameters);
    LayerInspection layer{name, json ? items_named_in(*json) : ""};
    for (const std::string& id : map.segment_ids()) {
      const auto index = map.tile_index(id, name);
      if (!index) return index.error();
      for (const TileEntry& entry : *index) {
        ++layer.tiles;
        layer.count += entry.items;
        layer.bytes += entry.bytes;
      }
    }
    const auto cells = map.cell_index(name);
    if (!cells) return cells.error();
    for (const CellEntry& entry : *cells) {
      ++layer.tiles;
      layer.count += entry.items;
      layer.bytes += entry.bytes;
    }
    inspected.layers.push_back(std::move(layer));
  }
  for (const std::string& id : map.segment_ids()) {
    Result<SegmentInspection> segment = inspect_segment(map, id);
    if (!segment) return segment.error();
    inspected.segments.push_back(std::move(*segment));
  }
  return inspected;
}

Json to_json(const MapInspection& map) {
  Json json = {
      {"file", map.file},
      {"build", map.build},
      {"bytes", map.bytes},
      {"length_m", map.length_m()},
      {"bounds_deg",
       {map.bounds.west_deg, map.bounds.south_deg, map.bounds.east_deg, map.bounds.north_deg}},
      {"datum", map.datum.empty() ? Json(nullptr) : Json(map.datum)},
      {"layers", Json::array()},
      {"segments", Json::array()}};
  for (const LayerInspection& layer : map.layers) {
    json["layers"].push_back({{"name", layer.name},
                              {"items", layer.items},
                              {"tiles", layer.tiles},
                              {"count", layer.count},
                              {"bytes", layer.bytes}});
  }
  for (const SegmentInspection& segment : map.segments)
    json["segments"].push_back(json_of(segment));
  return json;
}

std::string text_of(const MapInspection& map) {
  std::string text = map.file + ": build " + map.build + ", " +
                     counted(map.segments.size(), "segment") + " of " + fixed(map.length_m(), 1) +
                     " m, " + fixed(static_cast<double>(map.bytes) / 1e6, 2) + " MB" +
                     (map.datum.empty() ? "" : ", positions in " + map.datum) + "\n";
  for (const LayerInspection& layer : map.layers) {
    text += "layer " + layer.name + ": " + std::to_string(layer.count) + " " + layer.items +
            " in " + counted(layer.tiles, "tile") + ", " +
            fixed(kb_per_m(layer.bytes, map.length_m()), 2) + " kB/m\n";
  }
  for (const SegmentInspection& segment : map.segments) {
    const StoredSegment& stored = segment.stored;
    const double per_m = static_cast<double>(segment.landmarks) / std::max(1e-9, stored.length_m);
    text += "segment " + stored.id + ": " + fixed(stored.length_m, 1) + " m, " +
            std::to_string(stored.passes.size()) +
            (stored.passes.size() == 1 ? " pass, " : " passes, ") + fixed(per_m, 1) +
            " landmarks per metre";
    if (segment.repeated > 0) {
      text += ", " +
              fixed(100 * static_cast<double>(segment.repeated) /
                        static_cast<double>(segment.landmarks),
                    0) +
              " % seen by two drives or more";
    }
    const PositionError& error = stored.position_error;
    if (error.sigma_m) {
      text += ", positions to " + fixed(*error.sigma_m, 3) + " m" +
              (error.is_assumed ? " (assumed)" : "");
    }
    for (const AlongRange& gap : segment.gaps)
      text += ", few landmarks from " + fixed(gap.from_m, 0) + " to " + fixed(gap.to_m, 0) + " m";
    text += ", to";
    for (const Successor& successor : stored.successors)
      text += " " + (successor.map.empty() ? "" : successor.map + "/") + successor.segment;
    text += stored.successors.empty() ? " no other segment\n" : "\n";
  }
  return text;
}

}  // namespace milepost
