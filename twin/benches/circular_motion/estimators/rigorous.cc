#include "twin/benches/circular_motion/estimators/rigorous.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::separate::circular {
namespace {

using Eigen::Index, Eigen::VectorXd, Eigen::MatrixXd;

constexpr int kOfSetup = 4;
constexpr double kMountingStep = 1e-6;  // m, rad

double& MountingUnknown(CircleMounting& m, Index k) {
  if (k < 2) return m.offset_m[static_cast<std::size_t>(k)];
  return k == 2 ? m.rotation_rad : m.length_m;
}

bool TemperatureChanged(const std::vector<CirclePoint>& points) {
  constexpr double kLeast_K = 0.2;
  const auto [coldest, warmest] = std::ranges::minmax_element(points, {}, &CirclePoint::above_K);
  return warmest->above_K - coldest->above_K >= kLeast_K;
}

/// Rates of one set-up that are clearly not the same.
bool FeedsDiffer(const std::vector<CirclePoint>& points) {
  constexpr double kLeastRatio = 1.2;
  std::map<int, std::pair<double, double>> slowest_fastest;
  for (const CirclePoint& p : points) {
    const double rate_rad_s = std::abs(p.rate_rad_s);
    auto& [slowest, fastest] = slowest_fastest.try_emplace(p.setup, rate_rad_s, rate_rad_s).first->second;
    slowest = std::min(slowest, rate_rad_s);
    fastest = std::max(fastest, rate_rad_s);
  }
  return std::ranges::any_of(slowest_fastest, [](const auto& of) { return of.second.second > kLeastRatio * of.second.first; });
}

/// What a run has to show by.
struct Shows {
  bool warm, angle, bar;  // of the bar: with an encoder
  bool feeds;             // several of a mounting make circles of different size where axes lag
};

bool CanBeSeen(const CircleUnknown& unknown, const Shows& run) {
  using enum CircleUnknown::Needs;
  if (unknown.needs == kAngle) return run.angle;
  if (unknown.needs == kRadiusOnly) return !run.angle;
  if (unknown.needs == kRadiusAtFeeds) return !run.angle && run.feeds;
  if (unknown.needs == kTemperature) return run.warm;
  if (unknown.needs == kBar || unknown.needs == kBarShown) return run.bar;
  if (unknown.needs == kBarAndTemperature) return run.bar && run.warm;
  return unknown.needs == kNothing;
}

bool NeedsBar(CircleUnknown::Needs needs) {
  using enum CircleUnknown::Needs;
  return needs == kBar || needs == kBarShown || needs == kBarAndTemperature;
}

/// As bars are used the machine's part of these is the larger one by far.
void NameWhatARadiusHides(CircleFit& fit) {
  std::ranges::copy(std::array{"mean scale of both axes, length of the bar: D and F hold for the length as it was set",
                               "squareness, scale mismatch, form of the balls twice per turn, straightness of both axes by P3: taken "
                               "as the machine's squareness and scales",
                               "straightness, form of the balls three times per turn: taken as the machine's straightness",
                               "lag of both axes alike but for its square, rotation of the circle: a radius does not show it"},
                    std::back_inserter(fit.not_separable));
}

CircleFit Begin(const std::vector<CirclePoint>& points, const CircleConstants& known) {
  CircleFit fit;
  const Shows run{TemperatureChanged(points), std::ranges::any_of(points, &CirclePoint::has_angle),
                  std::ranges::any_of(points, [](const CirclePoint& p) { return p.is_bar && p.has_angle; }),
                  !known.is_delay && FeedsDiffer(points)};
  if (!run.bar) fit.errors = known.bar;
  for (std::size_t k = 0; k < CircleUnknowns().size(); ++k) {
    if (CanBeSeen(CircleUnknowns()[k], run)) fit.fitted.push_back(k);
  }
  std::set<int> setups;
  for (const CirclePoint& p : points) setups.insert(p.setup);
  fit.setups.assign(setups.begin(), setups.end());
  fit.mountings.resize(fit.setups.size());
  if (!run.warm) fit.not_separable.push_back("thermal errors: the temperature hardly changed");
  if (!run.angle) NameWhatARadiusHides(fit);
  return fit;
}

Index UnknownsOf(const CircleFit& fit) {
  return std::ssize(fit.fitted) + kOfSetup * std::ssize(fit.setups);
}

void Add(const VectorXd& change, CircleFit& fit) {
  for (std::size_t k = 0; k < fit.fitted.size(); ++k)
    CircleUnknowns()[fit.fitted[k]].in(fit.errors) += change[static_cast<Index>(k)];
  fit.errors.lag_mean_s = std::sqrt(std::max(fit.errors.lag_mean_square_s2, 0.0));
  for (std::size_t j = 0; j < fit.setups.size(); ++j) {
    for (Index k = 0; k < kOfSetup; ++k)
      MountingUnknown(fit.mountings[j], k) += change[fit.UnknownOf(fit.setups[j]) + k];
  }
}

std::string NameOf(const CircleFit& fit, Index unknown) {
  if (unknown < std::ssize(fit.fitted)) return CircleUnknowns()[fit.fitted[static_cast<std::size_t>(unknown)]].key;
  const Index behind = unknown - std::ssize(fit.fitted);
  const char* const names[] = {"offset_x", "offset_y", "rotation", "length"};
  return fmt::format("{} of mounting {}", names[behind % kOfSetup],
                     fit.setups[static_cast<std::size_t>(behind / kOfSetup)]);
}

/// Gain and the like: while the bar is thought to show nothing, they would be anything.
std::vector<Index> OfWhatTheBarShows(const CircleFit& fit) {
  std::vector<Index> unknowns;
  for (std::size_t k = 0; k < fit.fitted.size(); ++k) {
    if (CircleUnknowns()[fit.fitted[k]].needs == CircleUnknown::Needs::kBarShown)
      unknowns.push_back(static_cast<Index>(k));
  }
  return unknowns;
}

/// @param of  A function of errors and mounting; a grid knows nothing of bar and encoder.
template <class Function>
Eigen::Matrix2Xd SlopeOf(const Function& of, const CirclePoint& p, const CircleFit& fit) {
  Eigen::Matrix2Xd slope = Eigen::Matrix2Xd::Zero(2, UnknownsOf(fit));
  const CircleMounting& mounting = fit.MountingOf(p.setup);
  CircleErrors errors = fit.errors;
  for (std::size_t k = 0; k < fit.fitted.size(); ++k) {
    const CircleUnknown& unknown = CircleUnknowns()[fit.fitted[k]];
    if (!p.is_bar && NeedsBar(unknown.needs)) continue;
    double& one = unknown.in(errors);
    const double at = one;
    one = at + unknown.step;
    const Eigen::Vector2d above = of(errors, mounting);
    one = at - unknown.step;
    const Eigen::Vector2d below = of(errors, mounting);
    one = at;
    slope.col(static_cast<Index>(k)) = (above - below) / (2.0 * unknown.step);
  }
  const Index first = fit.UnknownOf(p.setup);
  for (Index k = 0; k < kOfSetup; ++k) {
    CircleMounting above = mounting, below = mounting;
    MountingUnknown(above, k) += kMountingStep;
    MountingUnknown(below, k) -= kMountingStep;
    const bool is_mounted = !p.is_drive || k < 2;  // a controller's zeros may stand off, its axes are those that it commands
    if (is_mounted) slope.col(first + k) = (of(fit.errors, above) - of(fit.errors, below)) / (2.0 * kMountingStep);
  }
  return slope;
}

/// The equations of one round: normal matrix of unit columns, and their lengths.
struct Equations {
  MatrixXd normal, of_machine, of_steps;  // the latter with each row by its share of the variance
  VectorXd right, scale;
  Index empty = 0;  // unknowns that no reading has: the length of a bar where the grid measures
  double chi2 = 0.0;
};

/// @param held  Unknowns that stay where they are.
Equations EquationsAt(const std::vector<CirclePoint>& points, const CircleFit& fit, const CircleConstants& known,
                      const std::vector<Index>& held) {
  const Index unknowns = UnknownsOf(fit);
  MatrixXd slope(2 * std::ssize(points), unknowns);
  VectorXd left(slope.rows()), of_machine(slope.rows()), of_steps(slope.rows());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CirclePoint& p = points[i];
    const Index row = 2 * static_cast<Index>(i);
    const Eigen::Vector2d weight = p.Weights(), shown_m = Shown_m(p, fit.errors, fit.MountingOf(p.setup), known);
    left.segment<2>(row) = weight.cwiseProduct(p.Values_m() - shown_m);
    of_machine.segment<2>(row) = p.of_machine;
    of_steps.segment<2>(row) = p.of_steps;
    slope.middleRows<2>(row) = weight.asDiagonal() * SlopeOfShown(p, fit, known);
  }
  slope(Eigen::all, held).setZero();
  Equations equations;
  equations.scale = slope.colwise().norm().transpose();
  const Eigen::ArrayXd is_empty = (equations.scale.array() == 0.0).cast<double>();
  equations.empty = static_cast<Index>(is_empty.sum());
  equations.scale = (equations.scale.array() > 0.0).select(equations.scale, 1.0);
  slope *= equations.scale.cwiseInverse().asDiagonal();
  equations.normal = slope.transpose() * slope;
  equations.of_machine = slope.transpose() * of_machine.asDiagonal() * slope;
  equations.of_steps = slope.transpose() * of_steps.asDiagonal() * slope;
  equations.normal.diagonal().array() += is_empty;  // they stay 0
  equations.right = slope.transpose() * left;
  equations.chi2 = left.squaredNorm();
  return equations;
}

