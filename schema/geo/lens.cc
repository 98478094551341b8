#include "schema/geo/lens.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <unsupported/Eigen/AutoDiff>

namespace milepost {
namespace {

constexpr double kWidestRadius = 3.73;    // tangent of 75 degrees
constexpr double kNarrowestRadius = 0.1;  // a field of view below this is a mistake
constexpr double kStep = 0.005;           // of the search for the field of view's end
// The image may not be compressed by more than this: its features would be nowhere exact.
constexpr double kLeastGrowth = 0.02;

// The angle from the optical axis, divided by the radius.
template <class Scalar>
Scalar angle_by_radius(const Scalar& radius2) {
  using std::atan2;
  using std::sqrt;
  constexpr double kSmall2 = 1e-8;
  if (radius2 < kSmall2) return Scalar(1) - radius2 / 3;
  const Scalar radius = sqrt(radius2);
  return atan2(radius, Scalar(1)) / radius;
}

}  // namespace

const char* name_of(LensModel model) {
  switch (model) {
    case LensModel::brown_conrady:
      return "brown-conrady";
    case LensModel::kannala_brandt:
      return "kannala-brandt";
    case LensModel::pinhole:
      break;
  }
  return "pinhole";
}

std::optional<LensModel> lens_model_named(std::string_view name) {
  for (const LensModel model :
       {LensModel::pinhole, LensModel::brown_conrady, LensModel::kannala_brandt}) {
    if (name == name_of(model)) return model;
  }
  return std::nullopt;
}

const std::vector<std::string>& coefficient_names(LensModel model) {
  static const std::vector<std::string> kNone;
  static const std::vector<std::string> kBrownConrady = {"k1", "k2", "p1", "p2",
                                                         "k3", "k4", "k5", "k6"};
  static const std::vector<std::string> kKannalaBrandt = {"k1", "k2", "k3", "k4"};
  switch (model) {
    case LensModel::brown_conrady:
      return kBrownConrady;
    case LensModel::kannala_brandt:
      return kKannalaBrandt;
    case LensModel::pinhole:
      break;
  }
  return kNone;
}

Lens::Lens(LensModel model, const Coefficients& coefficients)
    : model_(model), coefficients_(coefficients) {
  for (int step = 1; step * kStep <= kWidestRadius; ++step) {
    const double next = step * kStep;
    const double growth = (shown_radius(next) - shown_radius(widest_)) / (next - widest_);
    if (!(growth >= kLeastGrowth)) break;
    widest_ = next;
  }
}

Result<Lens> Lens::make(LensModel model, const std::vector<double>& coefficients) {
  const auto wrong = [&](const std::string& what, const std::string& hint) {
    return Error{ErrorCode::invalid_input, std::string("lens ") + name_of(model), what, hint};
  };
  const std::size_t most = coefficient_names(model).size();
  if (coefficients.size() > most) {
    return wrong("it has " + std::to_string(coefficients.size()) + " coefficients",
                 "give at most " + std::to_string(most) + ", in OpenCV's order");
  }
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    if (!std::isfinite(coefficients[i])) {
      return wrong(coefficient_names(model)[i] + " is not finite", "calibrate the camera");
    }
  }
  if (model == LensModel::pinhole) return Lens();
  Coefficients all{};
  std::ranges::copy(coefficients, all.begin());
  const Lens lens(model, all);
  if (lens.widest_ < kNarrowestRadius) {
    return wrong("its image folds within 6 degrees of the optical axis",
                 "check the coefficients, their order and the model");
  }
  return lens;
}

std::vector<double> Lens::coefficients() const {
  const auto count = static_cast<std::ptrdiff_t>(coefficient_names(model_).size());
  return {coefficients_.begin(), coefficients_.begin() + count};
}

template <class Scalar>
Eigen::Matrix<Scalar, 2, 1> Lens::show(const Eigen::Matrix<Scalar, 2, 1>& seen) const {
  const Coefficients& k = coefficients_;
  const Scalar& x = seen.x();
  const Scalar& y = seen.y();
  const Scalar r2 = x * x + y * y;
  if (model_ == LensModel::kannala_brandt) {
    const Scalar by_radius = angle_by_radius(r2);
    const Scalar t2 = by_radius * by_radius * r2;  // the square of the angle
    const Scalar factor =
        by_radius * (1 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * Scalar(k[3])))));
    return {x * factor, y * factor};
  }
  const Scalar radial = (1 + r2 * (k[0] + r2 * (k[1] + r2 * Scalar(k[4])))) /
                        (1 + r2 * (k[5] + r2 * (k[6] + r2 * Scalar(k[7]))));
  return {x * radial + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x),
          y * radial + k[2] * (r2 + 2 * y * y) + 2 * k[3] * x * y};
}

// Without the tangential part.
double Lens::shown_radius(double seen_radius) const {
  const Coefficients& k = coefficients_;
  if (model_ == LensModel::kannala_brandt) return show(Eigen::Vector2d(seen_radius, 0)).x();
  const double r2 = seen_radius * seen_radius;
  return seen_radius * (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) /
         (1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
}

// By bisection, within the field of view.
double Lens::seen_radius(double shown) const {
  double low = 0;
  double high = widest_;
  for (int i = 0; i < 50; ++i) {
    const double middle = (low + high) / 2;
    (shown_radius(middle) < shown ? low : high) = middle;
  }
  return (low + high) / 2;
}

std::optional<Eigen::Vector2d> Lens::distorted(const Eigen::Vector2d& seen) const {
  if (is_pinhole()) return seen;
  if (!(seen.norm() <= widest_)) return std::nullopt;
  return show(seen);
}

std::optional<Lens::Undistorted> Lens::undistorted(const Eigen::Vector2d& shown) const {
  if (is_pinhole()) return Undistorted{shown};
  const double radius = shown.norm();
  if (!std::isfinite(radius)) return std::nullopt;
  constexpr double kConverged = 1e-10;
  constexpr int kMaxIterations = 20;
  using Derived = Eigen::AutoDiffScalar<Eigen::Vector2d>;
  Eigen::Vector2d seen = radius > 0 ? shown * (seen_radius(radius) / radius) : shown;
  for (int i = 0; i < kMaxIterations; ++i) {
    const Eigen::Matrix<Derived, 2, 1> at = {Derived(seen.x(), 2, 0), Derived(seen.y(), 2, 1)};
    const Eigen::Matrix<Derived, 2, 1> image = show(at);
    Eigen::Matrix2d shown_by_seen;
    shown_by_seen << image.x().derivatives().transpose(), image.y().derivatives().transpose();
    const Eigen::Vector2d off = shown - Eigen::Vector2d(image.x().value(), image.y().value());
    const double area = shown_by_seen.determinant();
    if (!(area > kLeastGrowth * kLeastGrowth)) return std::nullopt;
    if (off.norm() < kConverged) {
      if (seen.norm() > widest_) return std::nullopt;
      return Undistorted{seen, 1 / std::sqrt(area)};
    }
    seen += shown_by_seen.inverse() * off;
  }
  return std::nullopt;
}

}  // namespace milepost
