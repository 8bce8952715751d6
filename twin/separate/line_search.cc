#include "twin/separate/line_search.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"

namespace twinbench::separate {
namespace {

constexpr int kFewestPlaces = 8;
constexpr double kLeastLogOdds = 3.0;  // 20 : 1 for a line
constexpr double kKnownShare = 4.0;    // the noise of repeats counts at most so many times what the fit says of it
constexpr double kAlikeShare = 0.5;    // of the columns of one order in the span of the other's
constexpr double kRelated = 0.02;      // the same, where no other line is in the model
constexpr double kTheSame = 0.999;     // the same, for orders that no reading there tells apart
constexpr double kNamed = 0.001;       // least probability of an order that is named as alike
constexpr double kSameDirection = 1e-6;  // squared sine below which a column lies in the span of others
// The same of an order: places that stand off an even grid by the errors themselves show a hundredth of what they hide
// of an order there, and so small a part fits anything.
constexpr double kLeastSeen = 0.01;
constexpr double kNothing_rad = 1e-4 * units::arcsec;  // residuals that need no explanation
constexpr double kRepeats = 2.5;  // least amplitude of an order, in what it differs by between turns
constexpr int kMostRounds = 4;

/// The columns of one order beside what the model has already, orthonormal; none, one or two.
Eigen::MatrixXd Beside(const Eigen::MatrixXd& model, Eigen::MatrixXd columns) {
  const double size = columns.squaredNorm();
  for (int pass = 0; pass < 2; ++pass) columns -= model * (model.transpose() * columns);  // twice is enough
  Eigen::Index kept = 0;
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    Eigen::VectorXd v = columns.col(c);
    for (Eigen::Index k = 0; k < kept; ++k) v -= columns.col(k) * columns.col(k).dot(v);
    if (v.squaredNorm() > kLeastSeen * size) columns.col(kept++) = v.normalized();
  }
  return columns.leftCols(kept);
}

Eigen::MatrixXd Joined(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd joined(a.rows(), a.cols() + b.cols());
  joined << a, b;
  return joined;
}

/// Squared cosine between what two sets of orthonormal columns span, averaged over the smaller one.
double Common(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const auto rank = static_cast<double>(std::min(a.cols(), b.cols()));
  return rank > 0.0 ? (a.transpose() * b).squaredNorm() / rank : 0.0;
}

class Search {
 public:
  Search(const IndexErrors& errors, const LineSearchOptions& options)
      : errors_(errors), options_(options), root_(WeightRootsOf(errors)) {
    value_ = root_.cwiseProduct(errors.value_rad);
    constants_ = OrthonormalBasisOf(root_.asDiagonal() * GroupColumns(errors), kSameDirection);
    double all = 0.0;
    for (int k = 1; k <= options.highest_order; ++k) all += 1.0 / k / k;
    for (int k = 1; k <= options.highest_order; ++k) {
      columns_.push_back(root_.asDiagonal() * ColumnsOf(errors, k));
      log_prior_.push_back(-2.0 * std::log(k) - std::log(all));
      alone_.push_back(Beside(constants_, columns_.back()));
    }
    NoteCommon();
  }

  /// What any two orders have in common, seen from these places.
  void NoteCommon() {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(value_.size(), 2 * std::ssize(alone_));
    for (std::size_t i = 0; i < alone_.size(); ++i)
      all.middleCols(2 * static_cast<Eigen::Index>(i), alone_[i].cols()) = alone_[i];
    const Eigen::MatrixXd squares = (all.transpose() * all).array().square();
    common_ = Eigen::MatrixXd::Zero(std::ssize(alone_), std::ssize(alone_));
    for (Eigen::Index i = 0; i < common_.rows(); ++i) {
      for (Eigen::Index j = 0; j < common_.cols(); ++j) {
        const Eigen::Index rank =
            std::min(alone_[static_cast<std::size_t>(i)].cols(), alone_[static_cast<std::size_t>(j)].cols());
        if (rank > 0) common_(i, j) = squares.block<2, 2>(2 * i, 2 * j).sum() / static_cast<double>(rank);
      }
    }
  }

  LineFit Find() {
    Grow();
    for (int round = 0; round < kMostRounds && Reconsider(); ++round) Grow();
    return Fitted();
  }

 private:
  struct Candidate {
    int order = 0;
    double log_odds = -INFINITY;  // with the prior of the order
  };

  /// An orthonormal basis of constants and chosen lines, but for one.
  Eigen::MatrixXd ModelWithout(int order) const {
    Eigen::MatrixXd model = constants_;
    for (const int k : chosen_) {
      if (k != order) model = Joined(model, Beside(model, Columns(k)));
    }
    return model;
  }

  const Eigen::MatrixXd& Columns(int order) const { return columns_[static_cast<std::size_t>(order - 1)]; }

