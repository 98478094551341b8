// Where a map has surveyed marks: triangulated with the adjusted poses of each drive that saw them,
// moved as the drive's landmarks are.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "mapper/acceptance/check_points.h"
#include "mapper/fusion/pose_error.h"
#include "mapper/landmarks/landmark_mapper.h"
#include "schema/document/mapping_record.h"
#include "schema/geo/route_line.h"

namespace milepost {

// Of all residuals together.
struct CheckPointSummary {
  std::size_t marks = 0;   // residuals, of which so many ...
  std::size_t placed = 0;  // ... could be placed
  double plan_rms_m = 0;
  double up_rms_m = 0;
  std::string worst;  // "MARK by DRIVE", in plan
  double worst_plan_m = 0;
};
CheckPointSummary summary_of(const std::vector<CheckPointResidual>& residuals);

class CheckPointSurvey {
 public:
  explicit CheckPointSurvey(std::vector<CheckPoint> points);

  // Keeps the adjusted pose of a frame in which a mark is seen. `stretch` numbers the stretches of
  // all drives.
  void add(const Drive& drive, const std::string& filename, std::size_t stretch,
           const AdjustedFrame& frame);

  // By how much a drive's landmarks are moved there.
  using ErrorAt = std::function<PoseError(std::size_t stretch, double along_m)>;
  using LineOf = std::function<const RouteLine&(std::size_t stretch)>;
  // One for each mark and drive that saw it, in the order of the marks: in too few mapped frames to
  // place it, without a position.
  std::vector<CheckPointResidual> residuals(const std::vector<const Drive*>& drives,
                                            const ErrorAt& error_at, const LineOf& line_of) const;

 private:
  struct Placed {
    std::size_t stretch = 0;
    AdjustedFrame frame;
  };
  CheckPointResidual residual(const CheckPoint& point, const Drive& drive, const ErrorAt& error_at,
                              const LineOf& line_of) const;

  std::vector<CheckPoint> points_;
  std::map<std::pair<std::string, std::string>, std::vector<Placed>> frames_;  // drive, filename
};

}  // namespace milepost
