#include <cmath>

#include <Eigen/Dense>

#include "schema/feature/pca_projection.h"
#include "schema/feature/root_sift.h"

namespace milepost {
namespace {

// Of RootSIFT, which has length 1: a smaller variance is rounding error.
constexpr double kLeastVariance = 1e-9;

using Vector = Eigen::Matrix<double, kDescriptorBytes, 1>;
using Matrix = Eigen::Matrix<double, kDescriptorBytes, kDescriptorBytes>;

Vector root_sift_vector(const Descriptor& descriptor) {
  const RootSift root = root_sift(descriptor);
  return Eigen::Map<const Eigen::Matrix<std::int16_t, kDescriptorBytes, 1>>(root.data())
             .cast<double>() /
         kRootSiftUnits;
}

Vector mean_of(std::span<const Descriptor> descriptors) {
  Vector sum = Vector::Zero();
  for (const Descriptor& descriptor : descriptors) sum += root_sift_vector(descriptor);
  return sum / std::max<double>(1, static_cast<double>(descriptors.size()));
}

Matrix covariance_of(std::span<const Descriptor> descriptors, const Vector& mean) {
  Matrix sum = Matrix::Zero();
  for (const Descriptor& descriptor : descriptors) {
    const Vector centred = root_sift_vector(descriptor) - mean;
    sum.noalias() += centred * centred.transpose();
  }
  return sum / std::max<double>(1, static_cast<double>(descriptors.size()));
}

// Fixes the sign of an eigenvector: its component of largest magnitude becomes positive.
Vector with_sign(const Vector& axis) {
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis(largest) < 0 ? Vector(-axis) : axis;
}

}  // namespace

PcaProjection PcaProjection::trained(std::span<const Descriptor> descriptors,
                                     double quantization_step, std::string version) {
  const Vector mean = mean_of(descriptors);
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(covariance_of(descriptors, mean));
  PcaProjection projection;
  projection.version_ = std::move(version);
  projection.quantization_step_ = quantization_step;
  for (int d = 0; d < kDescriptorBytes; ++d) {
    projection.mean_[static_cast<std::size_t>(d)] =
        static_cast<std::uint8_t>(std::lround(mean(d) * 255));
  }
  for (int k = 0; k < kCompactValues; ++k) {
    const Eigen::Index column = kDescriptorBytes - 1 - k;  // eigenvalues ascend
    if (solver.eigenvalues()(column) < kLeastVariance) break;
    const Vector axis = with_sign(solver.eigenvectors().col(column));
    for (int d = 0; d < kDescriptorBytes; ++d) {
      projection.axes_[static_cast<std::size_t>(d)][static_cast<std::size_t>(k)] =
          static_cast<std::int8_t>(std::lround(axis(d) * 127));
    }
  }
  return projection;
}

}  // namespace milepost
