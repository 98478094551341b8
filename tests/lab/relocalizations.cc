// The log Bayes factors of single frames for places all over a map, theirs and others: how those of
// client/localize/landmark_support.h hold on drives (schema/DECISIONS.md, 31).
// usage: milepost-relocalizations MAP DRIVE EVERY OUT.csv
// Relocalizes each EVERYth frame around each sixth metre of each segment, as a start does, and
// writes a row for each candidate pose.
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string_view>

#include "client/evaluate/drive_playback.h"
#include "client/fetch/file_source.h"
#include "client/fetch/tile_provider.h"
#include "client/localize/landmark_method.h"
#include "client/localize/segment_tracker.h"
#include "schema/drive/frame_image.h"
#include "schema/feature/extractor.h"

namespace {

using namespace milepost;

constexpr double kSpacingM = 6;
constexpr double kReachM = 8;  // of a look, to either side

int fail(const Error& error) {
  std::fprintf(stderr, "milepost-relocalizations: %s\n", error.line().c_str());
  return 1;
}

// Writes what one frame says for the places of one segment.
Status relocalize_along(Relocalizer& relocalizer, const RouteLine& line, const std::string& segment,
                        SharedFrame& frame, const std::string& filename, std::ostream& out) {
  for (double along_m = 0; along_m <= line.length_m(); along_m += kSpacingM) {
    const Relocalization found =
        relocalizer.relocalize(frame, AlongRange{along_m, along_m}.widened(kReachM), std::nullopt);
    if (found.failure) return *found.failure;
    for (const RelocalizationCandidate& candidate : found.candidates) {
      const TrackedPose at = candidate.tracker->pose();
      const GeoPoint place = position_of(at, line);
      const LineProjection beside = line.project(place);
      const double up_m = place.altitude_m - line.point_at(beside.along_m).altitude_m;
      const double line_deg = line.heading_deg_at(beside.along_m);
      const double heading_deg = at.full ? at.full->camera.heading_deg : line_deg;
      const double turned_deg = std::remainder(heading_deg - line_deg, 360);
      char row[256];
      std::snprintf(row, sizeof row, "%s,%s,%.3f,%.10f,%.10f,%d,%.4f,%.3f,%.3f,%.3f\n",
                    filename.c_str(), segment.c_str(), at.along_m, place.latitude_deg,
                    place.longitude_deg, candidate.matches, candidate.log_bayes_factor,
                    beside.lateral_m, up_m, turned_deg);
      out << row;
    }
  }
  return ok_status();
}

// All of a layer of a map about a place, in memory.
Result<std::shared_ptr<const HeldMap>> all_of_the_map(const std::string& file,
                                                      const std::string& layer,
                                                      const GeoPoint& about) {
  constexpr double kAnywhereM = 5000;
  constexpr std::chrono::minutes kLongest(10);
  const Result<std::shared_ptr<MapSource>> source = open_file_source(file);
  if (!source) return source.error();
  TileProvider provider(*source, layer);
  Wants wants;
  wants.around = Surroundings{about, kAnywhereM};
  const SteadyTime deadline = std::chrono::steady_clock::now() + kLongest;
  for (const bool with_tiles : {false, true}) {
    for (const auto& [key, segment] : provider.held()->segments) {
      if (with_tiles && segment->layer) {
        wants.tiles.push_back({key, {0, segment->layer->line.length_m()}});
      }
    }
    provider.want(wants);
    while (!provider.is_settled()) provider.wait_for_change(provider.held(), deadline);
  }
  return provider.held();
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t every = 0;
  const std::string_view word = argc == 5 ? argv[3] : "";
  if (std::from_chars(word.data(), word.data() + word.size(), every).ec != std::errc() ||
      every == 0) {
    std::fprintf(stderr, "usage: milepost-relocalizations MAP DRIVE EVERY OUT.csv\n");
    return 2;
  }
  const Result<Drive> drive = read_drive(argv[2]);
  if (!drive) return fail(drive.error());
  const Method method = landmark_method();
  std::ofstream out(argv[4]);
  out << "filename,segment,along_m,latitude_deg,longitude_deg,matches,log_bayes_factor,"
         "lateral_m,up_m,turned_deg\n";
  const auto held = all_of_the_map(argv[1], method.layer, drive->frames.front().position);
  if (!held) return fail(held.error());
  const FrameReader frames(*drive);
  for (const auto& [key, segment] : (*held)->segments) {
    if (!segment->layer) return fail(*segment->failure);
    const auto relocalizer =
        method.make_relocalizer(segment->layer, drive->camera, MethodSettings());
    if (!relocalizer) return fail(relocalizer.error());
    FeatureExtractor extractor(segment->layer->feature(), drive->camera);
    for (std::size_t i = 0; i < drive->frames.size(); i += every) {
      const Result<cv::Mat> gray = frames.gray(i);
      if (!gray) return fail(gray.error());
      const FeatureSet features = extractor.extract(*gray);
      const QueryFrame query{
          drive->frames[i].timestamp_s,
          [&](const FeatureParameters&) -> const FeatureSet& { return features; }};
      SharedFrame frame(query, **held);
      const Status found = relocalize_along(**relocalizer, segment->layer->line, key.segment, frame,
                                            drive->frames[i].filename, out);
      if (!found) return fail(found.error());
    }
  }
  out.close();
  if (out.fail()) {
    return fail({ErrorCode::io, argv[4], "cannot be written", "check the path and the disk"});
  }
  return 0;
}
