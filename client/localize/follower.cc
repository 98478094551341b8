#include "client/localize/follower.h"

namespace milepost {

Result<std::unique_ptr<Follower>> make_follower(const SegmentSession& session,
                                                const QueryCamera& camera,
                                                const LocalizerSettings& settings) {
  const auto* tracklets = std::get_if<TrackletMethod>(&settings.method.how);
  const bool of_tracklets =
      session.items == LayerItems::tracklets || session.items == LayerItems::observations;
  const bool usable = tracklets ? of_tracklets : session.items == LayerItems::frames;
  if (!usable) {
    return Error{ErrorCode::corrupt,
                 "map '" + session.layer.version.map + "', layer '" + session.layer.layer + "'",
                 std::string("the method cannot use its ") + name_of(session.items),
                 "build the map anew"};
  }
  return tracklets ? make_tracklet_follower(session, camera, settings, *tracklets)
                   : make_warp_follower(session, camera, settings,
                                        std::get<WarpMethod>(settings.method.how));
}

}  // namespace milepost
