// The relocalizers of segments that were searched recently.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "client/localize/method.h"
#include "client/localize/segment_tracker.h"
#include "schema/geo/camera.h"

namespace milepost {

class RecentRelocalizers {
 public:
  RecentRelocalizers(Method method, const Camera& camera, MethodSettings settings)
      : method_(std::move(method)), camera_(camera), settings_(std::move(settings)) {}

  // Valid until the next call. Errors: the method's, where it cannot use the layer.
  Result<Relocalizer*> on(const std::shared_ptr<const SegmentLayer>& layer);

 private:
  struct OpenSegment {
    std::shared_ptr<const SegmentLayer> layer;
    std::unique_ptr<Relocalizer> relocalizer;
  };

  Method method_;
  Camera camera_;
  MethodSettings settings_;
  std::vector<OpenSegment> segments_;  // the latest last
};

}  // namespace milepost
