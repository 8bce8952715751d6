#include "twin/benches/encoder_comparison/diagnosis/large_search.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "twin/benches/encoder_comparison/diagnosis/families.h"
#include "twin/benches/encoder_comparison/diagnosis/loop_in_walk.h"
#include "twin/benches/encoder_comparison/diagnosis/memory.h"
#include "twin/core/linear_algebra.h"
#include "twin/diagnose/engine/answer.h"

/// Large causes, when all else is there.
namespace twinbench::diagnose::encoder {

/// What the last search found and has a name.
std::vector<Term*> LargeSearch::NamedTerms() {
  Searched& last = large_.last ? *large_.last : *large_.first;
  std::vector<Term*> named;
  for (Term& term : last.analysis.found.terms)
    if (last.families[static_cast<std::size_t>(term.family)].kind == Kind::kNamed) named.push_back(&term);
  return named;
}

/// Large causes beside what the last search found: what of it has a name is free.
LargeSearch::Beside LargeSearch::AskBeside(const std::vector<LargeCause>& causes) {
  Beside beside{{}, Eigen::MatrixXd(large_.first->encoder.run.Rows(), 0), {}};
  Eigen::VectorXd named = Eigen::VectorXd::Zero(beside.columns.rows());
  for (const Term* term : NamedTerms()) {
    named += term->columns * term->amplitudes;
    beside.columns.conservativeResize(Eigen::NoChange, beside.columns.cols() + term->columns.cols());
    beside.columns.rightCols(term->columns.cols()) = term->columns;
  }
  Nuisance free = large_.first->encoder.run.nuisance;
  const Eigen::VectorXd any = Eigen::VectorXd::Constant(beside.columns.cols(), 1.0 / std::sqrt(free.prior_precision[0]));
  LeaveFree({{}, {}, beside.columns, any}, free);
  beside.asked = fit_->Ask(causes, LeftByTerms() + named, free);
  beside.left = beside.asked.left - named;
  return beside;
}

/// How many readings say as much as one of a loop. One whose steps are seen in a walk is known by them: it has no more
/// of the memory than what goes to and fro as it does.
double LargeSearch::MemoryOfLoop(const Eigen::VectorXd& shown, const Eigen::VectorXd& left, double memory) const {
  if (!shown.allFinite() || !IsSeenInWalk(left, shown, fit_->Run().run.schedule.setup)) return memory;
  return std::clamp(MemoryAlong(fit_->WhiteOf(shown), fit_->WhiteOf(left)), 1.0, memory);
}

/// What is small was found with the parameters of the large causes free: these go to where they are best beside
/// it, and it goes with them.
void LargeSearch::MoveBesideTheRest() {
  if (large_.causes.empty()) return;
  Beside beside = AskBeside(large_.causes);
  // Against a shape that takes it back a cause may have any size: it leaves no more than there is without it.
  const Eigen::VectorXd& all = fit_->Run().run.residual;
  if (fit_->PowerOf(all - fit_->Shown(beside.asked.effects)) > fit_->PowerOf(all)) return;
  const double memory = fit_->Memory(beside.left);
  std::vector<EffectSettings>& effects = beside.asked.effects;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const bool is_loop = IsLoop(effects[k].name);
    const double more = std::sqrt(is_loop ? MemoryOfLoop(fit_->Shown(effects) - fit_->Shown(EffectsWithout(k, effects)), beside.left, memory) : memory);
    for (auto& [parameter, u] : effects[k].finding.u) u *= more;
  }
  TakeOver(beside.asked, large_.causes);
  if (beside.columns.cols() == 0) return;
  const Eigen::VectorXd weight = large_.first->encoder.run.sigma.cwiseInverse();
  const Eigen::VectorXd moved = SolveShortest(fit_->projector().Apply(weight.asDiagonal() * beside.columns), fit_->WhiteOf(beside.left));
  Eigen::Index at = 0;
  for (Term* term : NamedTerms()) {
    term->amplitudes += moved.segment(at, term->columns.cols());
    at += term->columns.cols();
  }
}

