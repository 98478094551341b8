#include "mapper/pipeline/build_map.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>

#include <nlohmann/json.hpp>

#include "mapper/acceptance/check_point_survey.h"
#include "mapper/codebook/codebook.h"
#include "mapper/findings/clock_witness.h"
#include "mapper/findings/datum_findings.h"
#include "mapper/findings/witness_findings.h"
#include "mapper/inspect/inspection.h"
#include "mapper/pipeline/build_plan.h"
#include "mapper/pipeline/frame_pipeline.h"
#include "mapper/pipeline/fused_tiles.h"
#include "mapper/pipeline/landmark_survey.h"
#include "mapper/pipeline/layer_builder.h"
#include "mapper/pipeline/layers.h"
#include "mapper/pipeline/mapping_log.h"
#include "schema/base/digits.h"

namespace milepost {
namespace {

using OnProgress = std::function<bool(const BuildProgress&)>;
using AdjustedUse =
    std::function<void(const Frame& recorded, const AdjustedFrame&, const WitnessedPlace&)>;

struct NamedBuilder {
  std::string layer;
  std::unique_ptr<LayerBuilder> builder;
};

// Surveys the landmarks of a stretch from its frames, and builds the tiles of the layers of --lab.
class StretchBuilder {
 public:
  StretchBuilder(const Drive& drive, const StretchPlan& stretch, const BuildPlan& plan,
                 const PcaProjection& projection, const BuildSettings& settings,
                 LandmarkStore& store)
      : drive_(drive),
        plan_(stretch),
        settings_(settings),
        context_{drive.camera, stretch.segments, projection, settings.tile_length_m},
        tracker_(settings.follow, drive.camera.width_px),
        survey_(drive.camera, stretch, plan, settings, store) {
    for (const Layer& layer : layers_of(settings)) {
      if (layer.items == LayerItems::landmarks) continue;
      layers_.push_back({layer.name, make_layer_builder(layer, context_)});
    }
  }

