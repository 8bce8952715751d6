#include "twin/benches/freeform_five_axis/estimators/displacement_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "twin/benches/freeform_five_axis/estimators/beliefs.h"
#include "twin/benches/freeform_five_axis/estimators/far_shifts.h"
#include "twin/benches/freeform_five_axis/estimators/tried_chain.h"
#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::benches::freeform::estimators {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// Standard deviation of readings of one pose; NaN where there are fewer than six to spare.
double RepeatOf_um(const std::vector<ShiftRead>& reads) {
  constexpr int kFewest = 6;
  std::map<std::array<double, 7>, std::vector<Eigen::Vector3d>> poses;
  for (const ShiftRead& r : reads)
    poses[{r.at_m.x(), r.at_m.y(), r.at_m.z(), r.turned_rad.x(), r.turned_rad.y(), r.turned_rad.z(), 1.0 * r.ball}]
        .push_back(r.shift_m / units::um);
  double squares = 0.0;
  int spare = 0;
  for (const auto& [pose, shifts] : poses) {
    for (int c = 0; c < 3; ++c) {
      std::vector<double> own;
      for (const Eigen::Vector3d& shift : shifts)
        if (std::isfinite(shift[c])) own.push_back(shift[c]);
      const Eigen::Map<const VectorXd> all(own.data(), std::ssize(own));
      if (own.size() < 2) continue;
      squares += (all.array() - all.mean()).square().sum();
      spare += static_cast<int>(own.size()) - 1;
    }
  }
  return spare < kFewest ? kNaN : std::sqrt(squares / spare);
}

/// What fitted terms make of one that is not: those that count.
std::vector<std::size_t> Alike(const MatrixXd& fitted, const VectorXd& term) {
  constexpr double kCounts = 0.02;  // of what it does
  if (!(term.norm() > 0.0)) return {};
  const VectorXd by = SolveLeastSquares(fitted, term);
  std::vector<std::size_t> alike;
  for (Index k = 0; k < by.size(); ++k)
    if (std::abs(by[k]) * fitted.col(k).norm() > kCounts * term.norm())
      alike.push_back(static_cast<std::size_t>(k));
  return alike;
}

/// From the first reading to the last.
std::vector<Drift> DriftOf(const Tried& tried, const ShiftSolution& used, const VectorXd& sizes, double residual_um) {
  std::map<std::string, VectorXd> weights;
  for (Index at = 0; at < std::ssize(used.of); ++at) {
    const Index k = used.of[static_cast<std::size_t>(at)];
    const PoseTerm& term = tried.terms[static_cast<std::size_t>(k)];
    if (term.kind != TermKind::kDrift) continue;
    VectorXd& own = weights.try_emplace(term.name, VectorXd::Zero(used.values.size())).first->second;
    const double over_run = 2.0 * (term.order % 2);  // of a Legendre polynomial
    own[at] = over_run * sizes[k];
  }
  std::vector<Drift> drift;
  for (const auto& [along, own] : weights)
    drift.push_back({along, own.dot(used.values), residual_um * (own.transpose() * used.inverse).norm()});
  return drift;
}

void SetTerms(const Tried& tried, double least_u_um, DisplacementFit& fit) {
  const auto [free, believed, sizes, log_likelihood] = LikelierBeliefs(tried);
  const ShiftDesign by_size{tried.design.slopes * sizes.asDiagonal(), tried.design.shifts_um, tried.design.of};
  const ShiftSolution used = SolvedFor(by_size, free, believed, 1.0);
  fit.dof = used.dof;
  fit.residual_um = used.Residual_um();
  const double by_um = std::max(fit.residual_um, least_u_um);
  for (const Index k : tried.chosen) {
    const Index at = std::ranges::find(used.of, k) - used.of.begin();
    fit.fitted.push_back({tried.terms[static_cast<std::size_t>(k)], sizes[k] * used.values[at], sizes[k] * by_um * used.u[at]});
  }
  fit.drift = DriftOf(tried, used, sizes, by_um);
  for (Drift& drift : fit.drift) drift.over_run_um *= fit.from_tool ? 1.0 : -1.0;
  const MatrixXd slopes = tried.design.slopes(Eigen::all, tried.all.of);
  for (Index k = 0; k < tried.told; ++k) {
    if (std::ranges::binary_search(tried.all.of, k)) continue;
    fit.untold.push_back({tried.terms[static_cast<std::size_t>(k)], Alike(slopes, tried.design.slopes.col(k))});
    for (const std::size_t like : fit.untold.back().looks_like)
      fit.fitted[like].looks_like.push_back(fit.untold.size() - 1);
  }
}