  /// @param beside  Orthonormal columns of the order beside the model.
  /// @param left    Places less columns of the model.
  double LogOdds(int order, const Eigen::MatrixXd& beside, const Eigen::VectorXd& rest, double left) const {
    const double known_dof = std::min(errors_.dof, kKnownShare * left);
    const double known_rad2 = known_dof > 0.0 ? known_dof * VarianceOfOne_rad2(errors_) : 0.0;
    const double share = (beside.transpose() * rest).squaredNorm() / (rest.squaredNorm() + known_rad2);
    constexpr double kExact = 1e-12;  // noise-free values leave nothing but rounding
    return log_prior_[static_cast<std::size_t>(order - 1)] -
           0.5 * (left + known_dof) * std::log(std::max(1.0 - share, kExact)) -
           0.5 * static_cast<double>(beside.cols()) * std::log(static_cast<double>(rest.size()));
  }

  static bool IsNothing(const Eigen::VectorXd& rest, double left) {
    return rest.squaredNorm() < left * kNothing_rad * kNothing_rad;
  }

  Eigen::VectorXd RestOf(const Eigen::MatrixXd& model) const {
    return value_ - model * (model.transpose() * value_);
  }

  /// Takes up lines while there is evidence for another.
  void Grow() {
    Eigen::MatrixXd model = ModelWithout(0);
    Eigen::VectorXd rest = RestOf(model);
    std::vector<Eigen::MatrixXd> beside;
    for (const Eigen::MatrixXd& columns : columns_) beside.push_back(Beside(model, columns));
    // A sixth of the places: evidence against noise of unknown size needs most of them left.
    while (std::ssize(chosen_) < value_.size() / 6) {
      const auto left = static_cast<double>(rest.size() - model.cols());
      if (IsNothing(rest, left)) return;
      Candidate best;
      for (int k = 1; k <= options_.highest_order; ++k) {
        const Eigen::MatrixXd& own = beside[static_cast<std::size_t>(k - 1)];
        const double log_odds = own.cols() > 0 ? LogOdds(k, own, rest, left) : -INFINITY;
        if (log_odds > best.log_odds) best = {k, log_odds};
      }
      if (!(best.log_odds >= kLeastLogOdds)) return;
      const Eigen::MatrixXd taken = Beside(model, Columns(best.order));
      chosen_.push_back(best.order);
      model = Joined(model, taken);
      rest -= taken * (taken.transpose() * rest);
      for (Eigen::MatrixXd& columns : beside) columns = Beside(taken, std::move(columns));
    }
  }

  /// Every line again with all others in the model: leaves out what the others explain by now, takes the likeliest
  /// of the orders that look alike. @return whether a line was changed.
  bool Reconsider() {
    bool changed = false;
    for (const int order : std::vector<int>(chosen_)) {
      const std::vector<Candidate> alike = AlikeTo(order, ModelWithout(order));
      const auto place = std::ranges::find(chosen_, order);
      if (alike.empty() || alike.front().log_odds < kLeastLogOdds) {
        chosen_.erase(place);
        changed = true;
      } else if (alike.front().order != order) {
        *place = alike.front().order;
        changed = true;
      }
    }
    return changed;
  }

  /// The orders that explain the same part of the values as this one, itself among them, likeliest first.
  std::vector<Candidate> AlikeTo(int order, const Eigen::MatrixXd& model) const {
    const Eigen::VectorXd rest = RestOf(model);
    const auto left = static_cast<double>(rest.size() - model.cols());
    std::vector<Candidate> alike;
    if (IsNothing(rest, left)) return alike;
    const Eigen::MatrixXd own = Beside(model, Columns(order));
    for (int k = 1; k <= options_.highest_order; ++k) {
      // Orders that have nothing in common alone have nothing in common beside the others.
      if (k != order && !(common_(order - 1, k - 1) > kRelated)) continue;
      const Eigen::MatrixXd beside = Beside(model, Columns(k));
      if (beside.cols() == 0) continue;
      if (k == order || Common(own, beside) > kAlikeShare) alike.push_back({k, LogOdds(k, beside, rest, left)});
    }
    std::ranges::stable_sort(alike, std::ranges::greater(), &Candidate::log_odds);
    return alike;
  }

  IndexLine LineOf(int order) const {
    const std::vector<Candidate> alike = AlikeTo(order, ModelWithout(order));
    IndexLine line;
    line.order = order;
    double all = 0.0, likeliest = -INFINITY;
    for (const Candidate& c : alike) likeliest = std::max(likeliest, c.log_odds);
    for (const Candidate& c : alike) all += std::exp(c.log_odds - likeliest);
    for (const Candidate& c : alike) {
      const double probability = std::exp(c.log_odds - likeliest) / all;
      if (c.order == order) {
        line.probability = probability;
        line.log_odds = c.log_odds;
      } else if (probability > kNamed) {
        line.alike.push_back({c.order, probability});
      }
    }
    line.is_half_seen = alone_[static_cast<std::size_t>(order - 1)].cols() < 2;
    line.is_certain = line.probability >= options_.certain && !line.is_half_seen;
    return line;
  }

