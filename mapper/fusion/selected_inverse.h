// The elements of a sparse matrix's inverse where its factor has elements.
#pragma once

#include <vector>

#include <Eigen/SparseCholesky>

namespace milepost {

using SparseFactor = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

// By the recursion of K. Takahashi, J. Fagan, M. Chin, "Formation of a sparse bus impedance matrix
// and its application to short circuit study", 1973: with A = L D L' and Z the inverse of A, each
// element of Z where L has one depends only on others where L has one.
class SelectedInverse {
 public:
  // REQUIRES: the factorization succeeded.
  explicit SelectedInverse(const SparseFactor& factor);

  // An element, of indices as in the matrix that was factored. REQUIRES: the matrix has an element
  // there.
  double operator()(Eigen::Index i, Eigen::Index j) const;

 private:
  double element(Eigen::Index i, Eigen::Index j) const;

  Eigen::VectorXi permuted_;           // position of each variable in the factor
  Eigen::SparseMatrix<double> lower_;  // below the diagonal, with L's pattern
  std::vector<double> diagonal_;
};

}  // namespace milepost
