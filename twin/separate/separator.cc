#include "twin/separate/separator.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>
#include <map>
#include <utility>

#include "twin/core/errors.h"
#include "twin/measure/grating_model.h"

namespace twinbench::separate {
namespace {

constexpr double kAssumedSpotNoise_m = 0.3e-6;  // starting weights if no noise is stated; residuals rescale it
constexpr double kDefective = 1e-11;            // pivot or eigenvalue, relative to the largest
constexpr double kLost = 1e-6;                  // part of a value's functional in a null direction
constexpr int kMostRounds = 4;
constexpr double kLastStep = 1e-12;  // 0.2 microarcsec, 0.1 pm

/// Lengths to kLengthUnit_m in a motion vector.
Vector4 UnitScale() {
  return {1.0, 1.0, 1.0, 1.0 / kLengthUnit_m};
}

Matrix4 ScaledCovariance(const Matrix4& cov, const Vector4& scale) {
  const Vector4 s = UnitScale().cwiseProduct(scale);
  return s.asDiagonal() * cov * s.asDiagonal();
}

/// Covariance that equal noise on all four PSD axes would give, for readings that state none.
Matrix4 AssumedCovariance(const BenchGeometry& geometry) {
  const Matrix4 inverse = measure::SpotJacobian(Vector4::Zero(), geometry).inverse();
  return kAssumedSpotNoise_m * kAssumedSpotNoise_m * inverse * inverse.transpose();
}

/// Mean covariance of each pass of a set-up. One reading's own deviation is a noisy weight (7 % for 100 samples).
std::map<std::pair<int, int>, Matrix4> PassCovariances(const std::vector<Motion>& motions, const Layout& layout) {
  std::map<std::pair<int, int>, std::pair<Matrix4, int>> sums;
  for (const Sample& sample : layout.samples) {
    const Motion& m = motions[sample.motion];
    auto& sum = sums.try_emplace({m.setup, m.pass}, Matrix4::Zero(), 0).first->second;
    sum.first += m.cov;
    ++sum.second;
  }
  std::map<std::pair<int, int>, Matrix4> means;
  for (const auto& [key, sum] : sums) means[key] = sum.first / sum.second;
  return means;
}

bool AllKnown(const std::vector<Motion>& motions, const Layout& layout) {
  for (const Sample& sample : layout.samples) {
    if (!motions[sample.motion].covariance_known) return false;
  }
  return true;
}

std::vector<Component> ComponentsOf(Table table, const std::vector<NotSeparable>& lost) {
  std::vector<Component> components = {Component::kEx, Component::kEy, Component::kEz, Component::kDx,
                                       Component::kDy};
  for (const NotSeparable& entry : lost) {
    if (entry.table != table || !entry.all) continue;
    for (const Component c : entry.components) std::erase(components, c);
  }
  return components;
}

Series SeriesOf(Table table, Component component) {
  const bool target = table == Table::kTarget;
  switch (component) {
    case Component::kEx:
      return target ? Series::kTargetEx : Series::kRefEx;
    case Component::kEy:
      return target ? Series::kTargetEy : Series::kRefEy;
    case Component::kEz:
      return target ? Series::kTargetEz : Series::kRefEz;
    case Component::kDx:
      return Series::kRefDx;
    default:
      return target ? Series::kTargetDy : Series::kRefDy;
  }
}

double Unit(Component component) {
  return IsAngle(component) ? 1.0 : kLengthUnit_m;
}

std::vector<double> Positions(const Design& design, Table table) {
  std::vector<double> position_rad;
  for (int i = 0; i < design.n; ++i) {
    position_rad.push_back(table == Table::kTarget ? design.TargetAngle_rad(i) : design.ReferenceAngle_rad(i));
  }
  return position_rad;
}

Eigen::MatrixXd Orthonormal(const Eigen::MatrixXd& columns) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
  qr.setThreshold(1e-9);
  return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), qr.rank());
}

