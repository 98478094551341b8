// What an import reads from another program's recording, before it becomes a drive.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mapper/geodata/trajectory.h"
#include "schema/base/result.h"
#include "schema/geo/camera.h"
#include "schema/geo/datum.h"
#include "schema/geo/mounting.h"

namespace milepost {

struct RecordedImage {
  std::filesystem::path file;  // of an image in a container: its name, without a folder
  double timestamp_s = 0;
  std::size_t entry = 0;  // of an image in a container: which
};

// A file that holds the images: a video, a bag.
class ImageContainer {
 public:
  ImageContainer() = default;
  ImageContainer(const ImageContainer&) = delete;
  ImageContainer& operator=(const ImageContainer&) = delete;
  virtual ~ImageContainer() = default;

  // Writes one image as a file of its own. Entries are asked for in the order of the images' times.
  // Errors: io, corrupt.
  virtual Status write(const RecordedImage& image, const std::filesystem::path& file) = 0;
};

struct Recording {
  std::vector<RecordedPose> poses;  // in any order, at their own rate
  // Angles at another rate than the positions', likewise; empty: the poses have them.
  std::vector<RecordedPose> orientations;
  bool has_headings = true;  // false: to be told by the motion
  bool has_tilts = false;    // pitch and roll are recorded
  bool are_cameras = false;  // the poses are the camera's, whatever its mounting
  std::vector<RecordedImage> images;
  std::shared_ptr<ImageContainer> container;  // null: each image is a file
  // With the mounting, if the layout tells them; without a size: that of the images' files.
  std::optional<Camera> camera;
  bool is_receivers = false;  // the poses are a navigation receiver's
  Datum datum;                // if the layout tells it
};

// What the user tells of a recording; each layout reads a part of it.
struct ImportOptions {
  std::filesystem::path folder;                // of a layout that has one
  std::optional<std::uint32_t> camera_number;  // of several
  std::filesystem::path images;                // folder, or a video
  std::filesystem::path times;                 // of the images
  double rate_hz = 0;                // of images without times, or at most of a video; 0: not given
  std::filesystem::path trajectory;  // file
  std::filesystem::path calibration;  // file
  std::string crs;                    // of coordinates that are not WGS84 degrees
  std::vector<std::string> columns;   // csv: what=NAME
  std::vector<std::string> topics;    // of a bag: what=NAME
  bool has_camera = false;            // the user tells the camera: the recording's is not used
  std::optional<GeoPoint> origin;     // of a local frame
  double origin_heading_deg = 0;      // of its forward axis
};

}  // namespace milepost
