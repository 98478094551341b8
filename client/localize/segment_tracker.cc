#include "client/localize/segment_tracker.h"

namespace milepost {

Error unusable_items(const SegmentLayer& layer) {
  return {ErrorCode::corrupt, "map '" + layer.map() + "', layer '" + layer.name + "'",
          std::string("the method cannot use its ") + name_of(layer.parameters().items),
          "build the map anew"};
}

}  // namespace milepost
