#include "mapper/import/import_drive.h"

#include <algorithm>
#include <system_error>

#include <opencv2/imgcodecs.hpp>

#include "mapper/geodata/datum_transform.h"
#include "mapper/geodata/trajectory.h"
#include "mapper/import/clock_offset.h"
#include "mapper/import/drive_images.h"
#include "mapper/import/image_times.h"
#include "schema/base/digits.h"
#include "schema/base/file.h"
#include "schema/drive/image_decode.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;

constexpr const char* kImages = "frames";
constexpr const char* kExtracted =
    "frames.partial";  // of a container, while its clock is estimated

Status check_new(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error) || fs::is_empty(folder, error)) return ok_status();
  return Error{ErrorCode::invalid_input, folder.string(), "is not empty",
               "name a new folder for the drive"};
}

// The recording's camera, of the images' size.
Result<Camera> camera_of(const Recording& recording, const DriveSettings& settings) {
  std::optional<Camera> camera = settings.camera ? settings.camera : recording.camera;
  if (!camera) {
    return Error{ErrorCode::invalid_input, "--camera", "is required: this layout has no camera",
                 "name a file with the key camera, as drive.json has it"};
  }
  if (settings.mounting) camera->mounting = *settings.mounting;
  if (camera->width_px > 0) return *camera;
  const fs::path& first = recording.images.front().file;
  Result<std::string> bytes = read_text_file(first);
  if (!bytes) return bytes.error();
  const auto image = decoded_image(std::move(*bytes), cv::IMREAD_GRAYSCALE);
  if (!image) {
    return Error{image.error().code, first.string(), image.error().what, image.error().hint};
  }
  camera->width_px = image->cols;
  camera->height_px = image->rows;
  return *camera;
}

// Where the vehicle was, and how it was turned, which may be recorded apart.
struct Way {
  Trajectory positions;
  std::optional<Trajectory> orientations;

  const Trajectory& headings() const { return orientations ? *orientations : positions; }
  // Nothing where either has none.
  std::optional<GeoAttitude> at(double timestamp_s) const {
    const auto pose = positions.at(timestamp_s);
    if (!pose || !orientations) return pose;
    auto oriented = orientations->at(timestamp_s);
    if (oriented) oriented->position = pose->position;
    return oriented;
  }
};

std::string note_of(const TrajectoryGap& gap) {
  return "no pose between " + fixed(gap.from_s, 3) + " and " + fixed(gap.to_s, 3) + " s, " +
         fixed(gap.to_s - gap.from_s, 1) + " s long";
}

std::vector<GpsFix> receiver_of(const Trajectory& trajectory, double sigma_m) {
  std::vector<GpsFix> fixes;
  for (const RecordedPose& pose : trajectory.poses()) {
    if (!fixes.empty() && pose.timestamp_s < fixes.back().timestamp_s + 1) continue;
    GeoPoint position = pose.attitude.position;
    position.altitude_m = 0;
    fixes.push_back({pose.timestamp_s, position, sigma_m});
  }
  return fixes;
}

// Moves the poses to the datum that is asked for, and returns theirs. Errors: invalid_input.
Result<Datum> to_asked_datum(Recording& recording, const DriveSettings& settings) {
  const Datum& datum = settings.datum.is_stated() ? settings.datum : recording.datum;
  const Datum& asked = settings.to_datum;
  if (!asked.is_stated() || (datum.name == asked.name && agree(datum, asked)))
    return asked.is_stated() ? asked : datum;
  if (!datum.is_stated()) {
    return Error{ErrorCode::invalid_input, "--to-datum",
                 "needs the datum of the recording, which this layout does not tell",
                 "name it with --datum"};
  }
  const auto transform = DatumTransform::between(datum, asked);
  if (!transform) return transform.error();
  for (RecordedPose& pose : recording.poses) {
    const auto moved = transform->transformed(pose.attitude.position);
    if (!moved) return moved.error();
    pose.attitude.position = *moved;
  }
  return asked;
}

Status check_not_empty(const Recording& recording) {
  if (recording.images.empty()) {
    return Error{ErrorCode::invalid_input, "the recording", "has no images", "name their folder"};
  }
  return ok_status();
}

Result<Way> way_of(Recording& recording, const DriveSettings& settings) {
  for (auto* const poses : {&recording.poses, &recording.orientations}) {
    for (RecordedPose& pose : *poses) pose.timestamp_s += settings.day_s;
  }
  const std::size_t recorded = recording.poses.size();
  if (recorded > 0) {
    Way way{Trajectory(std::move(recording.poses), settings.max_gap_s), {}};
    if (!recording.has_headings) way.positions.set_headings_by_motion();
    if (!recording.orientations.empty())
      way.orientations.emplace(std::move(recording.orientations), settings.max_gap_s);
    if (way.positions.poses().size() > 1) return way;
  }
  return Error{
      ErrorCode::invalid_input, "the trajectory",
      "has " + std::to_string(std::min<std::size_t>(recorded, 1)) + " poses, not two or more",
      "name another file"};
}