/// Inverse of the normal matrix where the readings show something, and the directions where they do not.
struct Solved {
  MatrixXd inverse, hidden;
};

Solved Solve(const Equations& equations) {
  constexpr double kRank = 1e-7;  // of a squared singular value: 3e-4 of the largest
  const SymmetricEigen eigen = EigenOfSymmetric(equations.normal);
  const Index hidden = (eigen.values.array() < kRank * eigen.values.maxCoeff()).count();
  const Index seen = eigen.values.size() - hidden;
  const MatrixXd vectors = eigen.vectors.rightCols(seen);
  return {vectors * eigen.values.tail(seen).cwiseInverse().asDiagonal() * vectors.transpose(),
          eigen.vectors.leftCols(hidden)};
}

/// How dear an unknown is where the readings leave the choice: first the mounting, whose zeros are anything, then the machine
/// takes what is not told apart. Instruments are certified, or checked before they are mounted.
VectorXd Dearness(const CircleFit& fit) {
  constexpr double kOfMounting = 0.01, kOfMachine = 0.03;
  VectorXd dear = VectorXd::Constant(UnknownsOf(fit), kOfMounting);
  for (std::size_t k = 0; k < fit.fitted.size(); ++k)
    dear[static_cast<Index>(k)] = CircleUnknowns()[fit.fitted[k]].key.starts_with("machine.") ? kOfMachine : 1.0;
  return dear;
}

