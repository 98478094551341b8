// A drive's forward way: lines without pauses, standstills and reversing.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "mapper/findings/finding.h"
#include "schema/base/result.h"
#include "schema/drive/drive.h"
#include "schema/geo/route_line.h"

namespace milepost {

// A stretch that was driven forwards and without pause.
struct DrivenLine {
  std::vector<std::size_t> frames;  // indices into Drive::frames, ascending, one per vertex
  RouteLine line;
};

struct DrivenLineSettings {
  // Between vertices, measured forwards. Not much below the noise of positions, which lengthens a
  // line of short edges: by 2 % for noise of 0.3 m and 2 m between frames, by 9 % for 1 m.
  double min_frame_spacing_m = 1;
  // Between consecutive frames farther apart than this, and than five times the drive's median
  // spacing, the way is unknown: a pause.
  double max_gap_m = 15;
  // So is the way between frames that differ by more than both of these: the vehicle went on while
  // nothing was recorded.
  double max_pause_s = 30;
  double max_pause_m = 5;
  // Shorter ways back are noise of a standing vehicle.
  double min_reversing_m = 1.5;
  double min_length_m = 10;  // shorter lines are left out
};

// The driven lines of one drive in driving order.
struct NamedDrivenLines {
  std::string name;  // of the drive
  std::vector<DrivenLine> lines;
  std::vector<Finding> findings;  // pauses and reversing, in driving order
};

// Errors: invalid_input for a name that is not a segment id, and for a drive that does not move.
Result<NamedDrivenLines> driven_lines(const Drive& drive, const DrivenLineSettings& settings);

}  // namespace milepost
