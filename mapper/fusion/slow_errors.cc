#include "mapper/fusion/slow_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <span>

#include <Eigen/Dense>

#include "mapper/fusion/selected_inverse.h"

namespace milepost {
namespace {

constexpr int kAxes = kErrorAxes;

// Axes that share their variances: those of the position, and roll.
struct Kind {
  int first = 0;
  int axes = 0;
};
constexpr std::array<Kind, 2> kKinds = {{{0, kRollAxis}, {kRollAxis, 1}}};
using ByKind = Eigen::Vector2d;

// The diagonal of a matrix of all axes.
ErrorVector on_axes(const ByKind& of_kind) {
  return {of_kind[0], of_kind[0], of_kind[0], of_kind[1]};
}

// Estimated variances of one drive's errors on each axis.
struct Variances {
  ByKind bias = ByKind::Zero();
  ByKind drift = ByKind::Zero();
};

// A linear function of one or more nodes, each with all axes.
struct Term {
  Eigen::Index node = 0;
  double factor = 0;
};

double robust_weight(double squared_sigmas, double scale) {
  // Of a Student's t of this many degrees of freedom, at residuals divided by `scale` (graduated
  // non-convexity: from a large scale, at which all ties count alike, to 1).
  constexpr double kDegrees = 4;
  return (kDegrees + kAxes) / (kDegrees + squared_sigmas / (scale * scale));
}

// The drives that ties connect, directly or over others.
class Component {
 public:
  Component(const std::vector<DrivenStretch>& stretches, const std::vector<std::size_t>& members,
            std::vector<Tie> ties, const SlowErrorSettings& settings)
      : settings_(settings), ties_(std::move(ties)) {
    for (const std::size_t stretch : members) {
      const std::size_t drive = stretches[stretch].drive;
      const auto [known, is_new] = bias_node_.try_emplace(drive, next_);
      if (is_new) ++next_;
      const auto count = static_cast<Eigen::Index>(
                             std::ceil(stretches[stretch].length_m / settings.node_spacing_m)) +
                         1;
      chains_[stretch] = {drive, next_, count};
      next_ += count;
    }
    for (const auto& [drive, node] : bias_node_) {
      variances_[drive] = {
          ByKind(settings.bias_sigma_m, settings.bias_roll_sigma_rad).cwiseAbs2(),
          ByKind(settings.drift_sigma_m, settings.drift_roll_sigma_rad).cwiseAbs2()};
    }
  }

  void solve(std::vector<std::vector<SlowErrors::Node>>& nodes) {
    constexpr std::array<double, 4> kScales = {8, 4, 2, 1};
    constexpr int kMaxIterations = 24;
    constexpr double kSettledM = 2e-4;
    std::vector<double> weights(ties_.size(), 1.0);
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      const Eigen::VectorXd before = x_;
      solve_once(weights);
      const bool is_settled = iteration > static_cast<int>(kScales.size()) &&
                              (x_ - before).lpNorm<Eigen::Infinity>() < kSettledM;
      if (ties_.empty() || is_settled) break;
      const double scale = kScales[static_cast<std::size_t>(std::min(iteration, 3))];
      for (std::size_t i = 0; i < ties_.size(); ++i) weights[i] = weight_of(ties_[i], scale);
      update_variances();
    }
    for (const auto& [stretch, chain] : chains_) {
      for (Eigen::Index k = 0; k < chain.count; ++k) {
        SlowErrors::Node& node = nodes[stretch].emplace_back();
        for (int axis = 0; axis < kAxes; ++axis) {
          const Eigen::Index i = kAxes * (chain.first + k) + axis;
          node.error[axis] = x_[i];
          node.variance[axis] = (*inverse_)(i, i);
        }
      }
    }
  }

 private:
  struct Chain {
    std::size_t drive = 0;
    Eigen::Index first = 0;  // node
    Eigen::Index count = 0;
  };

  double decay() const { return std::exp(-settings_.node_spacing_m / settings_.correlation_m); }

  std::array<Term, 2> at(const StretchPlace& place, double sign) const {
    const Chain& chain = chains_.at(place.stretch);
    const auto last = static_cast<double>(chain.count - 1);
    const double where = std::clamp(place.along_m / settings_.node_spacing_m, 0.0, last);
    const auto before = std::min(static_cast<Eigen::Index>(where), chain.count - 2);
    const double part = where - static_cast<double>(before);
    return {{{chain.first + before, sign * (1 - part)}, {chain.first + before + 1, sign * part}}};
  }

  std::array<Term, 4> terms_of(const Tie& tie) const {
    const auto b = at(tie.b, 1);
    const auto a = at(tie.a, -1);
    return {b[0], b[1], a[0], a[1]};
  }

