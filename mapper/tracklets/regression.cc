#include "mapper/tracklets/regression.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace milepost {
namespace {

struct LineFit {
  Eigen::Vector2d theta;  // Eq. 2
  double ss_res = 0;      // Eq. 12
  double ss_tot = 0;      // Eq. 13
};

// Ordinary least squares of l on [1 f(s)], Eq. 2, solved about the means so that arc lengths of
// many kilometres do not lose digits.
LineFit fit_line(const Eigen::VectorXd& f, const Eigen::VectorXd& l) {
  const double f_mean = f.mean();
  const double l_mean = l.mean();
  const Eigen::VectorXd f_centred = f.array() - f_mean;
  const Eigen::VectorXd l_centred = l.array() - l_mean;
  LineFit fit;
  const double slope = f_centred.dot(l_centred) / f_centred.squaredNorm();
  fit.theta = {l_mean - slope * f_mean, slope};
  fit.ss_res = (l_centred - slope * f_centred).squaredNorm();
  fit.ss_tot = l_centred.squaredNorm();
  return fit;
}

}  // namespace

std::optional<Tracklet> tracklet_from_track(const Track& track,
                                            const RegressionSettings& settings) {
  const auto count = static_cast<Eigen::Index>(track.size());
  Eigen::VectorXd f(count);
  Eigen::VectorXd l(count);
  for (Eigen::Index m = 0; m < count; ++m) {
    f[m] = scale_variable(settings.model, track[m].feature.scale_px);
    l[m] = track[m].along_m;
  }
  const LineFit fit = fit_line(f, l);
  const double r_squared = 1 - fit.ss_res / fit.ss_tot;  // Eq. 14
  const bool usable = r_squared >= settings.min_r_squared && fit.theta[1] > 0;
  if (!usable) return std::nullopt;  // NaN, of a track without motion or growth, is unusable too

  Tracklet tracklet;
  tracklet.offset_m = fit.theta[0];
  tracklet.slope = fit.theta[1];
  tracklet.r_squared = static_cast<float>(std::min(r_squared, 1.0));
  tracklet.residual_sigma_m =
      static_cast<float>(std::sqrt(fit.ss_res / static_cast<double>(count - 2)));
  set_from_track(track, tracklet);
  return tracklet;
}

}  // namespace milepost
