// A picture of each stage of a block, to inspect the processing.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "mapper/aerial/orthoimage.h"
#include "mapper/aerial/wall_line.h"

namespace milepost {

// Writes PNG files named FOLDER/BLOCK-NAME.png, or nothing if the folder is empty. Write errors are
// ignored. Safe from several threads for different blocks.
class StagePictures {
 public:
  StagePictures(std::filesystem::path folder, std::string block)
      : folder_(std::move(folder)), block_(std::move(block)) {}

  void show(const std::string& name, const cv::Mat& picture) const;
  // Edge maps, the strictest first; its edges are drawn the brightest.
  void show_maps(const std::string& name, const std::vector<cv::Mat>& maps) const;
  // The picture with the first mask in blue and the second in red.
  void show_masks(const std::string& name, const cv::Mat& bgr, const cv::Mat& blue,
                  const cv::Mat& red) const;
  // Lines on the picture; the side of the building is hatched.
  void show_lines(const std::string& name, const Picture& picture, const WallLines& lines) const;
  void show_regions(const std::string& name, const cv::Mat& labels) const;  // CV_32SC1
  void show_share(const std::string& name, const cv::Mat& share) const;     // CV_32FC1, 0 to 1

 private:
  std::filesystem::path folder_;
  std::string block_;
};

}  // namespace milepost