  // Calls visit(drive, terms, relative variance) for each part of the prior of the drift.
  template <class Visit>
  void visit_drift(Visit visit) const {
    for (const auto& [stretch, chain] : chains_) {
      const Eigen::Index bias = bias_node_.at(chain.drive);
      visit(chain.drive, std::array<Term, 2>{{{chain.first, 1}, {bias, -1}}}, 1.0);
      for (Eigen::Index k = 1; k < chain.count; ++k) {
        visit(chain.drive,
              std::array<Term, 3>{
                  {{chain.first + k, 1}, {chain.first + k - 1, -decay()}, {bias, -(1 - decay())}}},
              1 - decay() * decay());
      }
    }
  }

  void solve_once(const std::vector<double>& weights) {
    std::vector<Eigen::Triplet<double>> elements;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(kAxes * next_);
    const auto add = [&](std::span<const Term> terms, const ErrorMatrix& information,
                         const ErrorVector& value) {
      const ErrorVector weighted = information * value;
      for (const Term& a : terms) {
        right.segment<kAxes>(kAxes * a.node) += a.factor * weighted;
        for (const Term& b : terms) {
          for (int i = 0; i < kAxes; ++i) {
            for (int j = 0; j < kAxes; ++j) {
              elements.emplace_back(kAxes * a.node + i, kAxes * b.node + j,
                                    a.factor * b.factor * information(i, j));
            }
          }
        }
      }
    };
    const ErrorVector zero = ErrorVector::Zero();
    const auto information_of = [](const ByKind& variances) -> ErrorMatrix {
      return on_axes(variances.cwiseInverse()).asDiagonal();
    };
    for (const auto& [drive, node] : bias_node_) {
      const std::array<Term, 1> bias = {{{node, 1}}};
      add(bias, information_of(variances_[drive].bias), zero);
    }
    visit_drift([&](std::size_t drive, std::span<const Term> terms, double relative) {
      add(terms, information_of(relative * variances_[drive].drift), zero);
    });
    for (std::size_t i = 0; i < ties_.size(); ++i) {
      const ErrorMatrix information = ties_[i].covariance.inverse();
      add(terms_of(ties_[i]), weights[i] * information, ties_[i].difference);
    }
    Eigen::SparseMatrix<double> normal(kAxes * next_, kAxes * next_);
    normal.setFromTriplets(elements.begin(), elements.end());
    const SparseFactor factor(normal);
    x_ = factor.solve(right);
    inverse_.emplace(factor);
  }

  double weight_of(const Tie& tie, double scale) const {
    ErrorVector off = -tie.difference;
    for (const Term& term : terms_of(tie))
      off += term.factor * x_.segment<kAxes>(kAxes * term.node);
    return robust_weight(off.dot(tie.covariance.ldlt().solve(off)), scale);
  }

  // The expected square of a linear function, summed over the axes of each kind.
  ByKind expected_squares(std::span<const Term> terms) const {
    ByKind sums;
    for (std::size_t kind = 0; kind < kKinds.size(); ++kind)
      sums[static_cast<Eigen::Index>(kind)] = expected_square(terms, kKinds[kind]);
    return sums;
  }

  double expected_square(std::span<const Term> terms, const Kind& kind) const {
    double sum = 0;
    for (int axis = kind.first; axis < kind.first + kind.axes; ++axis) {
      double value = 0;
      for (const Term& a : terms) {
        value += a.factor * x_[kAxes * a.node + axis];
        for (const Term& b : terms) {
          sum += a.factor * b.factor * (*inverse_)(kAxes * a.node + axis, kAxes * b.node + axis);
        }
      }
      sum += value * value;
    }
    return sum;
  }

  // One step of expectation maximization. The variances of a drive are those of all drives, and its
  // own as far as it shows them: the distribution of all errors has long tails.
  void update_variances() {
    constexpr double kBiasPrior = 3;  // values that what is common to all counts as
    constexpr double kDriftPrior = 15;
    const ByKind axes(kKinds[0].axes, kKinds[1].axes);
    std::map<std::size_t, Squares> bias;
    std::map<std::size_t, Squares> drift;
    for (const auto& [drive, node] : bias_node_) {
      const std::array<Term, 1> terms = {{{node, 1}}};
      bias[drive] = {expected_squares(terms), axes};
    }
    visit_drift([&](std::size_t drive, std::span<const Term> terms, double relative) {
      drift[drive].sums += expected_squares(terms) / relative;
      drift[drive].counts += axes;
    });
    const ByKind common_bias = common(bias);
    const ByKind common_drift = common(drift);
    for (auto& [drive, variances] : variances_) {
      variances.bias = drawn_to(common_bias, kBiasPrior, bias[drive]);
      variances.drift = drawn_to(common_drift, kDriftPrior, drift[drive]);
    }
  }