/// P C P with P = I - Q Q^T.
Eigen::MatrixXd ProjectBothSides(const Eigen::MatrixXd& cov, const Eigen::MatrixXd& Q) {
  const Eigen::MatrixXd half = cov - Q * (Q.transpose() * cov);
  return half - (half * Q) * Q.transpose();
}

}  // namespace

Separator::Separator(const std::vector<Motion>& motions, const BenchGeometry& geometry,
                     const SeparateOptions& options, const Vector4& scale)
    : geometry_(geometry),
      cov_calibration_(options.cov_calibration),
      layout_(FindLayout(motions, geometry, options.layout)),
      separability_(FindSeparability(layout_.design)) {
  CollectCells(motions, scale);
  for (const Cell& cell : cells_) models_.push_back(ModelStop(design(), cell.setup, cell.target));
  Factorise();
  target_ = MakePart(Table::kTarget);
  reference_ = MakePart(Table::kReference);
}

void Separator::CollectCells(const std::vector<Motion>& motions, const Vector4& scale) {
  covariance_known_ = AllKnown(motions, layout_);
  const auto of_pass = PassCovariances(motions, layout_);
  const Matrix4 assumed = AssumedCovariance(geometry_);
  std::map<std::pair<int, int>, std::size_t> index;
  for (const Sample& sample : layout_.samples) {
    const Motion& m = motions[sample.motion];
    const Matrix4 cov = covariance_known_ ? of_pass.at({m.setup, m.pass}) : assumed;
    sample_cov_.push_back(ScaledCovariance(cov, scale));
    const auto [entry, is_new] = index.try_emplace({sample.setup, sample.target}, cells_.size());
    if (is_new) cells_.push_back({sample.setup, sample.target, Matrix4::Zero()});
    cell_of_.push_back(entry->second);
    cells_[entry->second].weight += sample_cov_.back().inverse();
  }
}

std::vector<bool> Separator::SupportedColumns() const {
  std::vector<bool> supported(static_cast<std::size_t>(design().Unknowns()), false);
  for (const StopModel& model : models_) {
    for (int c = 0; c < model.columns; ++c) supported[model.column[static_cast<std::size_t>(c)]] = true;
  }
  return supported;
}

void Separator::Factorise() {
  const int unknowns = design().Unknowns();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(unknowns, unknowns);
  for (std::size_t k = 0; k < cells_.size(); ++k) {
    const StopModel& model = models_[k];
    const auto d = model.d.leftCols(model.columns);
    const Eigen::MatrixXd block = d.transpose() * cells_[k].weight * d;
    for (int a = 0; a < model.columns; ++a) {
      for (int b = 0; b < model.columns; ++b) normal(model.column[a], model.column[b]) += block(a, b);
    }
  }
  // Positions nobody visited are pinned; what no complete circle can see is pinned by its null vectors, and both
  // pins are taken out of the inverse again: what is left is the minimum-norm solution.
  const double pin = normal.trace() / unknowns;
  const std::vector<bool> supported = SupportedColumns();
  Eigen::MatrixXd null = separability_.null_space;
  Eigen::VectorXd unvisited = Eigen::VectorXd::Zero(unknowns);
  for (int c = 0; c < unknowns; ++c) {
    if (supported[static_cast<std::size_t>(c)]) continue;
    null.row(c).setZero();
    unvisited[c] = pin;
  }
  if (unvisited.any()) null = Orthonormal(null);
  normal += pin * null * null.transpose();
  normal.diagonal() += unvisited;
  const Eigen::LLT<Eigen::MatrixXd> llt(normal);
  const bool sound = llt.info() == Eigen::Success && llt.rcond() > kDefective;
  extra_null_.resize(unknowns, 0);
  if (sound) inverse_ = llt.solve(Eigen::MatrixXd::Identity(unknowns, unknowns));
  if (!sound) InvertDefective(normal);
  inverse_ -= null * null.transpose() / pin;
  inverse_.diagonal() -= (unvisited.array() > 0.0).select(Eigen::VectorXd::Constant(unknowns, 1.0 / pin), 0.0);
}