// Moves the images' times to the trajectory's clock. Errors: those of estimate_clock_offset and
// extract_images.
Status correct_clock(Recording& recording, const Way& way, const Camera& camera,
                     const DriveSettings& settings, std::vector<std::string>& notes) {
  if (settings.spread_seconds) spread_whole_seconds(recording.images);
  const auto move_by = [&](double offset_s) {
    for (RecordedImage& image : recording.images) image.timestamp_s += offset_s;
  };
  move_by(settings.time_offset_s);
  std::ranges::stable_sort(recording.images, {}, &RecordedImage::timestamp_s);
  if (!settings.estimate_offset_s) return ok_status();
  if (recording.container != nullptr) {
    const Status extracted = extract_images(recording, settings.folder / kExtracted);
    if (!extracted) return extracted;
  }
  const auto found = estimate_clock_offset(recording.images, way.positions, way.headings(), camera,
                                           *settings.estimate_offset_s);
  if (!found) return found.error();
  move_by(found->offset_s);
  notes.push_back("the images' times are moved by " + fixed(found->offset_s, 2) +
                  " s more, by which they go with the " +
                  (found->by_turns ? "turns" : "stops and starts") + " of the trajectory (to " +
                  fixed(found->correlation, 2) + ")");
  return ok_status();
}

// The images that have a pose, and the drive of their frames. Errors: invalid_input: none has.
struct PosedImages {
  Drive drive;
  std::vector<RecordedImage> images;
};
Result<PosedImages> posed_images(const Recording& recording, const Way& way, const Camera& camera) {
  PosedImages posed;
  posed.drive.camera = camera;
  for (const RecordedImage& image : recording.images) {
    const auto there = way.at(image.timestamp_s);
    if (!there) continue;
    const GeoAttitude at =
        recording.are_cameras ? *there : camera_of_vehicle(*there, camera.mounting);
    posed.drive.frames.push_back(
        {"", image.timestamp_s, at.position, at.heading_deg, at.pitch_deg, at.roll_deg});
    posed.images.push_back(image);
  }
  if (!posed.images.empty()) return posed;
  return Error{ErrorCode::invalid_input, "the trajectory",
               "lasts from " + fixed(way.positions.begin_s(), 3) + " to " +
                   fixed(way.positions.end_s(), 3) + " s, the images from " +
                   fixed(recording.images.front().timestamp_s, 3) + " to " +
                   fixed(recording.images.back().timestamp_s, 3) + " s: no image has a pose",
               "give the offset of their clocks with --time-offset-s"};
}

// Writes the drive with its images, and reads it back.
Result<Drive> write_with_images(const PosedImages& posed, const Recording& recording,
                                const DriveSettings& settings) {
  std::vector<std::string> names;
  names.reserve(posed.images.size());
  for (const Frame& frame : posed.drive.frames) names.push_back(frame.filename);
  const bool are_extracted = fs::exists(settings.folder / kExtracted);
  const PlaceImages how = are_extracted          ? PlaceImages::move
                          : settings.copy_images ? PlaceImages::copy
                                                 : PlaceImages::refer;
  const Status placed =
      place_images(posed.images, names, recording.container.get(), how, settings.folder / kImages);
  if (!placed) return placed.error();
  const Status written = write_drive(posed.drive, settings.folder);
  if (!written) return written.error();
  return read_drive(settings.folder);
}

Result<ImportReport> import_into(Recording& recording, const DriveSettings& settings) {
  const Result<Datum> datum = to_asked_datum(recording, settings);
  if (!datum) return datum.error();
  const auto way = way_of(recording, settings);
  if (!way) return way.error();
  if (const Status there = check_not_empty(recording); !there) return there.error();
  const auto camera = camera_of(recording, settings);
  if (!camera) return camera.error();
  ImportReport report;
  const Status corrected = correct_clock(recording, *way, *camera, settings, report.notes);
  if (!corrected) return corrected.error();
  auto posed = posed_images(recording, *way, *camera);
  if (!posed) return posed.error();
  const std::vector<std::string> names = frame_names(posed->images);
  for (std::size_t i = 0; i < names.size(); ++i) posed->drive.frames[i].filename = names[i];
  if (names.size() < recording.images.size()) {
    report.notes.push_back(std::to_string(recording.images.size() - names.size()) + " of " +
                           std::to_string(recording.images.size()) +
                           " images have no pose and are left out");
  }
  for (const TrajectoryGap& gap : way->positions.gaps()) report.notes.push_back(note_of(gap));

  Drive& drive = posed->drive;
  drive.name = settings.name;
  drive.position_frame = PositionFrame::geographic;
  drive.datum = *datum;
  drive.images = kImages;
  drive.source = settings.source;
  drive.has_tilts = recording.has_tilts;
  std::optional<double> sigma_m = settings.receiver_sigma_m;
  if (!sigma_m && recording.is_receivers) sigma_m = 5;
  if (sigma_m) drive.gps = receiver_of(way->positions, *sigma_m);
  Result<Drive> written = write_with_images(*posed, recording, settings);
  if (!written) return written.error();
  report.drive = std::move(*written);
  return report;
}

}  // namespace

Result<ImportReport> import_drive(Recording recording, const DriveSettings& settings) {
  if (const Status is_new = check_new(settings.folder); !is_new) return is_new.error();
  Result<ImportReport> report = import_into(recording, settings);
  std::error_code ignored;
  fs::remove_all(settings.folder / kExtracted, ignored);
  if (report) return report;
  for (const char* entry : {kImages, "drive.json", "trajectory.csv", "gps.csv"})
    fs::remove_all(settings.folder / entry, ignored);  // nothing half done is left
  return report;
}

}  // namespace milepost