  // Sums of squares, and of how many values.
  struct Squares {
    ByKind sums = ByKind::Zero();
    ByKind counts = ByKind::Zero();
  };

  // The medians of the drives' mean squares.
  ByKind common(const std::map<std::size_t, Squares>& squares) const {
    ByKind medians = ByKind(settings_.min_sigma_m, settings_.min_roll_sigma_rad).cwiseAbs2();
    for (Eigen::Index kind = 0; kind < medians.size(); ++kind) {
      std::vector<double> means;
      means.reserve(squares.size());
      for (const auto& [drive, of_drive] : squares)
        means.push_back(of_drive.sums[kind] / of_drive.counts[kind]);
      std::ranges::sort(means);
      const std::size_t middle = means.size() / 2;
      const double median =
          means.size() % 2 == 1 ? means[middle] : (means[middle - 1] + means[middle]) / 2;
      medians[kind] = std::max(median, medians[kind]);
    }
    return medians;
  }

  static ByKind drawn_to(const ByKind& common, double prior, const Squares& own) {
    return ((prior * common + own.sums).array() / (prior + own.counts.array())).matrix();
  }

  const SlowErrorSettings& settings_;
  std::vector<Tie> ties_;
  std::map<std::size_t, Eigen::Index> bias_node_;  // of each drive
  std::map<std::size_t, Chain> chains_;            // of each stretch
  Eigen::Index next_ = 0;                          // number of nodes
  std::map<std::size_t, Variances> variances_;     // of each drive
  Eigen::VectorXd x_;
  std::optional<SelectedInverse> inverse_;
};

// For each drive the first one that it is connected with.
std::vector<std::size_t> connected(const std::vector<DrivenStretch>& stretches,
                                   const std::vector<Tie>& ties) {
  std::size_t drives = 0;
  for (const DrivenStretch& stretch : stretches) drives = std::max(drives, stretch.drive + 1);
  std::vector<std::size_t> first(drives);
  std::iota(first.begin(), first.end(), 0);
  const auto root = [&](std::size_t drive) {
    while (first[drive] != drive) drive = first[drive];
    return drive;
  };
  for (const Tie& tie : ties) {
    const std::size_t a = root(stretches[tie.a.stretch].drive);
    const std::size_t b = root(stretches[tie.b.stretch].drive);
    first[std::max(a, b)] = std::min(a, b);
  }
  for (std::size_t drive = 0; drive < drives; ++drive) first[drive] = root(drive);
  return first;
}

}  // namespace

SlowErrors estimate_slow_errors(const std::vector<DrivenStretch>& stretches,
                                const std::vector<Tie>& ties, const SlowErrorSettings& settings) {
  const std::vector<std::size_t> first = connected(stretches, ties);
  std::map<std::size_t, std::vector<std::size_t>> members;
  std::map<std::size_t, std::vector<Tie>> of_component;
  for (std::size_t i = 0; i < stretches.size(); ++i)
    members[first[stretches[i].drive]].push_back(i);
  for (const Tie& tie : ties) of_component[first[stretches[tie.a.stretch].drive]].push_back(tie);
  std::vector<std::vector<SlowErrors::Node>> nodes(stretches.size());
  for (auto& [drive, of_drive] : members)
    Component(stretches, of_drive, of_component[drive], settings).solve(nodes);
  return {std::move(nodes), settings.node_spacing_m};
}

SlowErrors::Node SlowErrors::at(std::size_t stretch, double along_m) const {
  const std::vector<Node>& nodes = nodes_[stretch];
  const double where = std::clamp(along_m / spacing_m_, 0.0, static_cast<double>(nodes.size() - 1));
  const auto before = std::min(static_cast<std::size_t>(where), nodes.size() - 2);
  const double part = where - static_cast<double>(before);
  const Node& a = nodes[before];
  const Node& b = nodes[before + 1];
  return {(1 - part) * a.error + part * b.error, (1 - part) * a.variance + part * b.variance};
}

PoseError SlowErrors::error(std::size_t stretch, double along_m) const {
  const ErrorVector error = at(stretch, along_m).error;
  return {error.head<3>(), error[kRollAxis]};
}

double SlowErrors::sigma_m(std::size_t stretch, double along_m) const {
  return std::sqrt(at(stretch, along_m).variance.head<2>().mean());
}

}  // namespace milepost
