#include "twin/benches/freeform_five_axis/estimators/beliefs.h"

#include <map>
#include <string>
#include <utility>

#include "twin/benches/freeform_five_axis/estimators/likely_sizes.h"

namespace twinbench::benches::freeform::estimators {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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

}  // namespace

std::vector<Index> TermsOfKind(const Tried& tried, TermKind kind) {
  std::vector<Index> of_kind;
  for (Index k = 0; k < std::ssize(tried.terms); ++k)
    if (tried.terms[static_cast<std::size_t>(k)].kind == kind) of_kind.push_back(k);
  return of_kind;
}

Beliefs LikelierBeliefs(const Tried& tried) {
  constexpr double kClearly = 3.0, kThoughErrorsMay = 30.0;
  Beliefs without = BeliefsOf(tried, false), with = BeliefsOf(tried, true);
  const double gain = with.log_likelihood - without.log_likelihood;
  return gain > (ShowsDrift(tried) ? kClearly : kThoughErrorsMay) ? with : without;
}

}  // namespace twinbench::benches::freeform::estimators
