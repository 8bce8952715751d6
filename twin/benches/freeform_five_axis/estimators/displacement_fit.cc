#include "twin/benches/freeform_five_axis/estimators/displacement_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "twin/benches/freeform_five_axis/estimators/far_shifts.h"
#include "twin/benches/freeform_five_axis/estimators/likely_sizes.h"
#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::benches::freeform::estimators {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// One of the displacements read: which reading, and x, y or z.
struct ShiftAt {
  std::size_t read = 0;
  int component = 0;
};

/// Displacements one below the other, with what every term makes of them.
struct ShiftDesign {
  MatrixXd slopes;
  VectorXd shifts_um;
  std::vector<ShiftAt> of;
};

Eigen::Matrix3d AlongFrame(const std::string& frame, const PosePlace& place) {
  return frame == "table"  ? place.table
         : frame == "tool" ? place.head
                           : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

bool IsFromTool(const DisplacementSettings& settings, const MachineChain& chain) {
  return settings.seen_from == "auto" ? chain.HasTable() && !chain.HasHead() : settings.seen_from == "tool";
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

/// Least squares over some of the terms.
struct ShiftSolution {
  std::vector<Index> of;
  VectorXd values, u;  // u: of a residual of 1 um
  MatrixXd inverse;    // from shifts, and beliefs, to values
  double squares_um2 = 0.0;
  Index dof = 0;

  double Residual_um() const { return std::sqrt(squares_um2 / static_cast<double>(std::max<Index>(1, dof))); }
};

/// Degrees of freedom: values less those of the terms, of a believed one the part that the readings tell.
/// @param believed, size  Terms whose values are thought to be about zero with this standard deviation, by the
/// residual.
ShiftSolution SolvedFor(const ShiftDesign& design, std::vector<Index> free, const std::vector<Index>& believed = {},
                        double size = 0.0) {
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

/// A chain at its poses, and what its terms make of the readings.
struct Tried {
  MachineChain chain;
  ChainAtPoses at;
  std::vector<PoseTerm> terms;
  ShiftDesign design;
  std::vector<Index> chosen;
  ShiftSolution all;
  Index told = 0;  // terms; those behind them are beyond what the poses tell

  double Residual_um() const { return all.Residual_um(); }
};

/// What of the settings and the readings decides how a chain is looked at.
struct Looked {
  const DisplacementSettings& settings;
  const std::vector<ShiftRead>& reads;
  bool on_workpiece = false, is_rigid = false;

  ChainAtPoses At(const MachineChain& chain) const {
    return on_workpiece ? ByWorkpiece(chain, reads, settings.tool_m) : BySlides(chain, reads);
  }
  /// @return nothing if it has too many unknowns for the readings.
  bool Try(int highest_order, int possible_order, Tried& tried) const {
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
};

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

/// Chains whose set-up, locations and squareness leave least: the usual one first, and all that are not clearly
/// worse than the best.
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

std::vector<Index> TermsOfKind(const Tried& tried, TermKind kind) {
  std::vector<Index> of_kind;
  for (Index k = 0; k < std::ssize(tried.terms); ++k)
    if (tried.terms[static_cast<std::size_t>(k)].kind == kind) of_kind.push_back(k);
  return of_kind;
}

/// What terms that fall by their order make.
MatrixXd FallingSlopes(const Tried& tried, const std::vector<Index>& terms) {
  MatrixXd slopes = tried.design.slopes(Eigen::all, terms);
  for (Index k = 0; k < slopes.cols(); ++k)
    slopes.col(k) /= tried.terms[static_cast<std::size_t>(terms[static_cast<std::size_t>(k)])].order;
  return slopes;
}

/// How large components are, by residuals, those of each axis alike but for the order, by which they fall; beside
/// those of the other axes that are told. Of others than components 0.
VectorXd SizesOf(const Tried& tried, const std::vector<Index>& free, const std::vector<Index>& components) {
  const auto term = [&tried](Index k) -> const PoseTerm& { return tried.terms[static_cast<std::size_t>(k)]; };
  VectorXd sizes = VectorXd::Zero(std::ssize(tried.terms));
  for (const char axis : {'X', 'Y', 'Z', 'A', 'B', 'C'}) {
    std::vector<Index> beside = free, own;
    for (const Index k : components)
      if (term(k).name.back() == axis) own.push_back(k);
    for (const Index k : tried.chosen)
      if (term(k).kind == TermKind::kComponent && term(k).name.back() != axis) beside.push_back(k);
    const double size =
        LikelySize(tried.design.slopes(Eigen::all, beside), FallingSlopes(tried, own), tried.design.shifts_um);
    for (const Index k : own) sizes[k] = size / term(k).order;
  }
  return sizes;
}

/// A component at one order is a group: one that is large stands among many that are not.
std::vector<int> GroupsOf(const Tried& tried, const std::vector<Index>& believed) {
  std::map<std::pair<std::string, int>, int> numbers;
  std::vector<int> groups;
  for (const Index k : believed) {
    const PoseTerm& term = tried.terms[static_cast<std::size_t>(k)];
    groups.push_back(numbers.try_emplace({term.name, term.order}, static_cast<int>(numbers.size())).first->second);
  }
  return groups;
}

/// What is taken as it comes, and what is thought to be about zero, with how large it may be.
struct Beliefs {
  std::vector<Index> free, believed;
  VectorXd sizes;  // of all terms, in residuals; of free ones 1
  double log_likelihood = 0.0;
};

/// All components, those too that the poses do not tell apart, are thought to be as large as the readings make
/// likely, and drifts if there are any.
Beliefs BeliefsOf(const Tried& tried, bool has_drift) {
  Beliefs beliefs;
  for (const Index k : tried.chosen)
    if (tried.terms[static_cast<std::size_t>(k)].kind != TermKind::kComponent) beliefs.free.push_back(k);
  beliefs.believed = TermsOfKind(tried, TermKind::kComponent);
  const std::vector<Index> drifts = has_drift ? TermsOfKind(tried, TermKind::kDrift) : std::vector<Index>();
  std::vector<Index> beside = beliefs.free;
  beside.insert(beside.end(), drifts.begin(), drifts.end());
  beliefs.sizes = SizesOf(tried, beside, beliefs.believed);
  const double drift = LikelySize(tried.design.slopes(Eigen::all, tried.chosen), FallingSlopes(tried, drifts), tried.design.shifts_um);
  for (const Index k : drifts) beliefs.sizes[k] = drift / tried.terms[static_cast<std::size_t>(k)].order;
  beliefs.believed.insert(beliefs.believed.end(), drifts.begin(), drifts.end());
  const auto [own, log_likelihood] = LikelySizes(
      tried.design.slopes(Eigen::all, beliefs.free), tried.design.slopes(Eigen::all, beliefs.believed),
      GroupsOf(tried, beliefs.believed), beliefs.sizes(beliefs.believed), tried.design.shifts_um);
  beliefs.log_likelihood = log_likelihood;
  beliefs.sizes.setOnes();
  beliefs.sizes(beliefs.believed) = own;
  return beliefs;
}

/// Whether there is what a drift does and no error that is told.
bool ShowsDrift(const Tried& tried) {
  constexpr double kSurely = 2.0;  // by chance one run in fifty
  return LikelySize(tried.design.slopes(Eigen::all, tried.chosen), FallingSlopes(tried, TermsOfKind(tried, TermKind::kDrift)),
                    tried.design.shifts_um, kSurely) > 0.0;
}

/// With a drift if the readings are clearly likelier so; far more where errors of the machine may do the same.
Beliefs LikelierBeliefs(const Tried& tried) {
  constexpr double kClearly = 3.0, kThoughErrorsMay = 30.0;
  Beliefs without = BeliefsOf(tried, false), with = BeliefsOf(tried, true);
  const double gain = with.log_likelihood - without.log_likelihood;
  return gain > (ShowsDrift(tried) ? kClearly : kThoughErrorsMay) ? with : without;
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

/// Of a chain that may not be the only one: whichever it is, errors of the machine are of many values.
std::vector<FarShift> FarShiftsOf(const Looked& looked, Tried tried, std::vector<ShiftAt>& of) {
  constexpr double kDigits_um = 0.05;
  TryAll(looked, tried);
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

DisplacementFit FitOf(const Looked& looked, Tried& tried) {
  const std::vector<ShiftRead>& reads = looked.reads;
  DisplacementFit fit;
  fit.highest_order = TryAll(looked, tried);
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
  std::vector<ShiftAt> far;
  const std::vector<FarShift> left_out = FarShiftsOf(looked, chains.front(), far);
  for (const ShiftAt& at : far) reads[at.read].shift_m.setConstant(kNaN);
  if (!far.empty()) chains = BestChains(looked);
  DisplacementFit fit = FitOf(looked, chains.front());
  fit.left_out = left_out;
  for (std::size_t k = 1; k < chains.size(); ++k) CompareWith(FitOf(looked, chains[k]), fit);
  return fit;
}

}  // namespace twinbench::benches::freeform::estimators
