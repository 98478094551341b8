// Closed-form triangulation of a point from rays.
#pragma once

#include <optional>

#include <Eigen/Cholesky>

namespace milepost {

struct RayIntersection {
  Eigen::Vector3d point_m;
  Eigen::Matrix3d information;  // the inverse covariance if weights are inverse variances
};

// Accumulates rays for the point with the least weighted sum of squared distances from them.
class RayTriangulation {
 public:
  // REQUIRES: `direction` is a unit vector; weight > 0.
  void add(const Eigen::Vector3d& from_m, const Eigen::Vector3d& direction, double weight = 1) {
    const Eigen::Matrix3d across =
        (Eigen::Matrix3d::Identity() - direction * direction.transpose()) * weight;
    information_ += across;
    sum_ += across * from_m;
  }

  // Nothing if the rays are parallel.
  std::optional<RayIntersection> point() const {
    constexpr double kParallel = 1e-12;
    const Eigen::LDLT<Eigen::Matrix3d> solver(information_);
    if (solver.info() != Eigen::Success || solver.vectorD().minCoeff() < kParallel) {
      return std::nullopt;
    }
    return RayIntersection{solver.solve(sum_), information_};
  }

 private:
  Eigen::Matrix3d information_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
};

}  // namespace milepost
