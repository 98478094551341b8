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
#include "mapper/fusion/variance_components.h"

namespace milepost {
namespace {

constexpr int kAxes = kErrorAxes;

// The product of an axis' node and its factor: part of a linear function.
struct Term {
  Eigen::Index node = 0;
  ErrorVector factor;
};

Term term(Eigen::Index node, double factor) { return {node, ErrorVector::Constant(factor)}; }

double robust_weight(double squared_sigmas, double scale) {
  // Of a Student's t of this many degrees of freedom, at residuals divided by `scale` (graduated
  // non-convexity: from a large scale, at which all ties count alike, to 1).
  constexpr double kDegrees = 4;
  return (kDegrees + kAxes) / (kDegrees + squared_sigmas / (scale * scale));
}

// Of drives that ties or a common bias connect, directly or over others. Its unknowns are errors in
// units of the sigma that is stated, relative to that of the settings.
class Component {
 public:
  Component(const std::vector<DriveErrors>& drives, const std::vector<DrivenStretch>& stretches,
            const std::vector<std::size_t>& members, std::vector<Tie> ties,
            const SlowErrorSettings& settings)
      : drives_(drives), stretches_(stretches), settings_(settings), ties_(std::move(ties)) {
    const ByKind bias = ByKind(settings.bias_sigma_m, settings.bias_roll_sigma_rad).cwiseAbs2();
    const ByKind drift = ByKind(settings.drift_sigma_m, settings.drift_roll_sigma_rad).cwiseAbs2();
    for (const std::size_t stretch : members) {
      const std::size_t drive = stretches[stretch].drive;
      Bias& of_drive =
          biases_.try_emplace(drives[drive].bias, Bias{next_, bias, false}).first->second;
      if (of_drive.node == next_) ++next_;
      of_drive.is_stated = of_drive.is_stated || drives[drive].sigma_m;
      drifts_.try_emplace(drive, drift);
      if (stretches[stretch].same_way) continue;
      const auto count =
          static_cast<Eigen::Index>(node_count(stretches[stretch].length_m, settings));
      chains_[stretch] = {drive, next_, count};
      next_ += count;
    }
  }

  void solve(std::vector<SlowErrors::OfStretch>& found) {
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
    const std::size_t told = differences_of_biases();
    const bool tells_biases = told > 0;
    if (tells_biases) {
      widen_biases(told);
      solve_once(weights);
    }
    for (const auto& [stretch, chain] : chains_) {
      found[stretch].is_assumed = !tells_biases && is_assumed(drives_[chain.drive]);
      for (Eigen::Index k = 0; k < chain.count; ++k) {
        SlowErrors::Node& node = found[stretch].nodes.emplace_back();
        const ErrorVector scale = scale_of(stretch, static_cast<std::size_t>(k));
        for (int axis = 0; axis < kAxes; ++axis) {
          const Eigen::Index i = kAxes * (chain.first + k) + axis;
          node.error[axis] = scale[axis] * x_[i];
          node.variance[axis] = scale[axis] * scale[axis] * (*inverse_)(i, i);
        }
      }
    }
  }

 private:
  struct Bias {
    Eigen::Index node = 0;
    ByKind variance;
    bool is_stated = false;
  };
  struct Chain {
    std::size_t drive = 0;
    Eigen::Index first = 0;  // node
    Eigen::Index count = 0;
  };

  static bool is_assumed(const DriveErrors& drive) {
    return !drive.sigma_m || drive.sigma_is_assumed;
  }

  std::size_t bias_of(std::size_t stretch) const { return drives_[stretches_[stretch].drive].bias; }

  double decay(std::size_t drive) const {
    const double correlation_m = drives_[drive].correlation_m.value_or(settings_.correlation_m);
    return std::exp(-settings_.node_spacing_m / correlation_m);
  }

  // Of a node's errors; of positions what is stated, relative to the settings.
  ErrorVector scale_of(std::size_t stretch, std::size_t node) const {
    const double usual_m = std::hypot(settings_.bias_sigma_m, settings_.drift_sigma_m);
    const std::vector<double>& factors = stretches_[stretch].sigma_factors;
    double sigma_m = drives_[stretches_[stretch].drive].sigma_m.value_or(usual_m);
    if (!factors.empty()) sigma_m *= factors[node];
    const double scale = std::max(sigma_m, settings_.min_sigma_m) / usual_m;
    return {scale, scale, scale, 1};
  }

