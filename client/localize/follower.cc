#include "client/localize/follower.h"

namespace milepost {

Result<std::unique_ptr<Scout>> make_scout(const SegmentSession& session, const QueryCamera& camera,
                                          const LocalizerSettings& settings) {
  const auto& how = settings.method.how;
  const LayerItems items = session.items;
  if (const auto* landmarks = std::get_if<LandmarkMethod>(&how)) {
    if (items == LayerItems::landmarks)
      return make_landmark_scout(session, camera, settings, *landmarks);
  } else if (const auto* tracklets = std::get_if<TrackletMethod>(&how)) {
    if (items == LayerItems::tracklets || items == LayerItems::observations)
      return make_tracklet_scout(session, camera, settings, *tracklets);
  } else if (items == LayerItems::frames) {
    return make_warp_scout(session, camera, settings, std::get<WarpMethod>(how));
  }
  return Error{ErrorCode::corrupt,
               "map '" + session.layer.version.map + "', layer '" + session.layer.layer + "'",
               std::string("the method cannot use its ") + name_of(items), "build the map anew"};
}

}  // namespace milepost