void SetSpectrum(const MatrixXd& slopes, DisplacementFit& fit) {
  constexpr double kNone = 1e-5;
  const VectorXd norms = slopes.colwise().norm();
  const MatrixXd white = slopes * (norms.array() > 0.0).select(norms.cwiseInverse(), 0.0).asDiagonal();
  const VectorXd values = EigenvaluesOfSymmetric(white.transpose() * white).cwiseMax(0.0).cwiseSqrt().reverse();
  fit.singular_values.assign(values.begin(), values.end());
  for (double& value : fit.singular_values) value /= values[0];
  fit.rank = std::ranges::count_if(fit.singular_values, [](double value) { return value > kNone; });
}

/// @return the highest order for which the readings are enough.
int TryAll(const Looked& looked, Tried& tried) {
  const bool has_places = std::ranges::any_of(looked.reads, [](const ShiftRead& read) { return !read.at_m.isZero(); });
  // Without levers an axis that tilts is one that moves.
  const int possible_order = has_places ? looked.settings.highest_order : 0;
  int highest_order = possible_order;
  while (!looked.Try(highest_order, possible_order, tried)) --highest_order;
  return highest_order;
}

/// Of a chain that may not be the only one, tried with all terms: whichever it is, errors of the machine are of many values.
std::vector<FarShift> FarShiftsOf(const Looked& looked, const Tried& tried, std::vector<ShiftAt>& of) {
  constexpr double kDigits_um = 0.05;
  std::vector<Index> terms = tried.chosen;
  std::ranges::copy(TermsOfKind(tried, TermKind::kDrift), std::back_inserter(terms));
  std::vector<int> kinds, readings;
  for (const ShiftAt& at : tried.design.of) {
    kinds.push_back(at.component);
    readings.push_back(static_cast<int>(at.read));
  }
  std::vector<FarShift> far;
  for (const FarRow& row : FarRows(tried.design.slopes(Eigen::all, terms), tried.design.shifts_um, kinds, readings,
                                   std::max(looked.settings.noise_m / units::um, kDigits_um))) {
    of.push_back(tried.design.of[static_cast<std::size_t>(row.row)]);
    const ShiftRead& read = looked.reads[of.back().read];
    far.push_back({read.reading, of.back().component, read.turned_rad, row.off_um, row.times});
  }
  return far;
}

/// @param tried, highest_order  As TryAll has them.
DisplacementFit FitOf(const Looked& looked, const Tried& tried, int highest_order) {
  const std::vector<ShiftRead>& reads = looked.reads;
  DisplacementFit fit;
  fit.highest_order = highest_order;
  fit.chain = tried.chain;
  fit.on_workpiece = looked.on_workpiece;
  fit.from_tool = IsFromTool(looked.settings, tried.chain);
  fit.readings = reads.size();
  fit.values = static_cast<std::size_t>(tried.design.shifts_um.size());
  fit.balls = 1 + static_cast<std::size_t>(std::ranges::max(reads, {}, &ShiftRead::ball).ball);
  fit.displaced_um = tried.design.shifts_um.norm() / std::sqrt(static_cast<double>(fit.values));
  fit.repeat_um = RepeatOf_um(reads);
  SetTerms(tried, looked.settings.noise_m / units::um, fit);
  SetSpectrum(tried.design.slopes.leftCols(tried.told), fit);
  return fit;
}

