#include "tests/schema/drive/drive_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "schema/drive/drive.h"

namespace milepost {
namespace fs = std::filesystem;
namespace {

constexpr const char* kDriveJson = R"({
  "name": "north",
  "camera": {"width_px": 16, "height_px": 12, "focal_px": [20.5, 21.5], "principal_px": [8, 6.25]},
  "frame": "local",
  "origin": {"latitude_deg": 49.0, "longitude_deg": 8.4, "altitude_m": 110},
  "images": "frames",
  "captured": "2011-09-30",
  "licence": "free",
  "source": "a test",
  "weather": "fair"
}
)";

constexpr const char* kTrajectory =
    "filename,timestamp_s,east_m,north_m,up_m,heading_deg,note\n"
    "a.png,10.0,0,0,1.5,-0.5,start\n"
    "b.png,10.2,0,2,1.5,0,\n"
    "c.png,10.4,0,4,1.5,360,\n"
    "d.png,10.6,0,6,1.5,725,end\n";

}  // namespace

DriveFolder::DriveFolder() {
  fs::create_directory(folder_ / "frames");
  cv::Mat image(12, 16, CV_8UC3);
  for (const char* name : {"a.png", "b.png", "c.png", "d.png"}) {
    cv::randu(image, 0, 255);
    cv::imwrite(file(std::string("frames/") + name), image);
  }
  write("drive.json", kDriveJson);
  write("trajectory.csv", kTrajectory);
}

void DriveFolder::write(const std::string& name, const std::string& content) const {
  std::ofstream(folder_ / name, std::ios::binary) << content;
}

std::string DriveFolder::read(const std::string& name) const {
  std::ostringstream content;
  content << std::ifstream(folder_ / name, std::ios::binary).rdbuf();
  return content.str();
}

void DriveFolder::replace(const std::string& name, const std::string& old_text,
                          const std::string& new_text) const {
  std::string content = read(name);
  const std::size_t at = content.find(old_text);
  ASSERT_NE(at, std::string::npos) << old_text;
  ASSERT_EQ(content.find(old_text, at + 1), std::string::npos) << old_text;
  write(name, content.replace(at, old_text.size(), new_text));
}

void DriveFolder::replace_line(const std::string& name, std::size_t line,
                               const std::string& text) const {
  std::istringstream rows(read(name));
  std::string content;
  std::size_t number = 0;
  for (std::string row; std::getline(rows, row);) content += (++number == line ? text : row) + "\n";
  ASSERT_GE(number, line);
  write(name, content);
}

std::string refusal(const DriveFolder& folder) {
  const Result<Drive> drive = read_drive(folder.path());
  if (drive) return "accepted";
  EXPECT_THAT(drive.error().line(), ::testing::Not(::testing::HasSubstr("\n")));
  EXPECT_FALSE(drive.error().hint.empty());
  return drive.error().line();
}

}  // namespace milepost
