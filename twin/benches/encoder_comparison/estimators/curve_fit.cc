#include "twin/benches/encoder_comparison/estimators/curve_fit.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"

namespace twinbench::separate::encoder {
namespace {

constexpr double kTurnsForSlope = 1.5;  // half a turn seen twice

/// Which columns the model has before the orders: a constant a pass, a slope for some, the velocity.
struct ModelColumns {
  std::vector<int> slope;  // of each pass; -1: none
  int velocity = -1;
  int before_orders = 0;
};

/// Sum of squares of the velocity about its mean in each pass, and about zero.
bool VelocityVaries(const PassGroup& group) {
  double about_mean = 0.0, about_zero = 0.0;
  for (const ComparedPass& pass : group.passes) {
    if (!pass.velocity_rad_s.allFinite()) return false;
    about_mean += (pass.velocity_rad_s.array() - pass.velocity_rad_s.mean()).square().sum();
    about_zero += pass.velocity_rad_s.squaredNorm();
  }
  return about_mean > 1e-4 * about_zero;  // 1 % rms
}

ModelColumns ColumnsOf(const PassGroup& group) {
  ModelColumns columns;
  columns.before_orders = static_cast<int>(group.passes.size());
  for (const ComparedPass& pass : group.passes)
    columns.slope.push_back(pass.Turns() > kTurnsForSlope ? columns.before_orders++ : -1);
  if (VelocityVaries(group)) columns.velocity = columns.before_orders++;
  return columns;
}

void FillOrders(const Eigen::VectorXd& th_rad, int first_column, Eigen::MatrixXd& rows) {
  const Eigen::Index orders = (rows.cols() - first_column) / 2;
  for (Eigen::Index i = 0; i < th_rad.size(); ++i) {
    const harmonics::Complex step = std::polar(1.0, th_rad[i]);
    harmonics::Complex power = 1.0;
    for (Eigen::Index k = 0; k < orders; ++k) {
      power *= step;
      rows(i, first_column + 2 * k) = power.real();
      rows(i, first_column + 2 * k + 1) = -power.imag();  // C = a - j b has the value Re C exp(j k th)
    }
  }
}

Eigen::MatrixXd RowsOf(const PassGroup& group, std::size_t p, const ModelColumns& columns,
                       const Eigen::VectorXd& th_rad, int highest) {
  const ComparedPass& pass = group.passes[p];
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(th_rad.size(), columns.before_orders + 2 * highest);
  rows.col(static_cast<Eigen::Index>(p)).setOnes();
  if (columns.slope[p] >= 0)
    rows.col(columns.slope[p]) = (pass.reference_rad.array() - pass.Middle_rad()) / units::turn;
  if (columns.velocity >= 0) {
    rows.col(columns.velocity) = pass.velocity_rad_s.array() - pass.velocity_rad_s.mean();
  }
  FillOrders(th_rad, columns.before_orders, rows);
  return rows;
}

struct Normal {
  ModelColumns columns;
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;
};

Normal NormalOf(const PassGroup& group, const ScaleAngles& th_rad, int highest) {
  Normal normal{ColumnsOf(group), {}, {}};
  const int unknowns = normal.columns.before_orders + 2 * highest;
  normal.matrix = Eigen::MatrixXd::Zero(unknowns, unknowns);
  normal.right = Eigen::VectorXd::Zero(unknowns);
  for (std::size_t p = 0; p < group.passes.size(); ++p) {
    const Eigen::MatrixXd rows = RowsOf(group, p, normal.columns, th_rad[p], highest);
    normal.matrix.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
    normal.right += rows.transpose() * group.passes[p].error_rad;
  }
  normal.matrix.triangularView<Eigen::StrictlyUpper>() = normal.matrix.transpose();
  return normal;
}

/// Largest variance of an order's part by unit white noise, over that of as many regular readings (2 / n); infinite
/// if the orders are not determined.
double Inflation(const Normal& normal, int order, int readings) {
  const int before = normal.columns.before_orders, unknowns = before + 2 * order;
  const auto half = InverseCholeskyFactor(normal.matrix.topLeftCorner(unknowns, unknowns));
  if (!half) return INFINITY;
  return half->rightCols(2 * order).colwise().squaredNorm().maxCoeff() * readings / 2.0;
}

void FillPasses(const ModelColumns& columns, const Eigen::VectorXd& solution, CurveFit& fit) {
  for (std::size_t p = 0; p < columns.slope.size(); ++p) {
    const int slope = columns.slope[p];
    fit.passes.push_back({solution[static_cast<Eigen::Index>(p)], slope >= 0 ? solution[slope] : kNaN});
  }
}

void FillOrders(const Normal& normal, const Eigen::VectorXd& solution, const Eigen::MatrixXd& inverse,
                CurveFit& fit) {
  const int before = normal.columns.before_orders;
  const Eigen::Index orders = (solution.size() - before) / 2;
  fit.value.resize(orders);
  for (Eigen::Index k = 0; k < orders; ++k) {
    const Eigen::Index at = before + 2 * k;
    fit.value[k] = {solution[at], solution[at + 1]};
    fit.cofactor.push_back(inverse.block<2, 2>(at, at));
  }
}

}  // namespace

int DistinctAngles(const ScaleAngles& th_rad) {
  std::set<long> seen;
  for (const Eigen::VectorXd& pass : th_rad) {
    for (const double th : pass)
      seen.insert(std::lround((th / units::turn - std::floor(th / units::turn)) * 1e4) % 10000);
  }
  return static_cast<int>(seen.size());
}

double CurveFit::RestSum2() const {
  double sum = 0.0;
  for (const Eigen::VectorXd& rest : rest_rad) sum += rest.squaredNorm();
  return sum;
}

int HighestOrder(const PassGroup& group, const ScaleAngles& th_rad, int most, double max_inflation) {
  const int readings = group.Readings(), before = ColumnsOf(group).before_orders;
  const int to_spare = (3 * readings / 4 - before) / 2;
  int order = std::max(0, std::min({most, (DistinctAngles(th_rad) - 1) / 2, to_spare}));
  if (order == 0) return 0;
  const Normal normal = NormalOf(group, th_rad, order);
  while (order > 0 && !(Inflation(normal, order, readings) <= max_inflation)) --order;
  return order;
}

CurveFit FitCurve(const PassGroup& group, const ScaleAngles& th_rad, int highest) {
  const Normal normal = NormalOf(group, th_rad, highest);
  const auto [solution, inverse] = SolveNormal(normal.matrix, normal.right);
  CurveFit fit;
  FillPasses(normal.columns, solution, fit);
  FillOrders(normal, solution, inverse, fit);
  if (normal.columns.velocity >= 0) {
    fit.lag_s = -solution[normal.columns.velocity];
    fit.lag_cofactor = inverse(normal.columns.velocity, normal.columns.velocity);
  }
  for (std::size_t p = 0; p < group.passes.size(); ++p)
    fit.rest_rad.push_back(group.passes[p].error_rad -
                           RowsOf(group, p, normal.columns, th_rad[p], highest) * solution);
  const auto passes = std::ssize(group.passes);
  fit.constant_cofactor = inverse.topLeftCorner(passes, passes).mean();
  fit.dof = group.Readings() - static_cast<int>(solution.size());
  return fit;
}

}  // namespace twinbench::separate::encoder