void Separator::InvertDefective(const Eigen::MatrixXd& normal) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(normal);
  const Eigen::VectorXd& values = eigen.eigenvalues();
  const double least = kDefective * values.maxCoeff();
  const Eigen::Index lost = (values.array() <= least).count();
  extra_null_ = eigen.eigenvectors().leftCols(lost);
  const auto kept = eigen.eigenvectors().rightCols(values.size() - lost);
  inverse_ = kept * values.tail(values.size() - lost).cwiseInverse().asDiagonal() * kept.transpose();
}

Separator::TablePart Separator::MakePart(Table table) const {
  TablePart part;
  part.components = ComponentsOf(table, separability_.lost);
  const std::vector<bool> supported = SupportedColumns();
  for (const Component c : part.components) {
    part.series.push_back(SeriesOf(table, c));
    for (int i = 0; i < design().n; ++i) {
      part.columns.push_back(design().Column(part.series.back(), i));
      part.usable.push_back(supported[static_cast<std::size_t>(part.columns.back())]);
    }
  }
  part.removed = LostBasis(table, separability_.lost, part.components, Positions(design(), table), part.usable);
  FindLostValues(part);
  part.cov = ProjectBothSides(inverse_(part.columns, part.columns), part.removed);
  return part;
}

void Separator::FindLostValues(TablePart& part) const {
  if (extra_null_.cols() == 0) return;
  const Eigen::MatrixXd null = extra_null_(part.columns, Eigen::all);
  const Eigen::MatrixXd left = null - part.removed * (part.removed.transpose() * null);
  for (std::size_t r = 0; r < part.usable.size(); ++r) {
    if (left.row(static_cast<Eigen::Index>(r)).norm() > kLost) part.usable[r] = false;
  }
}

bool Separator::Fits(const std::vector<Motion>& motions) const {
  std::size_t used = 0;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    if (motions[i].phase != Phase::kFullCircle || motions[i].status != ReadingStatus::kOk) continue;
    if (used >= layout_.samples.size() || layout_.samples[used].motion != i) return false;
    const Sample& sample = layout_.samples[used++];
    const double steps = (motions[i].target_rad - design().TargetAngle_rad(sample.target)) / design().Step_rad();
    const SetUp& setup = design().setups[static_cast<std::size_t>(sample.setup)];
    const bool same_stop = std::abs(std::remainder(steps, design().n)) < 1e-2 && motions[i].setup == setup.label;
    if (!same_stop) return false;
  }
  return used == layout_.samples.size();
}

std::vector<Vector4> Separator::CellMeans(const std::vector<Motion>& motions) const {
  std::vector<Vector4> sums(cells_.size(), Vector4::Zero());
  for (std::size_t k = 0; k < layout_.samples.size(); ++k) {
    const Vector4 y = motions[layout_.samples[k].motion].Values().cwiseProduct(UnitScale());
    sums[cell_of_[k]] += sample_cov_[k].inverse() * y;
  }
  for (std::size_t c = 0; c < cells_.size(); ++c) sums[c] = cells_[c].weight.inverse() * sums[c];
  return sums;
}

Eigen::MatrixXd Separator::Propagate(const Eigen::MatrixXd& cell_values) const {
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(design().Unknowns(), cell_values.cols());
  for (std::size_t k = 0; k < cells_.size(); ++k) {
    const Eigen::MatrixXd weighted =
        cells_[k].weight * cell_values.middleRows<measure::kDofs>(measure::kDofs * static_cast<Eigen::Index>(k));
    for (int c = 0; c < models_[k].columns; ++c) {
      right.row(models_[k].column[c]) += models_[k].d.col(c).transpose() * weighted;
    }
  }
  return inverse_ * right;
}