/// What hangs on which of two chains it is.
void CompareWith(const DisplacementFit& other, DisplacementFit& fit) {
  constexpr double kSame_u = 3.0;
  fit.other_chains.push_back(other.chain.topology + ": " + WordsOf(other.chain));
  for (FittedTerm& own : fit.fitted) {
    const auto same = std::ranges::find_if(other.fitted, [&own](const FittedTerm& theirs) {
      return theirs.term.name == own.term.name && theirs.term.order == own.term.order &&
             theirs.term.is_sine == own.term.is_sine;
    });
    own.hangs_on_chain |= same == other.fitted.end() || !(std::abs(same->value - own.value) <= kSame_u * own.u);
  }
}

void RequireDisplacements(const std::vector<ShiftRead>& reads) {
  constexpr double kFarthest_m = 10.0 * units::mm;  // sensors of displacements reach a millimetre or two
  for (const ShiftRead& read : reads)
    for (const double shift_m : read.shift_m)
      if (std::abs(shift_m) > kFarthest_m)
        throw InputError("readings", fmt::format("a displacement is {:.4g} mm", shift_m / units::mm),
                         "displacements, in the unit that their column says");
  std::set<int> setups;
  for (const ShiftRead& read : reads) setups.insert(read.setup);
  if (setups.size() > 1 && std::ranges::all_of(reads, [](const ShiftRead& read) { return read.at_m.isZero(0.0); }))
    throw InputError("readings", fmt::format("of {} balls none says where it stands", setups.size()),
                     "X, Y, Z of each on the table, as in --map pose_table --column 'x_mm=150' --column 'z_mm=50 + 200 * (ball - 1)'");
}

}  // namespace

std::string WordsOf(const MachineChain& chain) {
  std::string words;
  for (std::size_t k = 0; k < chain.stages.size(); ++k) {
    const bool is_carried = k > 0 && chain.stages[k].on_table == chain.stages[k - 1].on_table;
    words += fmt::format("{}{} of the {}",
                         k == 0       ? ""
                         : is_carried ? ", which carries "
                                      : ", ",
                         chain.stages[k].Letter(), chain.stages[k].on_table ? "table" : "head");
  }
  for (const RotaryStage& stage : chain.stages)
    if (stage.sense < 0.0) words += fmt::format(", {} against the right-hand rule", stage.Letter());
  return words.empty() ? "no rotary axis turns" : words;
}

DisplacementFit FitDisplacements(const DisplacementSettings& settings, const std::vector<Reading>& readings) {
  constexpr Index kFewest = 12;
  std::vector<ShiftRead> reads = ShiftsOf(readings);
  if (std::ssize(reads) < kFewest / 3)
    throw InputError("readings", fmt::format("{} of {} have a displacement", reads.size(), readings.size()),
                     fmt::format("at least {} values", kFewest));
  RequireDisplacements(reads);
  const bool is_fixed = ChainsFor(settings, reads).front().stages.empty();  // no axis turns
  const bool at_few_places = AreOnWorkpiece(reads);
  Looked looked{settings, reads,
                settings.positions == "workpiece" || is_fixed || (settings.positions == "auto" && at_few_places)};
  looked.is_rigid = looked.on_workpiece && !at_few_places;
  NumberBalls(looked.on_workpiece && at_few_places, reads);
  std::vector<Tried> chains = BestChains(looked);
  const Index values = chains.front().design.shifts_um.size();
  if (values < kFewest)
    throw InputError("readings", fmt::format("{} displacements were read", values),
                     fmt::format("at least {}", kFewest));
  int highest_order = TryAll(looked, chains.front());
  std::vector<ShiftAt> far;
  const std::vector<FarShift> left_out = FarShiftsOf(looked, chains.front(), far);
  for (const ShiftAt& at : far) reads[at.read].shift_m.setConstant(kNaN);
  if (!far.empty()) {
    chains = BestChains(looked);
    highest_order = TryAll(looked, chains.front());
  }
  DisplacementFit fit = FitOf(looked, chains.front(), highest_order);
  fit.left_out = left_out;
  for (std::size_t k = 1; k < chains.size(); ++k) {
    highest_order = TryAll(looked, chains[k]);
    CompareWith(FitOf(looked, chains[k], highest_order), fit);
  }
  return fit;
}

}  // namespace twinbench::benches::freeform::estimators