  double UBetweenTurns_rad(int order) const {
    if (order > std::ssize(errors_.u_order_rad)) return 0.0;
    const double u_rad = errors_.u_order_rad[static_cast<std::size_t>(order - 1)];
    return std::isfinite(u_rad) ? u_rad : 0.0;
  }

  void NoteBlindness(LineFit& fit) const {
    for (int k = 1; k <= options_.highest_order; ++k) {
      if (alone_[static_cast<std::size_t>(k - 1)].cols() < 2) fit.unseen.push_back(k);
      if ((common_.row(k - 1).array() > kTheSame).count() > 1) fit.doubled.push_back(k);
    }
  }

  LineFit Fitted() const {
    LineFit fit;
    NoteBlindness(fit);
    std::vector<int> orders = chosen_;
    std::ranges::sort(orders);
    Eigen::MatrixXd design = root_.asDiagonal() * GroupColumns(errors_);
    const Eigen::Index first = design.cols();
    for (const int k : orders) design = Joined(design, Columns(k));
    constexpr double kSingular = 0.1;  // half the positions: of such an order one phase is seen, or nearly (kLeastSeen)
    const auto n = static_cast<Eigen::Index>(value_.size());
    const RankedSolution solution = SolveRanked(design, Eigen::MatrixXd::Identity(n, n), kSingular);
    const Eigen::VectorXd x_rad = solution.x * value_;
    fit.dof = static_cast<int>(n - solution.rank);
    fit.residual_rad = std::sqrt((value_ - design * x_rad).squaredNorm() / std::max(1, fit.dof));
    for (std::size_t i = 0; i < orders.size(); ++i) {
      const Eigen::Index c = first + 2 * static_cast<Eigen::Index>(i);
      IndexLine line = LineOf(orders[i]);
      line.cos_rad = x_rad[c];
      line.sin_rad = x_rad[c + 1];
      line.u_rad = std::max(UBetweenTurns_rad(line.order),
                            fit.residual_rad * std::max(solution.x.row(c).norm(), solution.x.row(c + 1).norm()));
      line.changes = line.Amplitude_rad() < kRepeats * UBetweenTurns_rad(line.order);
      fit.lines.push_back(line);
    }
    return fit;
  }

  const IndexErrors& errors_;
  const LineSearchOptions& options_;
  Eigen::VectorXd root_, value_;                  // weighted
  Eigen::MatrixXd constants_;                     // orthonormal
  std::vector<Eigen::MatrixXd> columns_, alone_;  // of the orders; orthonormal beside the constants
  std::vector<double> log_prior_;
  Eigen::MatrixXd common_;  // of any two orders
  std::vector<int> chosen_;
};

}  // namespace

LineFit FindLines(const IndexErrors& errors, const LineSearchOptions& options) {
  if (errors.Count() < kFewestPlaces)
    throw InputError("index errors", std::to_string(errors.Count()) + " places were read",
                     "at least " + std::to_string(kFewestPlaces) + " over the turn");
  return Search(errors, options).Find();
}

Eigen::MatrixXd ColumnsOf(const IndexErrors& errors, int order) {
  Eigen::MatrixXd columns(errors.Count(), 2);
  for (Eigen::Index i = 0; i < columns.rows(); ++i) {
    const double angle_rad = order * errors.position_rad[static_cast<std::size_t>(i)];
    columns.row(i) << std::cos(angle_rad), std::sin(angle_rad);
  }
  return columns;
}

Eigen::MatrixXd GroupColumns(const IndexErrors& errors) {
  std::map<int, Eigen::Index> column;
  for (const int group : errors.group) column.emplace(group, std::ssize(column));
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(errors.Count(), std::ssize(column));
  for (std::size_t i = 0; i < errors.group.size(); ++i)
    columns(static_cast<Eigen::Index>(i), column.at(errors.group[i])) = 1.0;
  return columns;
}

double VarianceOfOne_rad2(const IndexErrors& errors) {
  const double u_rad = errors.u_reading_rad > 0.0 ? errors.u_reading_rad : 0.0;
  return u_rad * u_rad + errors.u_place_rad * errors.u_place_rad;
}

Eigen::VectorXd WeightRootsOf(const IndexErrors& errors) {
  Eigen::VectorXd roots = Eigen::VectorXd::Ones(errors.Count());
  if (!(errors.u_reading_rad > 0.0)) return roots;
  const double place_rad2 = errors.u_place_rad * errors.u_place_rad;
  const double one_rad2 = VarianceOfOne_rad2(errors);
  for (std::size_t i = 0; i < errors.count.size(); ++i)
    roots[static_cast<Eigen::Index>(i)] = std::sqrt(one_rad2 / (errors.NoiseVariance_rad2(i) + place_rad2));
  return roots;
}

}  // namespace twinbench::separate
