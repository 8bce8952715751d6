#include "twin/benches/freeform_five_axis/estimators/identification.h"

#include <algorithm>
#include <cmath>

#include "twin/core/linear_algebra.h"
#include "twin/core/robust_scale.h"

namespace twinbench::benches::freeform::estimators {
namespace {

constexpr double kSingular = 3e-4, kNoColumn = 1e-6;

/// One per row: 1 / noise. Two thousandths of the usual noise are the least: nearer the model of the probe is not to the light.
Eigen::VectorXd WeightsOf(const FreeformSettings& bench, std::size_t poses) {
  constexpr double kLeast = 2e-3;
  const auto weight = [](double noise, double usual) { return 1.0 / std::max(noise, kLeast * usual); };
  const Eigen::Vector3d one(weight(bench.qpd.noise_V, QuadrantSettings{}.noise_V),
                            weight(bench.qpd.noise_V, QuadrantSettings{}.noise_V),
                            weight(bench.ccd.noise_px, CameraSettings{}.noise_px));
  return one.replicate(static_cast<Eigen::Index>(poses), 1);
}

Eigen::VectorXd Residual(const FreeformSettings& bench, const std::vector<PoseRead>& poses,
                         const Eigen::VectorXd& unknowns) {
  Eigen::VectorXd left(3 * std::ssize(poses));
  for (std::size_t p = 0; p < poses.size(); ++p)
    left.segment<3>(3 * static_cast<Eigen::Index>(p)) =
        poses[p].shown - Predicted(bench, poses[p], InputsAt(poses[p], unknowns));
  return left;
}

/// White readings in unit columns: x = scale * y, y of minimum norm.
struct Spectrum {
  Eigen::MatrixXd white;  // rows x unknowns, unit columns
  Eigen::VectorXd scale;  // of each unknown; 0: a column that shows nothing
  SymmetricEigen eigen;   // of white^T white, ascending
  Eigen::Index rank = 0;