VectorXd ValuesOf(const CircleFit& fit) {
  CircleFit copy = fit;
  VectorXd values(UnknownsOf(fit));
  for (std::size_t k = 0; k < fit.fitted.size(); ++k)
    values[static_cast<Index>(k)] = CircleUnknowns()[fit.fitted[k]].in(copy.errors);
  for (std::size_t j = 0; j < fit.setups.size(); ++j) {
    for (Index k = 0; k < kOfSetup; ++k) values[fit.UnknownOf(fit.setups[j]) + k] = MountingUnknown(copy.mountings[j], k);
  }
  return values;
}

/// Along the directions that the readings do not show, to where the instruments err least. From the zero of an encoder, which may
/// be a degree off, a part would be squareness and form of the balls else.
VectorXd ToLeastErrors(const CircleFit& fit, const Equations& equations, const MatrixXd& hidden) {
  if (hidden.cols() == 0) return VectorXd::Zero(UnknownsOf(fit));
  const VectorXd dear = Dearness(fit);
  const MatrixXd along = dear.asDiagonal() * hidden;
  const VectorXd now = dear.cwiseProduct(equations.scale).cwiseProduct(ValuesOf(fit));
  return -(hidden * along.colPivHouseholderQr().solve(now)).cwiseQuotient(equations.scale);
}

/// "machine.lag_x_s, machine.lag_y_s, encoder.latency_s": those that share the hidden directions.
void NameHidden(const MatrixXd& hidden, CircleFit& fit) {
  constexpr double kPart = 0.05;
  fit.identified.assign(static_cast<std::size_t>(UnknownsOf(fit)), true);
  for (Index j = 0; j < hidden.cols(); ++j) {
    std::string words;
    for (Index k = 0; k < hidden.rows(); ++k) {
      if (std::abs(hidden(k, j)) < kPart) continue;
      words += (words.empty() ? "" : ", ") + NameOf(fit, k);
    }
    fit.not_separable.push_back(words);
  }
  for (Index k = 0; hidden.cols() > 0 && k < hidden.rows(); ++k) {  // no row of nothing is asked for
    if (hidden.row(k).norm() >= kPart) fit.identified[static_cast<std::size_t>(k)] = false;
  }
}

