#include "client/localize/follower.h"

namespace milepost {

Error unusable_items(const SegmentSession& session) {
  return {ErrorCode::corrupt,
          "map '" + session.layer.version.map + "', layer '" + session.layer.layer + "'",
          std::string("the method cannot use its ") + name_of(session.items), "build the map anew"};
}

}  // namespace milepost
