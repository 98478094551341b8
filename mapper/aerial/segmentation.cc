#include "mapper/aerial/segmentation.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace milepost {
namespace {

struct Edge {
  float weight;
  int a;
  int b;
};

// A disjoint-set forest of pixels.
class Forest {
 public:
  Forest(int count, float threshold)
      : parents_(count), sizes_(count, 1), thresholds_(count, threshold) {
    std::iota(parents_.begin(), parents_.end(), 0);
  }

  int root_of(int pixel) {
    while (parents_[pixel] != pixel) {
      parents_[pixel] = parents_[parents_[pixel]];
      pixel = parents_[pixel];
    }
    return pixel;
  }
  int size_of(int root) const { return sizes_[root]; }
  float threshold_of(int root) const { return thresholds_[root]; }

  void join(int a, int b, float threshold) {
    if (sizes_[a] < sizes_[b]) std::swap(a, b);
    parents_[b] = a;
    sizes_[a] += sizes_[b];
    thresholds_[a] = threshold;
  }

 private:
  std::vector<int> parents_;
  std::vector<int> sizes_;
  std::vector<float> thresholds_;  // the paper's internal difference plus k / size
};

// The edges of each pixel to its neighbours to the right and below, the closest colours first.
std::vector<Edge> edges_of(const cv::Mat& lab, const cv::Mat& kinds) {
  const std::array<cv::Point, 4> steps = {cv::Point(1, 0), {0, 1}, {1, 1}, {-1, 1}};
  std::vector<Edge> edges;
  edges.reserve(steps.size() * lab.total());
  for (int y = 0; y < lab.rows; ++y) {
    for (int x = 0; x < lab.cols; ++x) {
      for (const cv::Point& step : steps) {
        const cv::Point to(x + step.x, y + step.y);
        if (!to.inside({0, 0, lab.cols, lab.rows})) continue;
        if (kinds.at<std::uint8_t>(y, x) != kinds.at<std::uint8_t>(to)) continue;
        const auto weight =
            static_cast<float>(cv::norm(lab.at<cv::Vec3f>(y, x) - lab.at<cv::Vec3f>(to)));
        edges.push_back({weight, y * lab.cols + x, to.y * lab.cols + to.x});
      }
    }
  }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const Edge& a, const Edge& b) { return a.weight < b.weight; });
  return edges;
}

}  // namespace

Segmentation segmented(const cv::Mat& lab, const cv::Mat& kinds, double metres_per_pixel,
                       const SegmentationSettings& settings) {
  const auto scale = static_cast<float>(settings.scale);
  const double min_pixels = settings.min_region_m2 / (metres_per_pixel * metres_per_pixel);
  const std::vector<Edge> edges = edges_of(lab, kinds);
  Forest forest(static_cast<int>(lab.total()), scale);
  for (const Edge& edge : edges) {
    const int a = forest.root_of(edge.a);
    const int b = forest.root_of(edge.b);
    if (a == b || edge.weight > std::min(forest.threshold_of(a), forest.threshold_of(b))) continue;
    const auto size = static_cast<float>(forest.size_of(a) + forest.size_of(b));
    forest.join(a, b, edge.weight + scale / size);
  }
  for (const Edge& edge : edges) {
    const int a = forest.root_of(edge.a);
    const int b = forest.root_of(edge.b);
    if (a == b || std::min(forest.size_of(a), forest.size_of(b)) >= min_pixels) continue;
    forest.join(a, b, forest.threshold_of(a));
  }
  Segmentation segmentation;
  segmentation.labels.create(lab.size(), CV_32SC1);
  std::vector<int> labels(lab.total(), -1);
  for (int y = 0; y < lab.rows; ++y) {
    for (int x = 0; x < lab.cols; ++x) {
      int& label = labels[forest.root_of(y * lab.cols + x)];
      if (label < 0) label = segmentation.count++;
      segmentation.labels.at<int>(y, x) = label;
    }
  }
  return segmentation;
}

}  // namespace milepost