  double Singular(Eigen::Index k) const { return std::sqrt(std::max(0.0, eigen.values[k])); }
};

Spectrum SpectrumOf(const Eigen::MatrixXd& J, const Eigen::VectorXd& weights) {
  Spectrum s;
  s.white = weights.asDiagonal() * J;
  const Eigen::VectorXd norms = s.white.colwise().norm();
  s.scale = (norms.array() > kNoColumn * norms.maxCoeff()).select(norms.cwiseInverse(), 0.0);
  s.white *= s.scale.asDiagonal();
  s.eigen = EigenOfSymmetric(s.white.transpose() * s.white);
  const Eigen::Index count = s.eigen.values.size();
  for (Eigen::Index k = 0; k < count; ++k) s.rank += s.Singular(k) > kSingular * s.Singular(count - 1) ? 1 : 0;
  return s;
}

/// The least solution of white y = seen.
Eigen::VectorXd Least(const Spectrum& s, const Eigen::VectorXd& seen) {
  const auto V = s.eigen.vectors.rightCols(s.rank);
  const Eigen::VectorXd along = V.transpose() * (s.white.transpose() * seen);
  return V * along.cwiseQuotient(s.eigen.values.tail(s.rank));
}

/// Gauss-Jordan with pivots as large as can be: one row a direction, its pivot 1 and 0 in the other rows.
Eigen::MatrixXd Reduced(Eigen::MatrixXd rows, std::vector<Eigen::Index>& pivots) {
  for (Eigen::Index done = 0; done < rows.rows(); ++done) {
    Eigen::Index row = 0, column = 0;
    rows.bottomRows(rows.rows() - done).cwiseAbs().maxCoeff(&row, &column);
    rows.row(done).swap(rows.row(done + row));
    rows.row(done) /= rows(done, column);
    for (Eigen::Index other = 0; other < rows.rows(); ++other) {
      if (other != done) rows.row(other) -= (rows(other, column) * rows.row(done)).eval();
    }
    pivots.push_back(column);
  }
  return rows;
}

bool IsConstant(const std::string& name) {
  return name.starts_with("mount") || name.starts_with("s") || name.ends_with("0");
}

std::string WhyOf(const std::map<std::string, double>& what, bool strictly) {
  const auto all = [&](auto holds) {
    return std::ranges::all_of(what, [&](const auto& entry) { return holds(entry.first); });
  };
  if (all([](const std::string& name) { return name.starts_with("b.rz"); }))
    return "turning about the beam moves nothing that the probe sees";
  if (!strictly) return "on this path these functions of the axes differ by less than the noise shows";
  if (all(IsConstant)) return "constants of bodies in a row add up, and mountings take up what is left";
  const bool mounted =
      std::ranges::any_of(what, [](const auto& entry) { return entry.first.starts_with("mount"); });
  if (mounted) return "every mounting can be moved and turned so that it takes up the rest";
  return "a slope of an error along its axis is the squareness of that axis, or a turn of every mounting";
}

std::vector<NotSeparable> NullSpaceInWords(const Spectrum& s, const std::vector<std::string>& names) {
  constexpr double kVisible = 0.02, kStrict = 1e-5;
  std::vector<NotSeparable> all;
  for (Eigen::Index k = 0; k < s.scale.size(); ++k) {
    if (s.scale[k] > 0.0) continue;
    NotSeparable& alone = all.emplace_back();
    alone.what[names[static_cast<std::size_t>(k)]] = 1.0;
    alone.why = WhyOf(alone.what, true);
  }
  // Exact directions first, so that they are not mixed with those that are only weak.
  const Eigen::Index lost = s.eigen.values.size() - s.rank;
  Eigen::Index strict = 0;
  while (strict < lost && s.Singular(strict) < kStrict * s.Singular(s.eigen.values.size() - 1)) ++strict;
  for (const auto& [from, count] : {std::pair{Eigen::Index{0}, strict}, std::pair{strict, lost - strict}}) {
    if (count == 0) continue;
    std::vector<Eigen::Index> pivots;
    const Eigen::MatrixXd rows = Reduced(s.eigen.vectors.middleCols(from, count).transpose(), pivots);
    for (Eigen::Index k = 0; k < count; ++k) {
      NotSeparable one;
      const double unit = s.scale[pivots[static_cast<std::size_t>(k)]];
      if (unit == 0.0) continue;  // a column that shows nothing stands above
      for (Eigen::Index i = 0; i < rows.cols(); ++i) {
        if (std::abs(rows(k, i)) > kVisible && s.scale[i] > 0.0)
          one.what[names[static_cast<std::size_t>(i)]] = rows(k, i) * s.scale[i] / unit;
      }
      one.why = WhyOf(one.what, from == 0);
      all.push_back(one);
    }
  }
  return all;
}

void Conclude(const Spectrum& s, Identification& result) {
  constexpr double kDecided = 1e-4;  // share of an unknown that may lie in lost directions
  const Eigen::Index count = s.eigen.values.size(), lost = count - s.rank;
  const auto V = s.eigen.vectors.rightCols(s.rank);
  result.rank = s.rank;
  result.covariance = s.scale.asDiagonal() * V * s.eigen.values.tail(s.rank).cwiseInverse().asDiagonal() *
                      V.transpose() * s.scale.asDiagonal();
  result.u = result.covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd share = s.eigen.vectors.leftCols(lost).rowwise().squaredNorm();
  for (Eigen::Index k = 0; k < count; ++k) result.identified.push_back(s.scale[k] > 0.0 && share[k] < kDecided);
  result.singular_values.resize(count);
  for (Eigen::Index k = 0; k < count; ++k)
    result.singular_values[count - 1 - k] = s.Singular(k) / s.Singular(count - 1);
  result.not_separable = NullSpaceInWords(s, NamesOf(result.setups));
}

/// Beyond any tail of noise, and far from the second of its kind: what the model lacks shows at many poses.
std::optional<LoneValue> LoneIn(const std::vector<PoseRead>& poses, const Eigen::Ref<const Eigen::Matrix3Xd>& left) {
  constexpr double kTimesOthers = 8.0, kTimesNext = 2.0;
  std::optional<LoneValue> lone;
  for (int channel = 0; channel < 3; ++channel) {
    const Eigen::VectorXd sizes = left.row(channel).cwiseAbs();
    std::vector<double> rising(sizes.begin(), sizes.end());
    std::ranges::sort(rising);
    if (rising.size() < 2) return {};
    const double scatter = RobustDeviation(rising), largest = rising.back(), next = rising.rbegin()[1];
    if (!(largest > kTimesOthers * scatter && largest > kTimesNext * next)) continue;
    Eigen::Index pose = 0;
    sizes.maxCoeff(&pose);
    if (!lone || largest / scatter > lone->times)
      lone = {poses[static_cast<std::size_t>(pose)].reading, channel, largest / scatter};
  }
  return lone;
}

}  // namespace

int SetupsOf(const std::vector<PoseRead>& poses) {
  int setups = 0;
  for (const PoseRead& pose : poses) setups = std::max(setups, pose.setup + 1);
  return setups;
}

Identification SolveLinear(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& weights,
                           const Eigen::VectorXd& seen, int setups) {
  Identification result;
  result.setups = setups;
  result.converged = true;
  const Spectrum spectrum = SpectrumOf(jacobian, weights);
  result.unknowns = spectrum.scale.cwiseProduct(Least(spectrum, weights.cwiseProduct(seen)));
  Conclude(spectrum, result);
  result.dof = seen.size() - result.rank;
  return result;
}

void SetResiduals(const FreeformSettings& bench, const std::vector<PoseRead>& poses, Identification& found) {
  const Eigen::Matrix3Xd left = Residual(bench, poses, found.unknowns).reshaped(3, std::ssize(poses));
  found.residual_rms = left.rowwise().norm() / std::sqrt(static_cast<double>(poses.size()));
  found.lone = LoneIn(poses, left);
  found.residual_per_u = found.residual_rms.cwiseProduct(WeightsOf(bench, 1));
}

Identification Identify(const FreeformSettings& bench, const std::vector<PoseRead>& poses) {
  constexpr int kMostRounds = 20, kMostHalvings = 6;
  constexpr double kStill = 1e-3;     // of the noise: what the readings change in the last round, rms
  constexpr double kNoWorse = 1.001;  // rounding, once it has settled
  Identification result;
  result.setups = SetupsOf(poses);
  result.unknowns.setZero(MountingAt(result.setups, 0));
  const Eigen::VectorXd weights = WeightsOf(bench, poses.size());
  Spectrum spectrum;
  Eigen::VectorXd left = Residual(bench, poses, result.unknowns);
  while (result.rounds++ < kMostRounds && !result.converged) {
    const Eigen::MatrixXd J = Jacobian(bench, poses, result.unknowns);
    spectrum = SpectrumOf(J, weights);
    // The whole of the unknowns is kept least, not the step.
    const Eigen::VectorXd seen = weights.cwiseProduct(left + J * result.unknowns);
    Eigen::VectorXd next = spectrum.scale.cwiseProduct(Least(spectrum, seen));
    Eigen::VectorXd left_then = Residual(bench, poses, next);
    // A spot far from the middle hardly says how far: a step that leads away is shortened.
    const double norm = weights.cwiseProduct(left).norm();
    for (int half = 0; half < kMostHalvings && !(weights.cwiseProduct(left_then).norm() < kNoWorse * norm);
         ++half) {
      next = 0.5 * (next + result.unknowns);
      left_then = Residual(bench, poses, next);
    }
    const Eigen::VectorXd change = weights.cwiseProduct(J * (next - result.unknowns));
    result.converged = change.norm() < kStill * std::sqrt(static_cast<double>(change.size()));
    result.unknowns = next;
    left = left_then;
  }
  Conclude(spectrum, result);
  SetResiduals(bench, poses, result);
  result.dof = left.size() - result.rank;
  return result;
}

}  // namespace twinbench::benches::freeform::estimators