Vector4 Separator::PredictCell(const Eigen::VectorXd& x, const Cell& cell) const {
  const SetUp& setup = design().setups[static_cast<std::size_t>(cell.setup)];
  const int reference = design().ReferencePosition(setup, cell.target);
  const auto at = [&](Series series, int position) { return x[design().Column(series, position)]; };
  const double L = kLengthUnit_m;
  PoseErrors errors;
  errors.target << at(Series::kTargetEx, cell.target), at(Series::kTargetEy, cell.target),
      at(Series::kTargetEz, cell.target), 0.0, L * at(Series::kTargetDy, cell.target), 0.0;
  errors.reference << at(Series::kRefEx, reference), at(Series::kRefEy, reference), at(Series::kRefEz, reference),
      L * at(Series::kRefDx, reference), L * at(Series::kRefDy, reference), 0.0;
  const Vector4 mount = x.segment<4>(design().MountColumn(cell.setup));
  errors.mount << mount[1], mount[2], mount[0], 0.0, L * mount[3], 0.0;
  if (setup.clamping == Clamping::kReseat) {
    const Vector4 seat = x.segment<4>(design().SeatColumn(cell.setup));
    errors.seat << seat[0], seat[1], 0.0, L * seat[2], L * seat[3], 0.0;
  }
  return MotionOf(GratingPose(design().StopAt(setup, cell.target), errors, geometry_)).cwiseProduct(UnitScale());
}

std::vector<Vector4> Separator::Predict(const Eigen::VectorXd& x) const {
  std::vector<Vector4> predicted;
  predicted.reserve(cells_.size());
  for (const Cell& cell : cells_) predicted.push_back(PredictCell(x, cell));
  return predicted;
}

/// Gauss-Newton with the first-order model as fixed Jacobian: each round gains a factor of the errors' size (1e-4).
Eigen::VectorXd Separator::SolveIterated(const std::vector<Vector4>& cell_means) const {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(design().Unknowns());
  for (int round = 0; round < kMostRounds; ++round) {
    const std::vector<Vector4> predicted = Predict(x);
    Eigen::VectorXd left(measure::kDofs * static_cast<Eigen::Index>(cells_.size()));
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      left.segment<4>(4 * static_cast<Eigen::Index>(k)) = cell_means[k] - predicted[k];
    }
    const Eigen::VectorXd step = Propagate(left);
    x += step;
    if (step.cwiseAbs().maxCoeff() < kLastStep) break;
  }
  return x;
}

/// d x / d (gains, rolls), from the motions' own sensitivities.
Eigen::MatrixXd Separator::SystematicColumns(const std::vector<Motion>& motions) const {
  if (cov_calibration_.isZero()) return Eigen::MatrixXd::Zero(design().Unknowns(), 0);
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(4 * static_cast<Eigen::Index>(cells_.size()), 6);
  for (std::size_t k = 0; k < layout_.samples.size(); ++k) {
    const auto& d = motions[layout_.samples[k].motion].d_calibration;
    values.middleRows<4>(4 * static_cast<Eigen::Index>(cell_of_[k])) +=
        sample_cov_[k].inverse() * UnitScale().asDiagonal() * d;
  }
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    auto rows = values.middleRows<4>(4 * static_cast<Eigen::Index>(c));
    rows = Eigen::MatrixXd(cells_[c].weight.inverse() * rows);
  }
  return Propagate(values);
}

