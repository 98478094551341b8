#include "mapper/import/ros/camera_of_info.h"

#include <algorithm>
#include <string>

namespace milepost::ros {
namespace {

Result<LensModel> lens_model_of(const CameraInfo& info) {
  const std::string_view name = info.distortion_model;
  if (name == "plumb_bob" || name == "rational_polynomial") return LensModel::brown_conrady;
  if (name == "equidistant" || name == "fisheye") return LensModel::kannala_brandt;
  return Error{
      ErrorCode::invalid_input, "",
      "has the distortion model '" + std::string(name.substr(0, 40)) + "', which is not known",
      "name a file with the camera by --camera"};
}

Result<Lens> lens_of(const CameraInfo& info) {
  std::vector<double> coefficients = info.distortion;
  while (!coefficients.empty() && coefficients.back() == 0) coefficients.pop_back();
  // Without distortion, whatever the model. An equidistant lens without coefficients is a fisheye.
  const bool is_pinhole = coefficients.empty() && info.distortion_model != "equidistant" &&
                          info.distortion_model != "fisheye";
  if (is_pinhole) return Lens();
  const Result<LensModel> model = lens_model_of(info);
  if (!model) return model.error();
  return Lens::make(*model, coefficients);
}

// A coordinate of the full image, in pixels from the centre of its first one, in the image of a
// part of it whose pixels are `binning` ones.
double in_part(double full_px, std::uint32_t begin_px, double binning) {
  return (full_px - begin_px + 0.5) / binning - 0.5;
}

}  // namespace

Result<std::optional<Camera>> camera_of(const CameraInfo& info, bool is_rectified) {
  const auto& k = info.intrinsics;
  const auto& p = info.projection;
  const Pinhole full =
      is_rectified ? Pinhole{p[0], p[5], p[2], p[6]} : Pinhole{k[0], k[4], k[2], k[5]};
  if (!(full.focal_x_px > 0 && full.focal_y_px > 0)) return std::optional<Camera>();
  const std::uint32_t binning_x = std::max(1U, info.binning_x);
  const std::uint32_t binning_y = std::max(1U, info.binning_y);
  const std::uint32_t width_px =
      (info.roi_width_px == 0 ? info.width_px : info.roi_width_px) / binning_x;
  const std::uint32_t height_px =
      (info.roi_height_px == 0 ? info.height_px : info.roi_height_px) / binning_y;
  if (width_px == 0 || height_px == 0 || std::max(width_px, height_px) > kMaxSidePx) {
    return Error{ErrorCode::invalid_input, "",
                 "has " + std::to_string(width_px) + " x " + std::to_string(height_px) + " pixels",
                 "name a file with the camera by --camera"};
  }
  Camera camera;
  camera.width_px = static_cast<int>(width_px);
  camera.height_px = static_cast<int>(height_px);
  camera.pinhole = {full.focal_x_px / binning_x, full.focal_y_px / binning_y,
                    in_part(full.principal_x_px, info.roi_x_px, binning_x),
                    in_part(full.principal_y_px, info.roi_y_px, binning_y)};
  if (is_rectified) return std::optional(camera);
  const Result<Lens> lens = lens_of(info);
  if (!lens) return lens.error();
  camera.lens = *lens;
  return std::optional(camera);
}

}  // namespace milepost::ros
