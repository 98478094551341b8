// How the reports of found drives mark a status.
#pragma once

#include <array>

#include "client/global/mode_watch.h"

namespace milepost {

struct FindStatusMark {
  FindStatus status;
  const char* dot_class;   // on plans
  const char* lane_class;  // along axes
  double radius_px;        // of a dot
};

// In the order in which they are drawn, the first beneath.
inline constexpr std::array<FindStatusMark, 4> kFindStatusMarks = {{
    {FindStatus::initializing, "nofix", "s-initializing", 2.0},
    {FindStatus::lost, "f-lost", "s-lost", 3.2},
    {FindStatus::predicted, "f-predicted", "s-predicted", 2.6},
    {FindStatus::tracking, "f-tracking", "s-tracking", 2.6},
}};

}  // namespace milepost
