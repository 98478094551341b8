// The whole-image SURF descriptor: Badino, Huber and Kanade 2012 (the tracklet paper's [5]),
// computed as Bay et al. 2008 ([10]) describe a feature, with the whole image as its neighbourhood.
#pragma once

#include <opencv2/core/mat.hpp>

#include "schema/feature/types.h"

namespace milepost {

// Upright (U-SURF), as cameras of vehicles are. SURF describes a feature of scale s in a square of
// 20 s by 20 x 20 samples of Haar wavelets of side 2 s; here the image of w x h pixels is the
// square, so s is w / 20 along x and h / 20 along y:
//   sample (i, j), i and j from 0 to 19, lies at x = (i + 1/2) w / 20, y = (j + 1/2) h / 20 pixels
//   from the image's top left corner; its wavelet covers [x - w / 20, x + w / 20] by
//   [y - h / 20, y + h / 20], cut at the image's edges; bounds are rounded to whole pixels.
//   dx is the mean grey value of the wavelet's right half minus that of its left half, dy that of
//   the lower half minus that of the upper one. SURF's Gaussian weight about the feature is left
//   out: an image has no feature in its middle (schema/DECISIONS.md 13).
//   4 x 4 cells of 5 x 5 samples, row by row, give sum dx, sum dy, sum |dx| and sum |dy| each.
// The 64 values are scaled to length 1; for a uniform image all are 0.
// REQUIRES: `gray` is 8-bit with one channel, not empty.
ImageDescriptor wisurf(const cv::Mat& gray);

}  // namespace milepost