  std::array<Term, 2> at(const StretchPlace& place, double sign) const {
    const Chain& chain = chains_.at(place.stretch);
    const auto last = static_cast<double>(chain.count - 1);
    const double where = std::clamp(place.along_m / settings_.node_spacing_m, 0.0, last);
    const auto before = std::min(static_cast<Eigen::Index>(where), chain.count - 2);
    const double part = where - static_cast<double>(before);
    const auto node = static_cast<std::size_t>(before);
    return {{{chain.first + before, sign * (1 - part) * scale_of(place.stretch, node)},
             {chain.first + before + 1, sign * part * scale_of(place.stretch, node + 1)}}};
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
      const Eigen::Index bias = biases_.at(drives_[chain.drive].bias).node;
      const double kept = decay(chain.drive);
      visit(chain.drive, std::array<Term, 2>{{term(chain.first, 1), term(bias, -1)}}, 1.0);
      for (Eigen::Index k = 1; k < chain.count; ++k) {
        visit(chain.drive,
              std::array<Term, 3>{{term(chain.first + k, 1), term(chain.first + k - 1, -kept),
                                   term(bias, -(1 - kept))}},
              1 - kept * kept);
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
        right.segment<kAxes>(kAxes * a.node) += a.factor.cwiseProduct(weighted);
        for (const Term& b : terms) {
          for (int i = 0; i < kAxes; ++i) {
            for (int j = 0; j < kAxes; ++j) {
              elements.emplace_back(kAxes * a.node + i, kAxes * b.node + j,
                                    a.factor[i] * b.factor[j] * information(i, j));
            }
          }
        }
      }
    };
    const ErrorVector zero = ErrorVector::Zero();
    const auto information_of = [](const ByKind& variances) -> ErrorMatrix {
      return on_axes(variances.cwiseInverse()).asDiagonal();
    };
    for (const auto& [number, bias] : biases_)
      add(std::array<Term, 1>{term(bias.node, 1)}, information_of(bias.variance), zero);
    visit_drift([&](std::size_t drive, std::span<const Term> terms, double relative) {
      add(terms, information_of(relative * drifts_.at(drive)), zero);
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
    for (const Term& part : terms_of(tie))
      off += part.factor.cwiseProduct(x_.segment<kAxes>(kAxes * part.node));
    return robust_weight(off.dot(tie.covariance.ldlt().solve(off)), scale);
  }

  // The expected square of a linear function, summed over the axes of each kind.
  ByKind expected_squares(std::span<const Term> terms) const {
    ByKind sums;
    for (std::size_t kind = 0; kind < kAxisKinds.size(); ++kind)
      sums[static_cast<Eigen::Index>(kind)] = expected_square(terms, kAxisKinds[kind]);
    return sums;
  }

  double expected_square(std::span<const Term> terms, const AxisKind& kind) const {
    double sum = 0;
    for (int axis = kind.first; axis < kind.first + kind.axes; ++axis) {
      double value = 0;
      for (const Term& a : terms) {
        value += a.factor[axis] * x_[kAxes * a.node + axis];
        for (const Term& b : terms) {
          sum += a.factor[axis] * b.factor[axis] *
                 (*inverse_)(kAxes * a.node + axis, kAxes * b.node + axis);
        }
      }
      sum += value * value;
    }
    return sum;
  }

  // One step of expectation maximization.
  void update_variances() {
    constexpr double kBiasPrior = 3;  // values that what is common to all counts as
    constexpr double kDriftPrior = 15;
    const ByKind axes(kAxisKinds[0].axes, kAxisKinds[1].axes);
    std::vector<Squares> of_bias;
    for (const auto& [number, bias] : biases_) {
      const std::array<Term, 1> terms = {term(bias.node, 1)};
      of_bias.push_back({expected_squares(terms), axes, bias.is_stated});
    }
    std::map<std::size_t, Squares> of_drift;
    visit_drift([&](std::size_t drive, std::span<const Term> terms, double relative) {
      Squares& squares = of_drift[drive];
      squares.sums += expected_squares(terms) / relative;
      squares.counts += axes;
      squares.is_stated = drives_[drive].sigma_m.has_value();
    });
    const ByKind least = ByKind(settings_.min_sigma_m, settings_.min_roll_sigma_rad).cwiseAbs2();
    const double usual_bias_m2 = settings_.bias_sigma_m * settings_.bias_sigma_m;
    const ByKind common_bias = common_variances(of_bias, usual_bias_m2, least);
    std::size_t next = 0;
    for (auto& [number, bias] : biases_)
      bias.variance = drawn_variances(of_bias[next++], common_bias, kBiasPrior, usual_bias_m2);
    const double usual_drift_m2 = settings_.drift_sigma_m * settings_.drift_sigma_m;
    std::vector<Squares> all_drifts;
    all_drifts.reserve(of_drift.size());
    for (const auto& [drive, squares] : of_drift) all_drifts.push_back(squares);
    const ByKind common_drift = common_variances(all_drifts, usual_drift_m2, least);
    for (const auto& [drive, squares] : of_drift)
      drifts_.at(drive) = drawn_variances(squares, common_drift, kDriftPrior, usual_drift_m2);
  }

  // Differences of two biases that ties tell, of which none follows from others.
  std::size_t differences_of_biases() const {
    std::map<std::size_t, std::size_t> group;  // of each bias
    for (const auto& [number, bias] : biases_) group[number] = number;
    std::size_t count = 0;
    for (const Tie& tie : ties_) {
      const std::size_t a = group.at(bias_of(tie.a.stretch));
      const std::size_t b = group.at(bias_of(tie.b.stretch));
      if (a == b) continue;
      ++count;
      for (auto& [number, of_bias] : group) {
        if (of_bias == b) of_bias = a;
      }
    }
    return count;
  }

  // Few biases may agree by chance.
  void widen_biases(std::size_t differences) {
    for (auto& [number, bias] : biases_) {
      for (std::size_t kind = 0; kind < kAxisKinds.size(); ++kind) {
        if (kind == 0 && bias.is_stated) continue;
        bias.variance[static_cast<Eigen::Index>(kind)] *=
            few_values_factor(differences * static_cast<std::size_t>(kAxisKinds[kind].axes));
      }
    }
  }

  const std::vector<DriveErrors>& drives_;
  const std::vector<DrivenStretch>& stretches_;
  const SlowErrorSettings& settings_;
  std::vector<Tie> ties_;
  std::map<std::size_t, Bias> biases_;    // by number
  std::map<std::size_t, ByKind> drifts_;  // variance of each drive
  std::map<std::size_t, Chain> chains_;   // of each stretch that has its own
  Eigen::Index next_ = 0;                 // number of nodes
  Eigen::VectorXd x_;
  std::optional<SelectedInverse> inverse_;
};

// For each drive the first one that it is connected with.
std::vector<std::size_t> connected(const std::vector<DriveErrors>& drives,
                                   const std::vector<DrivenStretch>& stretches,
                                   const std::vector<Tie>& ties) {
  std::vector<std::size_t> first(drives.size());
  std::iota(first.begin(), first.end(), 0);
  const auto root = [&](std::size_t drive) {
    while (first[drive] != drive) drive = first[drive];
    return drive;
  };
  const auto connect = [&](std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    first[std::max(a, b)] = std::min(a, b);
  };
  std::map<std::size_t, std::size_t> first_of_bias;
  for (std::size_t drive = 0; drive < drives.size(); ++drive)
    connect(drive, first_of_bias.try_emplace(drives[drive].bias, drive).first->second);
  for (const Tie& tie : ties)
    connect(stretches[tie.a.stretch].drive, stretches[tie.b.stretch].drive);
  for (std::size_t drive = 0; drive < drives.size(); ++drive) first[drive] = root(drive);
  return first;
}

// The place on the stretch that has the errors.
StretchPlace with_errors(const StretchPlace& place, const std::vector<DrivenStretch>& stretches) {
  const auto& same = stretches[place.stretch].same_way;
  if (!same) return place;
  const double part =
      (place.along_m - same->along.from_m) / (same->along.to_m - same->along.from_m);
  return {same->stretch, same->there.from_m + part * (same->there.to_m - same->there.from_m)};
}

}  // namespace

std::size_t node_count(double length_m, const SlowErrorSettings& settings) {
  return static_cast<std::size_t>(std::ceil(length_m / settings.node_spacing_m)) + 1;
}

SlowErrors estimate_slow_errors(const std::vector<DriveErrors>& drives,
                                const std::vector<DrivenStretch>& stretches,
                                const std::vector<Tie>& ties, const SlowErrorSettings& settings) {
  const std::vector<std::size_t> first = connected(drives, stretches, ties);
  std::map<std::size_t, std::vector<std::size_t>> members;
  std::map<std::size_t, std::vector<Tie>> of_component;
  for (std::size_t i = 0; i < stretches.size(); ++i)
    members[first[stretches[i].drive]].push_back(i);
  for (Tie tie : ties) {
    tie.a = with_errors(tie.a, stretches);
    tie.b = with_errors(tie.b, stretches);
    of_component[first[stretches[tie.a.stretch].drive]].push_back(tie);
  }
  std::vector<SlowErrors::OfStretch> found(stretches.size());
  for (auto& [drive, of_drive] : members)
    Component(drives, stretches, of_drive, of_component[drive], settings).solve(found);
  const SlowErrors own(found, settings.node_spacing_m);
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    if (!stretches[i].same_way) continue;
    found[i].is_assumed = own.is_assumed(stretches[i].same_way->stretch);
    for (std::size_t k = 0; k < node_count(stretches[i].length_m, settings); ++k) {
      const double along_m = static_cast<double>(k) * settings.node_spacing_m;
      const StretchPlace there = with_errors({i, along_m}, stretches);
      found[i].nodes.push_back(own.at(there.stretch, there.along_m));
    }
  }
  return {std::move(found), settings.node_spacing_m};
}

SlowErrors::Node SlowErrors::at(std::size_t stretch, double along_m) const {
  const std::vector<Node>& nodes = stretches_[stretch].nodes;
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
