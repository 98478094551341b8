#include "mapper/fusion/selected_inverse.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace milepost {

SelectedInverse::SelectedInverse(const SparseFactor& factor)
    : permuted_(factor.permutationP().indices()),
      lower_(factor.matrixL().nestedExpression()),
      diagonal_(static_cast<std::size_t>(factor.rows())) {
  lower_.makeCompressed();
  const Eigen::VectorXd factor_d = factor.vectorD();
  struct Below {
    Eigen::Index row = 0;
    double l = 0;
    double sum = 0;  // of l times the inverse's element there
  };
  std::vector<std::ptrdiff_t> place(static_cast<std::size_t>(factor.rows()), -1);
  using Column = Eigen::SparseMatrix<double>::InnerIterator;
  for (Eigen::Index j = lower_.cols() - 1; j >= 0; --j) {
    std::vector<Below> below;
    for (Column element(lower_, j); element; ++element) {
      if (element.row() <= j) continue;
      place[static_cast<std::size_t>(element.row())] = std::ssize(below);
      below.push_back({element.row(), element.value(), 0});
    }
    for (Below& k : below) {
      k.sum += k.l * diagonal_[static_cast<std::size_t>(k.row)];
      for (Column element(lower_, k.row); element; ++element) {  // of the inverse by now
        const std::ptrdiff_t at = place[static_cast<std::size_t>(element.row())];
        if (element.row() <= k.row || at < 0) continue;
        Below& i = below[static_cast<std::size_t>(at)];
        i.sum += k.l * element.value();
        k.sum += i.l * element.value();
      }
    }
    double diagonal = 1 / factor_d[j];
    for (Column element(lower_, j); element; ++element) {
      if (element.row() <= j) continue;
      const Below& i =
          below[static_cast<std::size_t>(place[static_cast<std::size_t>(element.row())])];
      element.valueRef() = -i.sum;
      diagonal += i.l * i.sum;
    }
    for (const Below& i : below) place[static_cast<std::size_t>(i.row)] = -1;
    diagonal_[static_cast<std::size_t>(j)] = diagonal;
  }
}

double SelectedInverse::operator()(Eigen::Index i, Eigen::Index j) const {
  return element(permuted_[i], permuted_[j]);
}

double SelectedInverse::element(Eigen::Index i, Eigen::Index j) const {
  if (i == j) return diagonal_[static_cast<std::size_t>(i)];
  return lower_.coeff(std::max(i, j), std::min(i, j));
}

}  // namespace milepost
