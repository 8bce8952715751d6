#include "twin/benches/freeform_five_axis/estimators/tried_chain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::benches::freeform::estimators {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

Eigen::Matrix3d AlongFrame(const std::string& frame, const PosePlace& place) {
  return frame == "table"  ? place.table
         : frame == "tool" ? place.head
                           : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

ShiftDesign DesignOf(const DisplacementSettings& settings, const MachineChain& chain,
                     const std::vector<ShiftRead>& reads, const std::vector<PosePlace>& places,
                     const std::vector<PoseTerm>& terms) {
  const double sign = IsFromTool(settings, chain) ? 1.0 : -1.0;
  ShiftDesign design{MatrixXd(3 * std::ssize(reads), std::ssize(terms)), VectorXd(3 * std::ssize(reads)), {}};
  Index rows = 0;
  for (std::size_t i = 0; i < reads.size(); ++i) {
    const Eigen::Matrix3d frame = AlongFrame(settings.frame, places[i]);
    Eigen::Matrix3Xd of_pose(3, std::ssize(terms));
    for (std::size_t k = 0; k < terms.size(); ++k)
      of_pose.col(static_cast<Index>(k)) = sign * (frame.transpose() * terms[k].slope_um(places[i]));
    for (Index c = 0; c < 3; ++c) {
      if (!std::isfinite(reads[i].shift_m[c])) continue;
      design.slopes.row(rows) = of_pose.row(c);
      design.shifts_um[rows++] = reads[i].shift_m[c] / units::um;
      design.of.push_back({i, static_cast<int>(c)});
    }
  }
  design.slopes.conservativeResize(rows, Eigen::NoChange);
  design.shifts_um.conservativeResize(rows);
  return design;
}

/// Terms of which enough is done by none before them, by Gram and Schmidt: a fiftieth of a component, less of a
/// location, for what is left of it would be taken by the others.
std::vector<Index> ChosenTerms(const MatrixXd& slopes, const std::vector<PoseTerm>& terms) {
  constexpr double kMovesNothing_um = 1e-3, kOwn = 0.02, kOwnOfLocation = 2e-3;  // by one um or arcsec, rms; shares
  MatrixXd basis(slopes.rows(), 0);
  std::vector<Index> chosen;
  for (Index k = 0; k < slopes.cols(); ++k) {
    const double norm = slopes.col(k).norm();
    if (!(norm > kMovesNothing_um * std::sqrt(static_cast<double>(slopes.rows()))) ||
        std::ssize(chosen) == slopes.rows())
      continue;
    VectorXd own = slopes.col(k) / norm;
    for (int twice = 0; twice < 2; ++twice) own -= (basis * (basis.transpose() * own)).eval();
    const bool is_component = terms[static_cast<std::size_t>(k)].kind == TermKind::kComponent;
    if (!(own.norm() > (is_component ? kOwn : kOwnOfLocation))) continue;
    chosen.push_back(k);
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.col(basis.cols() - 1) = own.normalized();
  }
  return chosen;
}

[[noreturn]] void RefusePositions(double misfit_m) {
  throw InputError(
      "readings",
      fmt::format(
          "the commanded positions are not those of a ball that two rotary axes carry: they differ by {:.3g} mm",
          misfit_m / units::mm),
      "a column that says which ball it is; --set displacement.positions=workpiece where x, y, z are those of the "
      "ball on the table, "
      "displacement.topology and displacement.axes where the machine is built otherwise");
}

/// Chains on which the commanded positions lie.
std::vector<Tried> PossibleChains(const Looked& looked) {
  constexpr double kDigits_m = 20.0 * units::um;
  std::vector<Tried> possible;
  double least_m = INFINITY;
  for (const MachineChain& chain : ChainsFor(looked.settings, looked.reads)) {
    Tried tried{chain, looked.At(chain), {}, {}, {}, {}};
    least_m = std::min(least_m, tried.at.misfit_m);
    if (tried.at.misfit_m < kDigits_m) possible.push_back(std::move(tried));
  }
  if (possible.empty()) RefusePositions(least_m);
  return possible;
}

}  // namespace

bool IsFromTool(const DisplacementSettings& settings, const MachineChain& chain) {
  return settings.seen_from == "auto" ? chain.HasTable() && !chain.HasHead() : settings.seen_from == "tool";
}

ShiftSolution SolvedFor(const ShiftDesign& design, std::vector<Index> free, const std::vector<Index>& believed,
                        double size) {
  const Index rows = design.shifts_um.size(), beliefs = size > 0.0 ? std::ssize(believed) : 0;
  ShiftSolution solution{std::move(free), {}, {}, {}};
  solution.of.insert(solution.of.end(), believed.begin(), believed.begin() + beliefs);
  MatrixXd slopes = MatrixXd::Zero(rows + beliefs, std::ssize(solution.of));
  slopes.topRows(rows) = design.slopes(Eigen::all, solution.of);
  slopes.bottomRightCorner(beliefs, beliefs).diagonal().setConstant(1.0 / size);
  VectorXd shifts_um = VectorXd::Zero(rows + beliefs);
  shifts_um.head(rows) = design.shifts_um;
  solution.inverse = PseudoInverseOf(slopes);
  solution.values = solution.inverse * shifts_um;
  solution.u = solution.inverse.rowwise().norm();
  solution.squares_um2 = (design.shifts_um - slopes.topRows(rows) * solution.values).squaredNorm();
  const double told = solution.inverse.leftCols(rows).cwiseProduct(slopes.topRows(rows).transpose()).sum();
  solution.dof = rows - static_cast<Index>(std::lround(told));
  return solution;
}

ChainAtPoses Looked::At(const MachineChain& chain) const {
  return on_workpiece ? ByWorkpiece(chain, reads, settings.tool_m) : BySlides(chain, reads);
}

bool Looked::Try(int highest_order, int possible_order, Tried& tried) const {
  constexpr double kMostUnknowns = 0.8;  // of the values
  tried.terms = TermsOf(tried.chain, tried.at.places, highest_order, possible_order, is_rigid);
  tried.told = std::ranges::count(tried.terms, false, &PoseTerm::is_beyond);
  tried.design = DesignOf(settings, tried.chain, reads, tried.at.places, tried.terms);
  tried.chosen = ChosenTerms(tried.design.slopes.leftCols(tried.told), tried.terms);
  if (static_cast<double>(tried.chosen.size()) >
      kMostUnknowns * static_cast<double>(tried.design.shifts_um.size()))
    return false;
  tried.all = SolvedFor(tried.design, tried.chosen);
  return true;
}

std::vector<Tried> BestChains(const Looked& looked) {
  constexpr double kClearly = 0.8;
  std::vector<Tried> possible = PossibleChains(looked);
  std::erase_if(possible, [&looked](Tried& tried) { return !looked.Try(0, 0, tried); });
  if (possible.empty())
    throw InputError("readings", "they are too few for the axes that turn",
                     "three readings and more at each of several poses of every axis");
  const double least_um = std::ranges::min(possible, {}, &Tried::Residual_um).Residual_um();
  std::erase_if(possible, [least_um](const Tried& tried) { return !(kClearly * tried.Residual_um() <= least_um); });
  return possible;
}

}  // namespace twinbench::benches::freeform::estimators
