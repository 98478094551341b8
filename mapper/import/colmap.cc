#include <algorithm>
#include <map>
#include <set>

#include "mapper/geodata/coordinate_transform.h"
#include "mapper/import/colmap_model.h"
#include "mapper/import/image_times.h"
#include "mapper/import/layouts.h"
#include "mapper/import/local_poses.h"
#include "schema/geo/camera_pose.h"

namespace milepost {
namespace {

// The camera that all images are of, or the one that is asked for.
Result<std::uint32_t> camera_of_drive(const ColmapModel& model, const ImportOptions& options) {
  std::set<std::uint32_t> used;
  for (const ColmapImage& image : model.images) used.insert(image.camera);
  if (options.camera_number) {
    if (used.contains(*options.camera_number)) return *options.camera_number;
  } else if (used.size() == 1) {
    return *used.begin();
  }
  std::string all;
  for (const std::uint32_t id : used) all += (all.empty() ? "" : ", ") + std::to_string(id);
  return Error{ErrorCode::invalid_input, options.folder.string(),
               "its images are of the cameras " + all,
               "name one with --camera-number: a drive has one camera"};
}

// Places in the model's frame: geocentric with --crs, or a tangent frame at --origin.
class ModelFrame {
 public:
  static Result<ModelFrame> of(const ImportOptions& options) {
    if (options.crs.empty()) {
      const auto frame = frame_of_origin(options);
      if (!frame) {
        return Error{ErrorCode::invalid_input, "--origin", "is required",
                     "give the origin of a model that is aligned to east, north and up (its "
                     "model_aligner does that), or --crs EPSG:4978 for a geocentric one"};
      }
      return ModelFrame(*frame);
    }
    auto transform = CoordinateTransform::from(options.crs);
    if (!transform) return transform.error();
    if (!transform->is_geocentric()) {
      return Error{ErrorCode::invalid_input, "--crs", "a model's frame is no projection",
                   "give a geocentric one, as EPSG:4978, or --origin"};
    }
    return ModelFrame(std::move(*transform));
  }

  Result<GeoAttitude> attitude(const Eigen::Isometry3d& world_from_camera) const {
    if (local_) return attitude_of(world_from_camera, *local_);
    const Eigen::Vector3d at_m = world_from_camera.translation();
    const auto position = geocentric_->geographic_of(at_m.x(), at_m.y(), at_m.z());
    if (!position) return position.error();
    const LocalFrame there(*position);
    Eigen::Isometry3d enu_from_camera = Eigen::Isometry3d::Identity();
    enu_from_camera.linear() = enu_from_geocentric(*position) * world_from_camera.linear();
    return attitude_of(enu_from_camera, there);
  }

  std::string datum() const { return geocentric_ ? geocentric_->datum() : ""; }

 private:
  explicit ModelFrame(const LocalFrame& local) : local_(local) {}
  explicit ModelFrame(CoordinateTransform geocentric) : geocentric_(std::move(geocentric)) {}

  // The rotation from geocentric axes to east, north and up.
  static Eigen::Matrix3d enu_from_geocentric(const GeoPoint& at) {
    const double latitude = at.latitude_deg * kRadPerDeg;
    const double longitude = at.longitude_deg * kRadPerDeg;
    Eigen::Matrix3d rotation;
    rotation << -std::sin(longitude), std::cos(longitude), 0,  //
        -std::sin(latitude) * std::cos(longitude), -std::sin(latitude) * std::sin(longitude),
        std::cos(latitude),  //
        std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
        std::sin(latitude);
    return rotation;
  }

  std::optional<LocalFrame> local_;
  std::optional<CoordinateTransform> geocentric_;
};

}  // namespace

// A model's camera poses: times are those of the images.
Result<Recording> read_colmap(const ImportOptions& options) {
  const auto model = read_colmap_model(options.folder);
  if (!model) return model.error();
  const auto frame = ModelFrame::of(options);
  if (!frame) return frame.error();
  const auto camera = camera_of_drive(*model, options);
  if (!camera) return camera.error();
  const auto known = model->cameras.find(*camera);
  if (known == model->cameras.end()) {
    return Error{ErrorCode::invalid_input, options.folder.string(),
                 "has images of camera " + std::to_string(*camera) + ", but not that camera",
                 "export the model of COLMAP again"};
  }
  const auto timed = timed_images(options.images, options.times, options.rate_hz);
  if (!timed) return timed.error();
  std::map<std::string, const RecordedImage*> by_name;
  for (const RecordedImage& image : *timed) by_name[image.file.filename().string()] = &image;
  Recording recording;
  recording.has_tilts = true;
  recording.are_cameras = true;
  recording.camera = known->second;
  recording.datum.name = frame->datum();
  for (const ColmapImage& image : model->images) {
    if (image.camera != *camera) continue;
    const auto at = by_name.find(std::filesystem::path(image.name).filename().string());
    if (at == by_name.end()) {
      return Error{ErrorCode::not_found, options.images.string(),
                   "there is no image '" + image.name + "', which the model has",
                   "name the folder of the images, and their times with --times"};
    }
    const auto attitude = frame->attitude(image.world_from_camera);
    if (!attitude) return attitude.error();
    recording.poses.push_back({at->second->timestamp_s, *attitude});
    recording.images.push_back(*at->second);
  }
  return recording;
}

}  // namespace milepost