/// What no fit moves is asked again when all else is there. Whether stops were reached in their direction or straight shows
/// where the shaft turned, a matter of a few readings: of a gap that is crossed at once. An order of a part of a turn may
/// have been the next one to it.
std::vector<EffectSettings> LargeSearch::OthersLike(const EffectSettings& effect) const {
  const SignalContext& c = large_.first->encoder.context;
  std::vector<EffectSettings> others;
  if (effect.parameters.contains("approach") && !c.Moves()) {
    std::map<std::string, double>& parameters = others.emplace_back(effect).parameters;
    parameters["approach"] = parameters["approach"] > 0.5 ? 0.0 : 1.0;
    const auto way = parameters.find("crossed_over");
    if (const double spacing_rad = FinestSpacing_rad(c); way != parameters.end() && spacing_rad > 0.0)
      way->second = std::min(way->second, spacing_rad);
  }
  constexpr std::size_t kFew = 4;  // many are the pieces of a curve
  if (effect.name != "periodic" || LeastOrder(c) == 1 || large_.causes.size() > kFew) return others;
  // Over a little of a turn the next one is the same.
  const double apart = OrdersApart(c), far = std::max(2.0, std::round(0.25 * apart)), near = std::max(1.0, std::round(0.02 * apart));
  for (const double by : {-near, near, -far, far}) {
    const double order = effect.parameters.at("order") + by;
    if (order < LeastOrder(c) || order > LargestOrder(c)) continue;
    std::map<std::string, double>& parameters = others.emplace_back(effect).parameters;
    parameters["order"] = order;
    parameters["phase"] -= by * c.device_rad.mean();  // the same in the middle
  }
  return others;
}

/// Goes from one to a better one as long as there is one. @return true if there was.
bool LargeSearch::TakeOther() {
  constexpr double kLikelier = 4.0;  // of power in units of noise
  constexpr int kMostSteps = 64;
  std::vector<LargeCause> causes = large_.causes;
  std::optional<double> now;  // most have no others, and need no fit
  bool is_better = false;
  for (std::size_t k = 0; k < causes.size(); ++k) {
    for (int step = 0; step < kMostSteps; ++step) {
      const std::vector<EffectSettings> others = OthersLike(causes[k].effect);
      if (!others.empty() && !now) now = AskBeside(causes).asked.power;
      std::vector<LargeCause> best;
      for (const EffectSettings& other : others) {
        std::vector<LargeCause> with_other = causes;
        with_other[k].effect = other;
        const AskedAgain asked = AskBeside(with_other).asked;
        const double least = other.name == "periodic" ? kLikelier : kBetter;  // one order of many, but no new cause
        if (!(asked.power < *now - least)) continue;
        now = asked.power;
        TakeOver(asked, with_other);
        best = std::move(with_other);
      }
      if (best.empty()) break;
      causes = std::move(best);
      is_better = true;
    }
  }
  return is_better && TakeInstead(std::move(causes));
}

/// What others make look bent is straight beside them.
/// @return true if there was such a cause.
bool LargeSearch::Straighten() {
  constexpr double kSeen = 2.0;  // of its uncertainty
  std::vector<LargeCause> causes = large_.causes;
  bool is_changed = false;
  for (LargeCause& cause : causes) {
    std::vector<ParameterEstimate>& parameters = cause.causes.front().parameters;
    const auto needless = [](const ParameterEstimate& p) { return p.name == "curvature" && std::abs(p.value) < kSeen * p.u; };
    if (std::erase_if(parameters, needless) == 0) continue;
    cause.effect.parameters["curvature"] = 0.0;
    cause.effect.finding.u.erase("curvature");
    is_changed = true;
  }
  if (!is_changed || !(AskBeside(causes).asked.power < AskBeside(large_.causes).asked.power + kBetter)) return false;
  return TakeInstead(std::move(causes));
}

/// These in place of the large causes, and what is left beside them.
/// @return false if the twin cannot be asked for them: they are at the end of what is possible.
bool LargeSearch::TakeInstead(std::vector<LargeCause> causes) {
  const AskedAgain asked = fit_->Ask(causes);
  if (!asked.slopes.allFinite() || !asked.left.allFinite() || !asked.sd.allFinite()) return false;
  Accept(asked, std::move(causes), kMostCauses);
  LeaveToLarge();
  return true;
}

}  // namespace twinbench::diagnose::encoder
