#include "mapper/pipeline/build_map.h"

#include <algorithm>
#include <limits>
#include <set>

#include <nlohmann/json.hpp>

#include "mapper/pipeline/frame_pipeline.h"
#include "mapper/pipeline/layer_builder.h"
#include "mapper/pipeline/layers.h"
#include "mapper/pipeline/stretch_plan.h"
#include "mapper/pipeline/trained_projection.h"
#include "schema/store/map_store.h"

namespace milepost {
namespace {

using OnProgress = std::function<bool(const BuildProgress&)>;

struct NamedBuilder {
  std::string layer;
  std::unique_ptr<LayerBuilder> builder;
};

// Builds the tiles of a stretch's segments from its frames.
class StretchBuilder {
 public:
  StretchBuilder(const Drive& drive, const StretchPlan& plan, const PcaProjection& projection,
                 const BuildSettings& settings)
      : drive_(drive),
        plan_(plan),
        settings_(settings),
        context_{drive.camera, plan.segments, projection, settings.tile_length_m},
        tracker_(settings.follow, drive.camera.width_px) {
    for (const Layer& layer : layers_of(settings)) {
      layers_.push_back({layer.name, make_layer_builder(layer, context_)});
    }
  }

  // Adds its counts to the last of the report's drives.
  Status run(int jobs, MapWriter& map, BuildReport& report, BuildProgress& progress,
             const OnProgress& on_progress) {
    FramePipeline frames(drive_, plan_.frame_indices, settings_.feature, settings_.lab, jobs);
    for (std::size_t i = 0; i < plan_.frame_indices.size(); ++i) {
      const double along_m = plan_.line.along_m()[i];
      const Frame& recorded = drive_.frames[plan_.frame_indices[i]];
      const Result<ExtractedFrame> frame = frames.next();
      if (!frame) return frame.error();
      count(*frame, report.drives.back());
      for (const NamedBuilder& layer : layers_) layer.builder->add_frame(recorded, *frame, along_m);
      const std::vector<Track> ended = tracker_.add(frame->features, along_m);
      const Status written = add_and_write(ended, tracker_.oldest_open_along_m(), map, report);
      if (!written.ok()) return written;
      ++progress.frames_done;
      if (!on_progress(progress)) {
        return Error{ErrorCode::cancelled, drive_.folder.string(),
                     "stopped on request, no map was written", ""};
      }
    }
    return add_and_write(tracker_.finish(), std::numeric_limits<double>::infinity(), map, report);
  }

 private:
  static void count(const ExtractedFrame& frame, DriveReport& found) {
    ++found.frames;
    found.features += frame.features.descriptors.size();
    found.darkest = std::min(found.darkest, frame.darkest);
    found.brightest = std::max(found.brightest, frame.brightest);
  }

  Status add_and_write(const std::vector<Track>& ended, double complete_until_m, MapWriter& map,
                       BuildReport& report) {
    for (const NamedBuilder& layer : layers_) {
      layer.builder->add_tracks(ended);
      const Result<std::vector<StoredTile>> tiles = layer.builder->take_complete(complete_until_m);
      if (!tiles) return tiles.error();
      for (const StoredTile& tile : *tiles) {
        const Status added =
            map.add_tile(tile.segment, layer.layer, tile.index, tile.along, tile.items, tile.frame);
        if (!added.ok()) return added;
        ++report.tiles;
        if (layer.layer != layers::kLandmarks) continue;
        report.tracklets += tile.items;
        report.drives.back().tracklets += tile.items;
        report.tracklet_bytes += tile.frame.size();
      }
    }
    return ok_status();
  }

  const Drive& drive_;
  const StretchPlan& plan_;
  const BuildSettings& settings_;
  StretchContext context_;
  FeatureTracker tracker_;
  std::vector<NamedBuilder> layers_;
};

Status check_names_differ(const std::vector<Drive>& drives) {
  std::set<std::string> names;
  for (const Drive& drive : drives) {
    if (names.insert(drive.name).second) continue;
    return Error{ErrorCode::invalid_input, "drive '" + drive.name + "'",
                 "two drives have this name", "give each drive.json a name of its own"};
  }
  return ok_status();
}

Status check_cameras_agree(const std::vector<Drive>& drives) {
  for (const Drive& drive : drives) {
    if (drive.camera == drives.front().camera) continue;
    return Error{
        ErrorCode::invalid_input, (drive.folder / "drive.json").string(),
        "its camera differs from that of " + (drives.front().folder / "drive.json").string(),
        "build a map for each camera"};
  }
  return ok_status();
}

}  // namespace

Error nothing_found(const DriveReport& drive) {
  return {ErrorCode::invalid_input, drive.folder,
          "nothing to localize with was found in its " + std::to_string(drive.frames) +
              " frames: features " + std::to_string(drive.features) + ", grey values " +
              std::to_string(drive.darkest) + " to " + std::to_string(drive.brightest) +
              " of 0 to 255, tracklets 0",
          "check its frames and their order, leave the drive out, or give --allow-empty"};
}

Result<BuildReport> build_map(const std::vector<Drive>& drives,
                              const std::filesystem::path& map_file, const BuildSettings& settings,
                              int jobs, const OnProgress& on_progress) {
  std::vector<StretchPlan> plans;
  BuildProgress progress;
  for (const Drive& drive : drives) {
    Result<StretchPlan> plan = plan_stretch(drive, settings.min_frame_spacing_m);
    if (!plan) return plan.error();
    progress.frames_total += plan->frame_indices.size();
    plans.push_back(std::move(*plan));
  }
  for (const Status& checked : {check_names_differ(drives), check_cameras_agree(drives)}) {
    if (!checked.ok()) return checked.error();
  }

  const Result<PcaProjection> projection = trained_projection(drives, plans, settings, jobs);
  if (!projection) return projection.error();
  Result<MapWriter> map = MapWriter::create(map_file);
  if (!map) return map.error();
  Status status = map->set_feature_json(to_json(settings.feature).dump());
  for (const Layer& layer : layers_of(settings)) {
    if (status.ok())
      status = map->add_layer(
          layer.name,
          to_json(parameters_of(layer, drives.front().camera, *projection, settings.tile_length_m))
              .dump());
  }
  BuildReport report;
  for (std::size_t i = 0; i < plans.size() && status.ok(); ++i) {
    report.drives.push_back({.folder = drives[i].folder.string()});
    for (const SegmentCut& segment : plans[i].segments) {
      if (status.ok()) status = map->add_segment(stored_segment(segment));
    }
    if (status.ok()) {
      status = StretchBuilder(drives[i], plans[i], *projection, settings)
                   .run(jobs, *map, report, progress, on_progress);
    }
    if (status.ok() && report.drives.back().tracklets == 0 && !settings.allow_empty) {
      status = nothing_found(report.drives.back());
    }
    report.length_m += plans[i].line.length_m();
  }
  if (!status.ok()) return status.error();
  Result<std::string> build = map->finish();
  if (!build) return build.error();
  report.build = *build;
  report.frames = progress.frames_done;
  return report;
}

}  // namespace milepost
