// How the image of a lens differs from that of a pinhole: the models of Brown-Conrady (Brown 1971)
// and Kannala-Brandt (2006), as OpenCV defines their coefficients (FORMAT.md 1.9).
//
// Points lie in the plane at distance 1 in front of the camera, x to the right and y down: where a
// pinhole would see them, and where the lens shows them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "schema/base/result.h"

namespace milepost {

enum class LensModel {
  pinhole,
  brown_conrady,  // k1 k2 p1 p2 k3 k4 k5 k6: radial and tangential, rational from k4 on
  kannala_brandt  // k1 k2 k3 k4: by the angle from the optical axis
};

const char* name_of(LensModel model);
std::optional<LensModel> lens_model_named(std::string_view name);
// The coefficients' names in their order.
const std::vector<std::string>& coefficient_names(LensModel model);

class Lens {
 public:
  Lens() = default;  // a pinhole

  // `coefficients` in the order of their names; those that are left out are 0. Errors:
  // invalid_input: too many, one is not finite, or the image of such a lens folds near its centre.
  static Result<Lens> make(LensModel model, const std::vector<double>& coefficients);

  LensModel model() const { return model_; }
  std::vector<double> coefficients() const;  // all of the model's
  bool is_pinhole() const { return model_ == LensModel::pinhole; }

  // Where the lens shows what a pinhole sees at `seen`; nothing beyond its field of view, which
  // ends where its image would fold, at the latest 75 degrees from the optical axis.
  std::optional<Eigen::Vector2d> distorted(const Eigen::Vector2d& seen) const;

  struct Undistorted {
    Eigen::Vector2d seen;
    double magnification = 1;  // of lengths, from the lens's image to the pinhole's, mean of axes
  };
  // The inverse; nothing beyond the field of view.
  std::optional<Undistorted> undistorted(const Eigen::Vector2d& shown) const;

  friend bool operator==(const Lens&, const Lens&) = default;

 private:
  using Coefficients = std::array<double, 8>;
  Lens(LensModel model, const Coefficients& coefficients);
  template <class Scalar>
  Eigen::Matrix<Scalar, 2, 1> show(const Eigen::Matrix<Scalar, 2, 1>& seen) const;
  double shown_radius(double seen_radius) const;
  double seen_radius(double shown_radius) const;

  LensModel model_ = LensModel::pinhole;
  Coefficients coefficients_{};  // 0 beyond the model's
  double widest_ = 0;            // seen radius at which the field of view ends
};

}  // namespace milepost
