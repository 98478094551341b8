#include "mapper/import/import_drive.h"

#include <algorithm>
#include <set>
#include <system_error>

#include <opencv2/imgcodecs.hpp>

#include "mapper/import/image_times.h"
#include "mapper/import/trajectory.h"
#include "schema/base/digits.h"
#include "schema/base/file.h"
#include "schema/drive/image_decode.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;

constexpr const char* kImages = "frames";

Status check_new(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error) || fs::is_empty(folder, error)) return ok_status();
  return Error{ErrorCode::invalid_input, folder.string(), "is not empty",
               "name a new folder for the drive"};
}

// Names that a drive's table can hold; of images in several folders, numbers.
std::vector<std::string> frame_names(const std::vector<RecordedImage>& images) {
  std::vector<std::string> names;
  std::set<std::string> known;
  bool are_plain = true;
  for (const RecordedImage& image : images) {
    names.push_back(image.file.filename().string());
    are_plain = are_plain && known.insert(names.back()).second &&
                names.back().find_first_of(",;\t\"") == std::string::npos;
  }
  if (are_plain) return names;
  for (std::size_t i = 0; i < images.size(); ++i) {
    std::string number = std::to_string(i);
    number.insert(0, 6 - std::min<std::size_t>(6, number.size()), '0');
    names[i] = number + images[i].file.extension().string();
  }
  return names;
}

Status place_image(const fs::path& from, const fs::path& to, bool copy) {
  std::error_code error;
  if (copy) {
    fs::copy_file(from, to, error);
  } else {
    const fs::path absolute = fs::canonical(from, error);
    if (!error) fs::create_symlink(absolute, to, error);
  }
  if (!error) return ok_status();
  return Error{ErrorCode::io, from.string(), "cannot be taken over (" + error.message() + ")",
               "check the image and the drive's folder"};
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

// The position of the trajectory, with its angles or those of the orientations. Nothing where
// either has none.
std::optional<GeoAttitude> pose_at(double timestamp_s, const Trajectory& trajectory,
                                   const std::optional<Trajectory>& orientations) {
  const auto pose = trajectory.at(timestamp_s);
  if (!pose || !orientations) return pose;
  auto oriented = orientations->at(timestamp_s);
  if (oriented) oriented->position = pose->position;
  return oriented;
}

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

// Writes the drive with its images, and reads it back.
Result<Drive> write_with_images(const Drive& drive, const std::vector<RecordedImage>& images,
                                ImageContainer* container, const DriveSettings& settings) {
  std::error_code error;
  fs::create_directories(settings.folder / kImages, error);
  if (error) {
    return Error{ErrorCode::io, settings.folder.string(),
                 "cannot be created (" + error.message() + ")",
                 "check the path and the permissions"};
  }
  for (std::size_t i = 0; i < images.size(); ++i) {
    const fs::path frame = settings.folder / kImages / drive.frames[i].filename;
    const Status placed = container == nullptr
                              ? place_image(images[i].file, frame, settings.copy_images)
                              : container->write(images[i], frame);
    if (!placed) return placed.error();
  }
  if (const Status written = write_drive(drive, settings.folder); !written) return written.error();
  return read_drive(settings.folder);
}

}  // namespace

Result<ImportReport> import_drive(Recording recording, const DriveSettings& settings) {
  if (const Status is_new = check_new(settings.folder); !is_new) return is_new.error();
  const auto no_poses = [](std::size_t count) {
    return Error{ErrorCode::invalid_input, "the trajectory",
                 "has " + std::to_string(count) + " poses, not two or more", "name another file"};
  };
  for (auto* const poses : {&recording.poses, &recording.orientations})
    for (RecordedPose& pose : *poses) pose.timestamp_s += settings.day_s;
  if (recording.poses.size() < 2) return no_poses(recording.poses.size());
  Trajectory trajectory(std::move(recording.poses), settings.max_gap_s);
  if (trajectory.poses().size() < 2) return no_poses(trajectory.poses().size());
  if (!recording.has_headings) trajectory.set_headings_by_motion();
  std::optional<Trajectory> orientations;
  if (!recording.orientations.empty())
    orientations.emplace(std::move(recording.orientations), settings.max_gap_s);
  if (settings.spread_seconds) spread_whole_seconds(recording.images);
  for (RecordedImage& image : recording.images) image.timestamp_s += settings.time_offset_s;
  std::ranges::stable_sort(recording.images, {}, &RecordedImage::timestamp_s);

  ImportReport report;
  std::vector<RecordedImage> kept;
  Drive drive;
  if (recording.images.empty()) {
    return Error{ErrorCode::invalid_input, "the recording", "has no images", "name their folder"};
  }
  const auto camera = camera_of(recording, settings);
  if (!camera) return camera.error();
  drive.camera = *camera;
  for (const RecordedImage& image : recording.images) {
    const auto vehicle = pose_at(image.timestamp_s, trajectory, orientations);
    if (!vehicle) continue;
    const GeoAttitude at = camera_of_vehicle(*vehicle, drive.camera.mounting);
    drive.frames.push_back(
        {"", image.timestamp_s, at.position, at.heading_deg, at.pitch_deg, at.roll_deg});
    kept.push_back(image);
  }
  if (kept.empty()) {
    return Error{ErrorCode::invalid_input, "the trajectory",
                 "lasts from " + fixed(trajectory.begin_s(), 3) + " to " +
                     fixed(trajectory.end_s(), 3) + " s, the images from " +
                     fixed(recording.images.front().timestamp_s, 3) + " to " +
                     fixed(recording.images.back().timestamp_s, 3) + " s: no image has a pose",
                 "give the offset of their clocks with --time-offset-s"};
  }
  const std::vector<std::string> names = frame_names(kept);
  for (std::size_t i = 0; i < kept.size(); ++i) drive.frames[i].filename = names[i];
  if (kept.size() < recording.images.size()) {
    report.notes.push_back(std::to_string(recording.images.size() - kept.size()) + " of " +
                           std::to_string(recording.images.size()) +
                           " images have no pose and are left out");
  }
  for (const TrajectoryGap& gap : trajectory.gaps()) report.notes.push_back(note_of(gap));

  drive.name = settings.name;
  drive.position_frame = PositionFrame::geographic;
  drive.images = kImages;
  drive.source = settings.source;
  drive.has_tilts = recording.has_tilts;
  std::optional<double> sigma_m = settings.receiver_sigma_m;
  if (!sigma_m && recording.is_receivers) sigma_m = 5;
  if (sigma_m) drive.gps = receiver_of(trajectory, *sigma_m);

  Result<Drive> written = write_with_images(drive, kept, recording.container.get(), settings);
  if (!written) {
    std::error_code ignored;  // nothing half done is left
    for (const fs::path& entry : {fs::path(kImages), fs::path("drive.json"),
                                  fs::path("trajectory.csv"), fs::path("gps.csv")})
      fs::remove_all(settings.folder / entry, ignored);
    return written.error();
  }
  report.drive = std::move(*written);
  return report;
}

}  // namespace milepost
