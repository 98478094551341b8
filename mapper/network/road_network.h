// Drives become one road network: directed segments, the passes of each, and the links between
// them. Pure geometry: no images, no files.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mapper/findings/finding.h"
#include "mapper/network/alignment.h"
#include "mapper/network/driven_line.h"
#include "mapper/network/junctions.h"
#include "mapper/network/same_road.h"
#include "mapper/network/stacked_roads.h"

namespace milepost {

// One drive's way over a segment.
struct Pass {
  std::size_t drive = 0;    // index of the drive, as given
  std::size_t stretch = 0;  // index of the driven line in it
  double from_m = 0;        // along that line
  double to_m = 0;          // > from_m

  friend bool operator==(const Pass&, const Pass&) = default;
};

// A directed stretch of road that the same drives passed from its begin to its end.
struct NetworkSegment {
  // The reference pass's drive, and the metre of the drive's forward way at which it begins:
  // "morning-135". A valid segment id: see segment_id_of.
  std::string id;
  std::vector<Pass> passes;   // sorted by the drive's name, then in driving order; not empty
  std::size_t reference = 0;  // index of the pass whose line and landmarks the segment takes
  // Ids of segments that a drive went on to; the reference pass's own first, the others sorted.
  std::vector<std::string> successors;
  bool is_beyond_border = false;  // its middle is right of JunctionSettings::border

  const Pass& reference_pass() const { return passes[reference]; }
};

struct RoadNetwork {
  std::vector<NetworkSegment> segments;  // sorted by id
  // Those of the drives in the order of their names, then those of the network.
  std::vector<Finding> findings;
};

struct NetworkSettings {
  double overlap_m = 5;  // of a segment and its successors
  AlignmentSettings alignment;
  SameRoadSettings same_road;
  JunctionSettings junction;
  StackedSettings stacked;
};

// The index of the pass that becomes the reference, of a segment's passes in their order. Must not
// depend on the order in which drives were named.
using ChooseReference = std::function<std::size_t(const std::vector<Pass>&)>;

// The drive whose name comes first, where it first passed.
std::size_t first_pass(const std::vector<Pass>& passes);

// Whether images of two passes show the same road; nothing if they cannot tell. Asked only where
// roads may lie one above the other, with the passes in the order of their drives' names.
using SameRoadByImages = std::function<std::optional<bool>(const Pass& a, const Pass& b)>;

// The network of all drives. It depends on their names and lines, not on their order, but for the
// indices in passes. A drive changes ids only of segments that it passes or ends at.
// REQUIRES: the drives' names differ.
RoadNetwork road_network(const std::vector<NamedDrivenLines>& drives,
                         const NetworkSettings& settings,
                         const ChooseReference& choose_reference = first_pass,
                         const SameRoadByImages& same_road_by_images = {});

// "NAME-METRE"; of a name too long for the 64 characters of an id, its begin and a digest of it.
std::string segment_id_of(const std::string& drive_name, long metre);

// The line of a pass: the driven line's vertices between two points interpolated at its cuts.
struct PassLine {
  std::vector<GeoPoint> vertices;
  std::vector<double> along_m;  // one per vertex, from 0, ascending strictly
};
PassLine line_of(const Pass& pass, const RouteLine& driven);

}  // namespace milepost
