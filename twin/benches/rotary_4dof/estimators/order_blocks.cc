#include "twin/benches/rotary_4dof/estimators/order_blocks.h"

#include <cmath>

#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"

namespace twinbench::separate {
namespace {

constexpr double kNullTolerance = 1e-7;  // of the largest singular value of the block

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

void AddConstants(OrderBlock& block, int first_column) {
  block.d.conservativeResize(Eigen::NoChange, block.d.cols() + 4);
  block.d.rightCols(4).setZero();
  for (int k = 0; k < 4; ++k) block.constant_columns.push_back(first_column + k);
}

OrderBlock BlockOfOrder(const Design& design, const OrderBasis& basis) {
  const int setups = static_cast<int>(design.setups.size());
  OrderBlock block{
      basis, Eigen::MatrixXd::Zero(measure::kDofs * setups * basis.parts, kSeries * basis.parts), {}, {}};
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
void Spread(const Design& design, const OrderBlock& block, Eigen::Ref<Eigen::MatrixXd> spread) {
  const OrderBasis& basis = block.basis;
  for (int i = 0; i < design.n; ++i) {
    const double angle_rad = basis.order * i * design.Step_rad();
    const double c = std::cos(angle_rad) / basis.cos_scale, s = std::sin(angle_rad) / basis.cos_scale;
    for (int k = 0; k < kSeries; ++k) {
      auto row = spread.row(design.Column(static_cast<Series>(k), i));
      row = c * block.null.row(k * basis.parts);
      if (basis.parts == 2) row += s * block.null.row(k * basis.parts + 1);
    }
  }
  for (std::size_t c = 0; c < block.constant_columns.size(); ++c) {
    spread.row(block.constant_columns[c]) = block.null.row(kSeries * basis.parts + static_cast<int>(c));
  }
}

}  // namespace

OrderBasis::OrderBasis(int m, int n)
    : order(m), parts(m == 0 || 2 * m == n ? 1 : 2), cos_scale(std::sqrt(static_cast<double>(n) / parts)) {}

std::vector<OrderBlock> OrderBlocks(const Design& design) {
  std::vector<OrderBlock> blocks;
  for (int m = 0; 2 * m <= design.n; ++m) {
    blocks.push_back(BlockOfOrder(design, OrderBasis(m, design.n)));
    blocks.back().null = NullSpaceOf(blocks.back().d, kNullTolerance);
  }
  return blocks;
}

Eigen::MatrixXd NullSpace(const Design& design, const std::vector<OrderBlock>& blocks) {
  Eigen::Index columns = 0;
  for (const OrderBlock& block : blocks) columns += block.null.cols();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(design.Unknowns(), columns);
  Eigen::Index at = 0;
  for (const OrderBlock& block : blocks) {
    Spread(design, block, all.middleCols(at, block.null.cols()));
    at += block.null.cols();
  }
  return all;
}

}  // namespace twinbench::separate