void SetResiduals(const std::vector<CirclePoint>& points, const CircleConstants& known, CircleFit& fit) {
  double bar = 0.0, encoder = 0.0, grid = 0.0;
  int of_bar = 0, of_encoder = 0, of_grid = 0;
  for (const CirclePoint& p : points) {
    const Eigen::Vector2d left_m = p.Values_m() - Shown_m(p, fit.errors, fit.MountingOf(p.setup), known);
    ++(p.is_bar ? of_bar : of_grid);
    if (!p.is_bar) grid += 0.5 * left_m.squaredNorm();
    if (!p.is_bar) continue;
    bar += left_m.x() * left_m.x();
    if (!p.has_angle) continue;
    ++of_encoder;
    encoder += std::pow(left_m.y() / p.radius_m, 2);
  }
  if (of_bar > 0) fit.rms_bar_m = std::sqrt(bar / of_bar);
  if (of_encoder > 0) fit.rms_encoder_rad = std::sqrt(encoder / of_encoder);
  if (of_grid > 0) fit.rms_grid_m = std::sqrt(grid / of_grid);
}

double Chi2Of(const std::vector<CirclePoint>& points, const CircleConstants& known, const CircleFit& fit) {
  double chi2 = 0.0;
  for (const CirclePoint& p : points) {
    const Eigen::Vector2d left_m = p.Values_m() - Shown_m(p, fit.errors, fit.MountingOf(p.setup), known);
    chi2 += p.Weights().cwiseProduct(left_m).squaredNorm();
  }
  return chi2;
}

/// A step or as many halves of it that the readings are left no worse than that: along what they hardly show it may lead anywhere.
void AddWithin(double most_chi2, VectorXd change, const std::vector<CirclePoint>& points, const CircleConstants& known,
               CircleFit& fit) {
  constexpr int kMostHalves = 16;
  for (int halves = 0; halves <= kMostHalves; ++halves, change *= 0.5) {
    CircleFit next = fit;
    Add(change, next);
    if (!(Chi2Of(points, known, next) <= most_chi2)) continue;
    fit = std::move(next);
    return;
  }
}

/// What is left along each pass, in stated uncertainties: a channel after the other.
std::vector<VectorXd> LeftAlongPasses(const std::vector<CirclePoint>& points, const CircleFit& fit, const CircleConstants& known) {
  std::vector<VectorXd> left;
  for (std::size_t first = 0, end = 0; first < points.size(); first = end) {
    while (end < points.size() && points[end].setup == points[first].setup && points[end].pass == points[first].pass) ++end;
    Eigen::MatrixX2d of_pass(static_cast<Index>(end - first), 2);
    for (std::size_t i = first; i < end; ++i) {
      const CirclePoint& p = points[i];
      of_pass.row(static_cast<Index>(i - first)) =
          p.Weights().cwiseProduct(p.Values_m() - Shown_m(p, fit.errors, fit.MountingOf(p.setup), known));
    }
    left.emplace_back(of_pass.col(0));
    if (points[first].has_angle) left.emplace_back(of_pass.col(1));
  }
  return left;
}

/// How many neighbours say one thing: what is left because an error is none of the unknowns goes on from reading to reading, and n of them
/// are no n independent ones. Until it no longer does (initial positive sequence).
double MemoryOf(const std::vector<VectorXd>& left) {
  constexpr Index kLeastPairs = 8;
  double squares = 0.0, memory = 1.0;
  for (const VectorXd& r : left) squares += r.squaredNorm();
  for (Index apart = 1; squares > 0.0; ++apart) {
    double products = 0.0;
    Index pairs = 0;
    for (const VectorXd& r : left) {
      const Index count = r.size() - apart;
      if (count <= 0) continue;
      products += r.head(count).dot(r.tail(count));
      pairs += count;
    }
    if (pairs < kLeastPairs || products <= 0.0) break;
    memory += 2.0 * products / squares;
  }
  return memory;
}

/// Of all variances: what is left beyond the stated noise, as much as its readings are independent.
double WideningOf(const std::vector<CirclePoint>& points, const CircleFit& fit, const CircleConstants& known) {
  return fit.chi > 1.0 ? 1.0 + (fit.chi * fit.chi - 1.0) * MemoryOf(LeftAlongPasses(points, fit, known)) : 1.0;
}

}  // namespace