  // Adds its counts to the last of the report's drives.
  Status run(int jobs, DividedMap& map, BuildReport& report, const AdjustedUse& use_adjusted,
             BuildProgress& progress, const OnProgress& on_progress) {
    FramePipeline frames(drive_, plan_.frame_indices, settings_.feature, settings_.lab, jobs);
    for (std::size_t i = 0; i < plan_.frame_indices.size(); ++i) {
      const double along_m = plan_.line.along_m()[i];
      const Frame& recorded = drive_.frames[plan_.frame_indices[i]];
      const Result<ExtractedFrame> frame = frames.next();
      if (!frame) return frame.error();
      count(*frame, report.drives.back());
      survey_.add_frame(recorded, along_m);
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
    const Status written =
        add_and_write(tracker_.finish(), std::numeric_limits<double>::infinity(), map, report);
    for (const AdjustedFrame& frame : survey_.take_adjusted()) {
      const auto vertex = std::ranges::lower_bound(plan_.line.along_m(), frame.along_m);
      const auto index = static_cast<std::size_t>(vertex - plan_.line.along_m().begin());
      use_adjusted(drive_.frames[plan_.frame_indices[index]], frame, survey_.place_of(frame));
    }
    return written;
  }

 private:
  static void count(const ExtractedFrame& frame, DriveReport& found) {
    ++found.frames;
    found.features += frame.features.descriptors.size();
    found.darkest = std::min(found.darkest, frame.darkest);
    found.brightest = std::max(found.brightest, frame.brightest);
  }

  Status add_and_write(const std::vector<Track>& ended, double complete_until_m, DividedMap& map,
                       BuildReport& report) {
    survey_.add_tracks(ended);
    const Result<std::size_t> landmarks = survey_.store(std::isinf(complete_until_m));
    if (!landmarks) return landmarks.error();
    report.drives.back().tracklets += *landmarks;
    for (const NamedBuilder& layer : layers_) {
      layer.builder->add_tracks(ended);
      const Result<std::vector<BuiltTile>> tiles = layer.builder->take_complete(complete_until_m);
      if (!tiles) return tiles.error();
      for (const BuiltTile& tile : *tiles) {
        const Status added = map.add_tile(layer.layer, tile);
        if (!added.ok()) return added;
      }
    }
    return ok_status();
  }

  const Drive& drive_;
  const StretchPlan& plan_;
  const BuildSettings& settings_;
  StretchContext context_;
  FeatureTracker tracker_;
  LandmarkSurvey survey_;
  std::vector<NamedBuilder> layers_;
};

// The layers of the laboratory hold pixels and scales of one camera; landmarks are metres.
Status check_cameras_agree(const std::vector<DrivePlan>& drives) {
  constexpr double kSameFocal = 1e-3;
  const Drive& first = *drives.front().drive;
  const auto differ = [](double a_px, double b_px) {
    return std::abs(a_px - b_px) > kSameFocal * b_px;
  };
  for (const DrivePlan& plan : drives) {
    const Camera& camera = plan.drive->camera;
    const bool is_same = camera.width_px == first.camera.width_px &&
                         camera.height_px == first.camera.height_px &&
                         !differ(camera.pinhole.focal_x_px, first.camera.pinhole.focal_x_px) &&
                         !differ(camera.pinhole.focal_y_px, first.camera.pinhole.focal_y_px);
    if (is_same) continue;
    return Error{ErrorCode::invalid_input, (plan.drive->folder / "drive.json").string(),
                 "its camera differs from that of " + (first.folder / "drive.json").string() +
                     ", and the layers of --lab are of one camera",
                 "leave out --lab, or build a map for each camera"};
  }
  return ok_status();
}

Status check_fit(const DriveReport& drive, const BuildSettings& settings) {
  const double share = drive.witness.fitting_share();
  if (share >= settings.min_fitting_share) return ok_status();
  return Error{ErrorCode::invalid_input, drive.folder,
               "only " + fixed(100 * share, 0) +
                   " % of the features that were followed fit its poses, fewer than "
                   "min-fitting-share: " +
                   fixed(100 * settings.min_fitting_share, 0) + " %",
               "check its camera and poses, leave the drive out, or lower min-fitting-share"};
}

std::vector<const Drive*> drives_of(const BuildPlan& plan) {
  std::vector<const Drive*> drives;
  drives.reserve(plan.drives.size());
  for (const DrivePlan& drive : plan.drives) drives.push_back(drive.drive);
  return drives;
}

std::vector<CheckPointResidual> residuals_of(const CheckPointSurvey& survey, const BuildPlan& plan,
                                             const SlowErrors& errors) {
  std::vector<const RouteLine*> lines;
  for (const DrivePlan& drive : plan.drives) {
    for (const StretchPlan& stretch : drive.stretches) lines.push_back(&stretch.line);
  }
  return survey.residuals(
      drives_of(plan),
      [&](std::size_t stretch, double along_m) { return errors.error(stretch, along_m); },
      [&](std::size_t stretch) -> const RouteLine& { return *lines[stretch]; });
}

Status check_residuals(const std::vector<CheckPointResidual>& residuals,
                       const std::optional<double>& max_m, const std::filesystem::path& map_file) {
  const CheckPointSummary summary = summary_of(residuals);
  if (!max_m || (summary.placed > 0 && summary.plan_rms_m <= *max_m)) return ok_status();
  return Error{ErrorCode::invalid_input, map_file.string(),
               summary.placed == 0 ? std::string("none of the check points could be placed")
                                   : "check points are off by " + fixed(summary.plan_rms_m, 3) +
                                         " m in plan (root mean square), more than max-check-m: " +
                                         fixed(*max_m, 3) + " m; the worst is " + summary.worst,
               "check the marks, the drives' positions and their datum"};
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

namespace {

// One run over all drives, in the order of its functions.
class MapBuild {
 public:
  // REQUIRES: all outlive it.
  MapBuild(const std::vector<Drive>& drives, const BuildSettings& settings,
           const BuildChecks& checks)
      : drives_(drives),
        settings_(settings),
        checks_(checks),
        codebook_(settings.codebook ? *settings.codebook : shipped_codebook()),
        survey_(checks.check_points) {}

  Status prepare(const std::filesystem::path& map_file, int jobs) {
    const Result<Datum> datum = common_datum(drives_);
    if (!datum) return datum.error();
    Result<BuildPlan> plan = plan_build(drives_, settings_, jobs);
    if (!plan) return plan.error();
    plan_ = std::move(*plan);
    if (settings_.lab) {
      if (const Status checked = check_cameras_agree(plan_.drives); !checked.ok()) return checked;
    }
    Result<DividedMap> map = DividedMap::create(plan_, map_file, settings_.division);
    if (!map) return map.error();
    map_.emplace(std::move(*map));
    Result<LandmarkStore> store = LandmarkStore::create();
    if (!store) return store.error();
    store_.emplace(std::move(*store));
    report_.findings = plan_.findings;
    Status status = map_->set_feature_json(to_json(settings_.feature).dump());
    if (status.ok()) status = map_->set_datum(*datum);
    const Camera& camera = plan_.drives.front().drive->camera;
    for (const Layer& layer : layers_of(settings_)) {
      if (!status.ok()) break;
      const auto parameters = parameters_of(layer, camera, codebook_, settings_.tile_length_m);
      status = map_->add_layer(layer.name, to_json(parameters).dump());
    }
    return status;
  }

  // Maps the landmarks of each drive.
  Status survey(int jobs, const OnProgress& on_progress) {
    BuildProgress progress;
    std::size_t stretch_number = 0;
    for (const DrivePlan& drive : plan_.drives) progress.frames_total += drive.frames();
    for (const DrivePlan& drive : plan_.drives) {
      report_.drives.push_back({.folder = drive.drive->folder.string()});
      std::vector<WitnessedHeading>& headings = headings_[drive.drive->name];
      const AdjustedUse use_adjusted = [&](const Frame& recorded, const AdjustedFrame& adjusted,
                                           const WitnessedPlace& place) {
        log_.add(*drive.drive, place);
        survey_.add(*drive.drive, recorded.filename, stretch_number, adjusted);
        headings.push_back({{recorded.timestamp_s, {recorded.position, recorded.heading_deg}},
                            adjusted.heading_rad * kDegPerRad});
      };
      for (const StretchPlan& stretch : drive.stretches) {
        const Status done =
            StretchBuilder(*drive.drive, stretch, plan_, codebook_, settings_, *store_)
                .run(jobs, *map_, report_, use_adjusted, progress, on_progress);
        if (!done.ok()) return done;
        ++stretch_number;
      }
      DriveReport& report = report_.drives.back();
      report.witness = log_.of_drive(drive.drive->name);
      const bool is_mapped = !drive.stretches.empty();
      if (is_mapped && report.tracklets == 0 && !settings_.allow_empty)
        return nothing_found(report);
    }
    report_.frames = progress.frames_done;
    return ok_status();
  }

  // By how much the poses of a drive are late, as its images tell.
  std::optional<double> poses_late_s(const Drive& drive) const {
    const auto headings = headings_.find(drive.name);
    return headings == headings_.end() ? std::nullopt : clock_offset_s(headings->second);
  }

  // A copy of another drive is not.
  bool is_mapped(const Drive& drive) const { return headings_.contains(drive.name); }
  const std::vector<Finding>& findings() const { return report_.findings; }

  // Makes one map of all drives' landmarks.
  Status fuse(const std::filesystem::path& map_file) {
    for (const DriveReport& drive : report_.drives) {
      if (const Status fits = check_fit(drive, settings_); !fits.ok()) return fits;
    }
    const auto fused = build_fused_tiles(
        plan_, *store_, codebook_, settings_,
        [&](const BuiltTile& tile) { return map_->add_tile(layers::kLandmarks, tile); });
    if (!fused) return fused.error();
    report_.check_points = residuals_of(survey_, plan_, fused->errors);
    const Status set = map_->set_position_errors(plan_, fused->left);
    return set.ok() ? check_residuals(report_.check_points, checks_.max_check_m, map_file) : set;
  }

  // Writes down what was found, also before, and publishes the map.
  Result<BuildReport> publish(const std::vector<Finding>& found) {
    add_findings(found);
    for (const DriveReport& drive : report_.drives)
      add_findings(witness_findings(drive.folder, drive.witness));
    const std::vector<const Drive*> mapped = drives_of(plan_);
    log_.add(checks_.found_before, mapped);
    log_.add(report_.findings, mapped);
    log_.set_check_points(report_.check_points);
    if (const Status set = map_->set_mapping(plan_, log_); !set.ok()) return set.error();
    Result<std::vector<MapReport>> maps = map_->finish();
    if (!maps) return maps.error();
    report_.maps = std::move(*maps);
    for (MapReport& written : report_.maps) {
      const Result<MapReader> reader = MapReader::open(written.file);
      if (!reader) return reader.error();
      const Result<MapInspection> inspected = inspect(*reader);
      if (!inspected) return inspected.error();
      written.sparse_m = inspected->gaps_m();
    }
    return std::move(report_);
  }

 private:
  void add_findings(const std::vector<Finding>& found) {
    report_.findings.insert(report_.findings.end(), found.begin(), found.end());
  }

  const std::vector<Drive>& drives_;
  const BuildSettings& settings_;
  const BuildChecks& checks_;
  const PcaProjection& codebook_;
  BuildPlan plan_;
  std::optional<DividedMap> map_;
  std::optional<LandmarkStore> store_;
  BuildReport report_;
  MappingLog log_;
  CheckPointSurvey survey_;
  std::map<std::string, std::vector<WitnessedHeading>> headings_;  // by the drive's name
};

Finding late_poses(const Drive& drive, double late_s) {
  return {"clock_offset",
          (drive.folder / "trajectory.csv").string(),
          0,
          drive.frames.size(),
          "the recorded poses are " + fixed(std::abs(late_s), 2) + " s " +
              (late_s > 0 ? "ahead of" : "behind") + " the images, which turn so much " +
              (late_s > 0 ? "later" : "earlier") +
              "; the map is made of poses that were moved by it",
          "correct the clock: import with --time-offset-s " + fixed(-late_s, 2)};
}

}  // namespace

Result<BuildReport> build_map(const std::vector<Drive>& drives,
                              const std::filesystem::path& map_file, const BuildSettings& settings,
                              int jobs, const OnProgress& on_progress, const BuildChecks& checks) {
  const auto surveyed = [&](MapBuild& build) {
    const Status prepared = build.prepare(map_file, jobs);
    return prepared.ok() ? build.survey(jobs, on_progress) : prepared;
  };
  const auto published = [&](MapBuild& build,
                             const std::vector<Finding>& found) -> Result<BuildReport> {
    if (const Status fused = build.fuse(map_file); !fused.ok()) return fused.error();
    return build.publish(found);
  };
  std::vector<Drive> on_time;
  std::vector<Finding> found;
  {
    MapBuild build(drives, settings, checks);
    if (const Status status = surveyed(build); !status.ok()) return status.error();
    for (const Drive& drive : drives) {
      if (!build.is_mapped(drive)) continue;  // moved, the other would be no copy of it any more
      const auto late_s = build.poses_late_s(drive);
      if (late_s) found.push_back(late_poses(drive, *late_s));
      on_time.push_back(late_s ? with_poses_of(drive, *late_s) : drive);
    }
    if (found.empty()) return published(build, found);
    std::ranges::copy_if(build.findings(), std::back_inserter(found),
                         [](const Finding& finding) { return finding.kind == "copied_drive"; });
  }
  // Once more, with each image at the pose of its time.
  MapBuild again(on_time, settings, checks);
  if (const Status status = surveyed(again); !status.ok()) return status.error();
  return published(again, found);
}

}  // namespace milepost
