#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "schema/drive/drive.h"
#include "schema/drive/frame_image.h"

namespace milepost {
namespace fs = std::filesystem;
namespace {

std::vector<fs::path> shared_drives() {
  const fs::path parent = fs::path(MILEPOST_SHARED_DIR) / "drives";
  std::vector<fs::path> folders;
  if (!fs::exists(parent)) return folders;
  for (const auto& entry : fs::directory_iterator(parent)) {
    if (entry.is_directory()) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

TEST(SharedDrives, AreReadWithTheirFirstAndLastFrame) {
  const std::vector<fs::path> folders = shared_drives();
  if (folders.empty()) GTEST_SKIP() << "there are no recorded drives in " MILEPOST_SHARED_DIR;
  for (const fs::path& folder : folders) {
    SCOPED_TRACE(folder.string());
    const Result<Drive> drive = read_drive(folder);
    if (!drive) {
      ADD_FAILURE() << drive.error().line();
      continue;
    }
    EXPECT_EQ(drive->name, folder.filename().string());
    EXPECT_EQ(drive->gps.empty(), !fs::exists(folder / "gps.csv"));
    EXPECT_EQ(drive->odometry.empty(), !fs::exists(folder / "odometry.csv"));
    for (const std::size_t index : {std::size_t{0}, drive->frames.size() - 1}) {
      const Result<cv::Mat> image = FrameReader(*drive).gray(index);
      EXPECT_TRUE(image.ok()) << image.error().line();
    }
  }
}

}  // namespace
}  // namespace milepost