double SharedUncertainty::Variance(const VectorXd& slope) const {
  constexpr double kPart = 0.02;
  const double goes_with_hidden = (hidden.transpose() * slope).norm();
  if (goes_with_hidden > kPart * slope.cwiseProduct(typical).norm()) return kNaN;
  return slope.dot(cov * slope);
}

PartedVariance SharedUncertainty::Parted(const VectorXd& slope) const {
  const double all = slope.dot(cov * slope);
  return {all, slope.dot(of_steps * slope), slope.dot(of_machine * slope) + excess * all};
}

const CircleMounting& CircleFit::MountingOf(int setup) const {
  return mountings[static_cast<std::size_t>(std::ranges::find(setups, setup) - setups.begin())];
}

Eigen::Index CircleFit::UnknownOf(int setup) const {
  return std::ssize(fitted) + kOfSetup * (std::ranges::find(setups, setup) - setups.begin());
}

Eigen::Matrix2Xd SlopeOfShown(const CirclePoint& p, const CircleFit& fit, const CircleConstants& known) {
  CircleMemo memo;
  return SlopeOf([&](const CircleErrors& e, const CircleMounting& m) { return Shown_m(p, e, m, known, memo); }, p, fit);
}

Eigen::Matrix2Xd SlopeOfDeviation(const CirclePoint& p, const CircleFit& fit, const CircleConstants& known) {
  return SlopeOf([&](const CircleErrors& e, const CircleMounting& m) { return Deviation_m(p, e, m, known); }, p, fit);
}

std::vector<CirclePoint> Thinned(const std::vector<CirclePoint>& points, std::size_t enough) {
  const std::size_t every = std::max<std::size_t>((points.size() + enough - 1) / enough, 1);
  std::vector<CirclePoint> some;
  for (std::size_t i = 0; i < points.size(); i += every) some.push_back(points[i]);
  return some;
}

CircleFit FitCircles(const std::vector<CirclePoint>& points, const CircleConstants& known) {
  constexpr int kRounds = 8, kSetupsFirst = 2, kLastOnes = 3;
  constexpr std::size_t kEnoughPoints = 4000;  // of the rounds that lead near: the last ones take all
  constexpr double kMoved = 2.0;  // hidden directions are none to the last digit; what they leave is fitted in the last rounds
  if (points.empty()) throw InputError("readings", "none has a radius", "readings of a bar or a grid");
  CircleFit fit = Begin(points, known);
  const Index unknowns = UnknownsOf(fit);
  const Index values = std::ssize(points) + std::ranges::count(points, true, &CirclePoint::has_angle);
  if (values <= unknowns)
    throw InputError("readings", fmt::format("{} values for {} unknowns", values, unknowns), "more readings of the circle");
  Solved solved;
  Equations equations;
  const std::vector<CirclePoint> some = Thinned(points, kEnoughPoints);
  for (int k = 0; k <= kRounds; ++k) {
    const bool is_last = k >= kRounds - kLastOnes;
    const std::vector<CirclePoint>& of_round = is_last ? points : some;
    equations = EquationsAt(of_round, fit, known, k < kSetupsFirst ? OfWhatTheBarShows(fit) : std::vector<Index>{});
    solved = Solve(equations);
    if (k == kRounds) break;
    AddWithin(equations.chi2, (solved.inverse * equations.right).cwiseQuotient(equations.scale), of_round, known, fit);
    if (is_last) continue;
    const double moved_chi2 = kMoved * Chi2Of(of_round, known, fit);
    AddWithin(moved_chi2, ToLeastErrors(fit, equations, solved.hidden), of_round, known, fit);
  }
  fit.dof = values - unknowns + solved.hidden.cols() + equations.empty;
  fit.chi = std::sqrt(equations.chi2 / static_cast<double>(fit.dof));
  const MatrixXd unscale = equations.scale.cwiseInverse().asDiagonal();
  const double widening = WideningOf(points, fit, known);
  const MatrixXd from_right = unscale * solved.inverse;
  fit.shared = {widening * from_right * unscale,
                unscale * solved.hidden,
                equations.scale.cwiseInverse(),
                from_right * equations.of_machine * from_right.transpose(),
                from_right * equations.of_steps * from_right.transpose(),
                1.0 - 1.0 / widening};
  NameHidden(solved.hidden, fit);
  SetResiduals(points, known, fit);
  return fit;
}

}  // namespace twinbench::separate::circular
