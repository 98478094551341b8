#include "client/evaluate/tum.h"

#include <Eigen/Geometry>

#include "schema/base/digits.h"
#include "schema/geo/camera_pose.h"
#include "schema/geo/mounting.h"

namespace milepost {
namespace {

constexpr const char* kHeader = "# timestamp tx ty tz qx qy qz qw\n";

class TumText {
 public:
  explicit TumText(const Drive& drive)
      : frame_(drive.origin.value_or(drive.frames.front().position)) {}

  void add(double timestamp_s, const GeoAttitude& camera) {
    const EnuPoint at = frame_.enu_from_geo(camera.position);
    const CameraPose pose = {{at.east_m, at.north_m, at.up_m},
                             camera.heading_deg * kRadPerDeg,
                             camera.pitch_deg * kRadPerDeg,
                             camera.roll_deg * kRadPerDeg};
    const Eigen::Quaterniond q(enu_from_camera(pose).linear());
    text_ += fixed(timestamp_s, 6);
    for (const double metres : {at.east_m, at.north_m, at.up_m}) text_ += ' ' + fixed(metres, 4);
    for (const double part : {q.x(), q.y(), q.z(), q.w()}) text_ += ' ' + fixed(part, 9);
    text_ += '\n';
  }
  std::string text() const { return text_; }

 private:
  LocalFrame frame_;
  std::string text_ = kHeader;
};

bool begins_tum(std::string_view head) { return head.starts_with(kHeader); }

}  // namespace

const OutputKind kTumOutput = {"a trajectory in TUM's form", begins_tum, true};

std::string tum_text(const std::vector<FrameFix>& fixes, const Drive& drive) {
  TumText tum(drive);
  for (const FrameFix& frame : fixes) {
    if (const auto& camera = frame.fix.camera) {
      tum.add(frame.fix.timestamp_s,
              {camera->position, camera->heading_deg, camera->pitch_deg, camera->roll_deg});
    }
  }
  return tum.text();
}

std::string tum_truth_text(const Drive& drive) {
  TumText tum(drive);
  for (const Frame& frame : drive.frames) {
    tum.add(frame.timestamp_s,
            {frame.position, frame.heading_deg, frame.pitch_deg, frame.roll_deg});
  }
  return tum.text();
}

std::filesystem::path tum_truth_file(const std::filesystem::path& file) {
  return file.parent_path() / (file.stem().string() + "-truth" + file.extension().string());
}

}  // namespace milepost
