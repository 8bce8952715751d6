#include "twin/benches/rotary_4dof/estimators/separability.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/rotary_4dof/estimators/lost_components.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"

namespace twinbench::separate {
namespace {

constexpr double kNullTolerance = 1e-7;  // of the largest singular value of the block

/// cos and sin of one order over the grid, each of unit length; order 0 and n/2 have the cosine only.
struct OrderBasis {
  int order = 0;
  int parts = 2;
  double cos_scale = 1.0;  // length of the sampled cosine: sqrt(n/2), or sqrt(n) when alone

  OrderBasis(int m, int n)
      : order(m), parts(m == 0 || 2 * m == n ? 1 : 2), cos_scale(std::sqrt(static_cast<double>(n) / parts)) {}
};

/// How cos and sin of the reference's index angle look over the target's: psi = sigma - phi.
Eigen::Matrix2d Mirror(double sigma_rad) {
  const double c = std::cos(sigma_rad), s = std::sin(sigma_rad);
  return (Eigen::Matrix2d() << c, s, s, -c).finished();
}

/// Writes one set-up's rows: motion d, part p at row (4 setup + d) parts + p.
void FillSeries(const Design& design, int setup, const OrderBasis& basis, Eigen::MatrixXd& block) {
  const SetUp& s = design.setups[static_cast<std::size_t>(setup)];
  const auto d = SeriesCoefficients(design, s);
  const Eigen::Matrix2d mirror = Mirror(basis.order * s.shift * design.Step_rad());
  for (int k = 0; k < kSeries; ++k) {
    const Eigen::Matrix2d turn = k < kTargetSeries ? Eigen::Matrix2d::Identity() : mirror;
    for (int dof = 0; dof < measure::kDofs; ++dof) {
      block.block((measure::kDofs * setup + dof) * basis.parts, k * basis.parts, basis.parts, basis.parts) =
          d(dof, k) * turn.topLeftCorner(basis.parts, basis.parts);
    }
  }
}

/// The seat's readings are a cos + b sin over the grid: the coefficients at phi = 0 and a quarter turn.
void FillSeat(const Design& design, int setup, const OrderBasis& basis, int column, Eigen::MatrixXd& block) {
  const Matrix4 at_cos = SeatCoefficients(design, design.target_offset_rad);
  const Matrix4 at_sin = SeatCoefficients(design, design.target_offset_rad + units::kPi / 2.0);
  for (int dof = 0; dof < measure::kDofs; ++dof) {
    const int row = (measure::kDofs * setup + dof) * basis.parts;
    block.block(row, column, 1, kSeatUnknowns) = basis.cos_scale * at_cos.row(dof);
    if (basis.parts == 2) block.block(row + 1, column, 1, kSeatUnknowns) = basis.cos_scale * at_sin.row(dof);
  }
}

/// The block of one order and, for its constants, the columns of Design they belong to.
struct Block {
  Eigen::MatrixXd d;
  std::vector<int> constant_columns;
};

void AddConstants(Block& block, int first_column) {
  block.d.conservativeResize(Eigen::NoChange, block.d.cols() + 4);
  block.d.rightCols(4).setZero();
  for (int k = 0; k < 4; ++k) block.constant_columns.push_back(first_column + k);
}

Block OrderBlock(const Design& design, const OrderBasis& basis) {
  const int setups = static_cast<int>(design.setups.size());
  Block block{Eigen::MatrixXd::Zero(measure::kDofs * setups * basis.parts, kSeries * basis.parts), {}};
  for (int s = 0; s < setups; ++s) FillSeries(design, s, basis, block.d);
  for (int s = 0; s < setups; ++s) {
    if (basis.order == 0) {
      AddConstants(block, design.MountColumn(s));
      block.d.block(measure::kDofs * s, block.d.cols() - 4, 4, 4) = basis.cos_scale * Matrix4::Identity();
    }
    if (basis.order == 1 && design.setups[static_cast<std::size_t>(s)].clamping == Clamping::kReseat) {
      AddConstants(block, design.SeatColumn(s));
      FillSeat(design, s, basis, static_cast<int>(block.d.cols()) - 4, block.d);
    }
  }
  return block;
}

/// Null vectors of one order, spread over the positions and put into the columns of the design.
Eigen::MatrixXd Spread(const Design& design, const OrderBasis& basis, const Block& block,
                       const Eigen::MatrixXd& null) {
  Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(design.Unknowns(), null.cols());
  for (int i = 0; i < design.n; ++i) {
    const double angle_rad = basis.order * i * design.Step_rad();
    for (int k = 0; k < kSeries; ++k) {
      auto row = spread.row(design.Column(static_cast<Series>(k), i));
      row = std::cos(angle_rad) / basis.cos_scale * null.row(k * basis.parts);
      if (basis.parts == 2) row += std::sin(angle_rad) / basis.cos_scale * null.row(k * basis.parts + 1);
    }
  }
  for (std::size_t c = 0; c < block.constant_columns.size(); ++c) {
    spread.row(block.constant_columns[c]) = null.row(kSeries * basis.parts + static_cast<int>(c));
  }
  return spread;
}

void Append(Eigen::MatrixXd& all, const Eigen::MatrixXd& more) {
  all.conservativeResize(more.rows(), all.cols() + more.cols());
  all.rightCols(more.cols()) = more;
}

}  // namespace

Separability FindSeparability(const Design& design) {
  Separability result;
  std::vector<OrderNull> nulls;
  result.null_space.resize(design.Unknowns(), 0);
  for (int m = 0; 2 * m <= design.n; ++m) {
    const OrderBasis basis(m, design.n);
    const Block block = OrderBlock(design, basis);
    const Eigen::MatrixXd null = NullSpaceOf(block.d, kNullTolerance);
    nulls.push_back({m, basis.parts, null.topRows(kSeries * basis.parts)});
    if (null.cols() > 0) Append(result.null_space, Spread(design, basis, block, null));
  }
  result.lost = ListLostComponents(nulls);
  return result;
}

}  // namespace twinbench::separate
