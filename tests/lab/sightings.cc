// What single frames say for places all over a map, theirs and others: how the evidence of
// client/localize/place_evidence.h holds on drives (schema/DECISIONS.md, 31).
// usage: milepost-sightings MAP DRIVE EVERY OUT.csv
// Looks with each EVERYth frame about each sixth metre of each segment, as a start does, and writes
// a row for each place it puts the camera at.
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string_view>

#include "client/evaluate/drive_playback.h"
#include "client/fetch/file_source.h"
#include "client/localize/follower.h"
#include "client/localize/landmark_method.h"
#include "schema/drive/frame_image.h"
#include "schema/feature/extractor.h"

namespace {

using namespace milepost;

constexpr double kPlacesApartM = 6;
constexpr double kReachM = 8;  // of a look, to either side

int fail(const Error& error) {
  std::fprintf(stderr, "milepost-sightings: %s\n", error.line().c_str());
  return 1;
}

// Writes what one frame says for the places of one segment.
Status look_along(Scout& scout, const SegmentSession& session, const NearbySegment& segment,
                  const QueryFrame& query, const std::string& filename, std::ostream& out) {
  SeenFrame frame(query);
  for (double along_m = 0; along_m <= session.line.length_m(); along_m += kPlacesApartM) {
    const auto sightings = scout.look(frame, AlongRange{along_m, along_m}.widened(kReachM));
    if (!sightings) return sightings.error();
    for (const Sighting& sighting : *sightings) {
      const TrackedPosition at = sighting.follower->position();
      const GeoPoint place = at.across ? at.across->position : session.line.point_at(at.along_m);
      const LineProjection beside = session.line.project(place);
      const double up_m = place.altitude_m - session.line.point_at(beside.along_m).altitude_m;
      const double line_deg = session.line.heading_deg_at(beside.along_m);
      const double heading_deg = at.across ? at.across->heading_deg : line_deg;
      const double turned_deg = std::remainder(heading_deg - line_deg, 360);
      char row[256];
      std::snprintf(row, sizeof row, "%s,%s,%.3f,%.10f,%.10f,%d,%.4f,%.3f,%.3f,%.3f\n",
                    filename.c_str(), segment.segment.c_str(), at.along_m, place.latitude_deg,
                    place.longitude_deg, sighting.matches, sighting.log_bayes_factor,
                    beside.lateral_m, up_m, turned_deg);
      out << row;
    }
  }
  return ok_status();
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t every = 0;
  const std::string_view word = argc == 5 ? argv[3] : "";
  if (std::from_chars(word.data(), word.data() + word.size(), every).ec != std::errc() ||
      every == 0) {
    std::fprintf(stderr, "usage: milepost-sightings MAP DRIVE EVERY OUT.csv\n");
    return 2;
  }
  const Result<Drive> drive = read_drive(argv[2]);
  if (!drive) return fail(drive.error());
  Result<std::unique_ptr<MapSource>> opened = open_file_source(argv[1]);
  if (!opened) return fail(opened.error());
  const std::shared_ptr<MapSource> source = std::move(*opened);
  const Method method = landmark_method();
  const QueryCamera query_camera = query_camera_of(drive->camera);
  std::ofstream out(argv[4]);
  out << "filename,segment,along_m,latitude_deg,longitude_deg,matches,log_bayes_factor,"
         "lateral_m,up_m,turned_deg\n";
  constexpr double kAnywhereM = 5000;
  const auto segments = source->segments_near(drive->frames.front().position, kAnywhereM);
  if (!segments) return fail(segments.error());
  const FrameReader frames(*drive);
  for (const NearbySegment& segment : *segments) {
    const auto session = open_session({source, segment.version, segment.segment, method.layer});
    if (!session) return fail(session.error());
    const auto scout = method.make_scout(*session, query_camera, ScoutSettings());
    if (!scout) return fail(scout.error());
    FeatureExtractor extractor(session->feature);
    for (std::size_t i = 0; i < drive->frames.size(); i += every) {
      const Result<cv::Mat> gray = frames.gray(i);
      if (!gray) return fail(gray.error());
      const FeatureSet features = extractor.extract(*gray);
      const QueryFrame query{
          drive->frames[i].timestamp_s,
          [&](const FeatureParameters&) -> const FeatureSet& { return features; }};
      const Status looked =
          look_along(**scout, *session, segment, query, drive->frames[i].filename, out);
      if (!looked) return fail(looked.error());
    }
  }
  out.close();
  if (out.fail()) {
    return fail({ErrorCode::io, argv[4], "cannot be written", "check the path and the disk"});
  }
  return 0;
}
