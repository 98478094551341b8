#include "mapper/fusion/selected_inverse.h"

#include <gtest/gtest.h>

#include <random>

#include <Eigen/Dense>

namespace milepost {
namespace {

// A positive definite matrix whose graph is a ring with some chords, so that its factor fills in.
Eigen::SparseMatrix<double> ring_with_chords(int size) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(-1, 1);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
  const auto connect = [&](int i, int j) { dense(i, j) = dense(j, i) = value(random); };
  for (int i = 0; i < size; ++i) connect(i, (i + 1) % size);
  for (int i = 0; i < size; i += 5) connect(i, (i + size / 2) % size);
  dense.diagonal().setConstant(6);
  return dense.sparseView();
}

TEST(SelectedInverse, HasTheInversesElementsWhereTheMatrixHasAny) {
  const Eigen::SparseMatrix<double> matrix = ring_with_chords(40);
  const Eigen::MatrixXd inverse = Eigen::MatrixXd(matrix).inverse();
  const SelectedInverse selected{SparseFactor(matrix)};
  int compared = 0;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      if (matrix.coeff(i, j) == 0) continue;
      EXPECT_NEAR(selected(i, j), inverse(i, j), 1e-12) << i << ' ' << j;
      ++compared;
    }
  }
  EXPECT_GT(compared, 120);
}

}  // namespace
}  // namespace milepost
