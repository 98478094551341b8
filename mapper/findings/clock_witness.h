// Whether the images of a drive turn before or after the recorded headings do, by the headings that
// its images gave it.
#pragma once

#include <optional>
#include <vector>

#include "mapper/geodata/trajectory.h"
#include "schema/drive/drive.h"

namespace milepost {

struct WitnessedHeading {
  RecordedPose recorded;
  double adjusted_deg = 0;  // by the images; turned by the camera's mounting, whatever that is
};

// How much later the recorded poses are than the images: the offset by which the recorded headings,
// moved back, go best with the adjusted ones. Nothing if they go as well as they are, if the drive
// hardly turns, if the offset is 0.9 s or more, or if they do not go best with the recorded
// positions as they are: then they alone are wrong, and not the clock. Headings in any order.
std::optional<double> clock_offset_s(std::vector<WitnessedHeading> headings);

// The drive with the poses that its record has so much earlier; frames without one are left out.
Drive with_poses_of(const Drive& drive, double earlier_s);

}  // namespace milepost