TableEstimate Separator::Estimate(const TablePart& part, Table table, const Eigen::VectorXd& x,
                                  const Eigen::MatrixXd& systematic) const {
  const std::size_t n = static_cast<std::size_t>(design().n);
  Eigen::VectorXd unit(static_cast<Eigen::Index>(part.columns.size()));
  for (Eigen::Index r = 0; r < unit.size(); ++r) unit[r] = Unit(part.components[static_cast<std::size_t>(r) / n]);
  const auto reduce = [&part](Eigen::MatrixXd rows) -> Eigen::MatrixXd {
    return rows - part.removed * (part.removed.transpose() * rows);
  };
  TableEstimate estimate;
  estimate.components = part.components;
  estimate.cov = unit.asDiagonal() * part.cov * unit.asDiagonal();
  const Eigen::MatrixXd shift = unit.asDiagonal() * reduce(systematic(part.columns, Eigen::all));
  estimate.cov_systematic = Eigen::MatrixXd::Zero(unit.size(), unit.size());
  if (shift.cols() > 0) estimate.cov_systematic = shift * cov_calibration_ * shift.transpose();
  const Eigen::VectorXd value = unit.cwiseProduct(Eigen::VectorXd(reduce(x(part.columns))));
  estimate.value.position_rad = estimate.u.position_rad = Positions(design(), table);
  for (auto& column : estimate.value.value) column.assign(n, kNaN);
  for (auto& column : estimate.u.value) column.assign(n, kNaN);
  for (std::size_t r = 0; r < part.columns.size(); ++r) {
    if (!part.usable[r]) continue;
    const auto row = static_cast<Eigen::Index>(r);
    estimate.value[part.components[r / n]][r % n] = value[row];
    const double variance = estimate.cov(row, row) + estimate.cov_systematic(row, row);
    estimate.u[part.components[r / n]][r % n] = std::sqrt(std::max(variance, 0.0));
  }
  return estimate;
}

/// Expected sum of squared residuals over variance, by motion: samples minus the leverage of the fit.
Vector4 Separator::DegreesOfFreedom() const {
  std::vector<Vector4> fitted;  // variance of each cell's prediction
  for (const StopModel& model : models_) {
    const std::vector<int> columns(model.column.begin(), model.column.begin() + model.columns);
    const Eigen::MatrixXd d = model.d.leftCols(model.columns);
    fitted.push_back((d * inverse_(columns, columns) * d.transpose()).diagonal());
  }
  Vector4 dof = Vector4::Zero();
  for (std::size_t k = 0; k < layout_.samples.size(); ++k) {
    dof += Vector4::Ones() - fitted[cell_of_[k]].cwiseQuotient(sample_cov_[k].diagonal());
  }
  return dof;
}

void Separator::AddResiduals(const std::vector<Motion>& motions, const std::vector<Vector4>& predicted,
                             Separation& result) const {
  result.residuals.assign(motions.size(), Vector4::Constant(kNaN));
  Vector4 squares = Vector4::Zero();
  result.chi2.setZero();
  for (std::size_t k = 0; k < layout_.samples.size(); ++k) {
    const std::size_t i = layout_.samples[k].motion;
    const Vector4 r = motions[i].Values().cwiseProduct(UnitScale()) - predicted[cell_of_[k]];
    result.residuals[i] = r.cwiseQuotient(UnitScale());
    squares += result.residuals[i].cwiseAbs2();
    result.chi2 += r.cwiseAbs2().cwiseQuotient(sample_cov_[k].diagonal());
  }
  result.readings = static_cast<int>(layout_.samples.size());
  result.residual_rms = (squares / result.readings).cwiseSqrt();
  result.dof_of = DegreesOfFreedom();
  result.dof = static_cast<int>(std::lround(result.dof_of.sum()));
}

Separation Separator::Separate(const std::vector<Motion>& motions) const {
  Require(Fits(motions), "the motions have another layout than those the Separator was made for");
  const Eigen::VectorXd x = SolveIterated(CellMeans(motions));
  const Eigen::MatrixXd systematic = SystematicColumns(motions);
  Separation result;
  result.not_separable = separability_.lost;
  result.target = Estimate(target_, Table::kTarget, x, systematic);
  result.reference = Estimate(reference_, Table::kReference, x, systematic);
  for (std::size_t s = 0; s < design().setups.size(); ++s) {
    const Vector4 mount = x.segment<4>(design().MountColumn(static_cast<int>(s)));
    result.mount.push_back(mount.cwiseQuotient(UnitScale()));
  }
  AddResiduals(motions, Predict(x), result);
  return result;
}

}  // namespace twinbench::separate
