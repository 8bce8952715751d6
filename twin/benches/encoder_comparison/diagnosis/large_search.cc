#include "twin/benches/encoder_comparison/diagnosis/large_search.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/diagnosis/families.h"
#include "twin/benches/encoder_comparison/diagnosis/target_curve.h"
#include "twin/benches/encoder_comparison/diagnosis/wander.h"
#include "twin/core/linear_algebra.h"
#include "twin/diagnose/conclusion.h"
#include "twin/diagnose/engine/answer.h"

namespace twinbench::diagnose::encoder {
namespace {

/// A device whose signals err says where they begin.
void TellSignalZero(const std::vector<EffectSettings>& effects, DeviceSettings& device) {
  for (const EffectSettings& effect : effects) {
    const auto zero = effect.parameters.find("zero");
    if (zero == effect.parameters.end() || device.signal_zero_known) continue;
    device.signal_zero_rad += zero->second;
    device.signal_zero_known = true;
  }
}

/// Errors of targets may be anything. What goes by the angle is one number at a target, and theirs: along what a reference's own
/// noise makes of a target it would be fitted to that noise, at any size.
void LeaveTargetsFree(const Eigen::MatrixXd& targets, EncoderRun& encoder) {
  encoder.targets = targets;
  if (targets.cols() > 0) {
    SignalContext& c = encoder.context;
    const Eigen::VectorXd is_at_one = targets.rowwise().sum();
    const Eigen::VectorXd aside_rad = is_at_one.cwiseProduct(c.reference_rad) - targets * AtTargets(targets, c.reference_rad);
    c.reference_rad -= aside_rad;
    c.device_rad -= aside_rad;
  }
  Nuisance& nuisance = encoder.run.nuisance;
  const double precision = nuisance.prior_precision[0];
  AskedAgain any;
  any.slopes = targets;
  any.sd = Eigen::VectorXd::Constant(targets.cols(), 1.0 / std::sqrt(precision));
  if (targets.cols() > 0) LeaveFree(any, nuisance);
}

/// Rows of each column without the offsets of the set-ups.
Eigen::MatrixXd BesideSetUps(const EncoderRun& encoder, Eigen::MatrixXd columns) {
  for (auto column : columns.colwise()) column = encoder.BesideSetUps(column);
  return columns;
}

/// Beside parameters that are free a shape without a name that is much like what they show may have any size, and they
/// the opposite one: where it adds little to what they explain it has what they cannot show, or goes if that is next to nothing.
/// An order times the direction is a latency of a motion to and fro for the most part, over a part of a turn, and gives it back
/// whatever it explains.
/// @param free  What the parameters of the large causes show.
void LeaveSharedToLarge(const Eigen::MatrixXd& free, const std::vector<LargeCause>& causes, Searched& searched) {
  constexpr double kMuchAlike = 0.5, kAlikeInPart = 0.9, kNothingOwn = 0.1, kLittle = 0.05;
  const bool is_part = LeastOrder(searched.encoder.context) > 1;
  if (free.cols() == 0) return;
  double explained = 0.0;
  for (const LargeCause& cause : causes) explained += cause.explained;
  const Eigen::MatrixXd slopes = BesideSetUps(searched.encoder, free);
  std::erase_if(searched.analysis.found.terms, [&](Term& term) {
    const Family& family = searched.families[static_cast<std::size_t>(term.family)];
    const bool is_little = term.explained < kLittle * explained, is_by_direction = is_part && family.effect == "direction harmonic";
    if (family.kind != Kind::kUnknown || !(is_little || is_by_direction)) return false;
    const Eigen::MatrixXd shown = BesideSetUps(searched.encoder, term.columns);
    Eigen::MatrixXd own = shown;
    for (auto column : own.colwise()) column -= slopes * SolveShortest(slopes, Eigen::VectorXd(column));
    const double share = (own * term.amplitudes).norm() / (shown * term.amplitudes).norm();
    if (!(share < (is_by_direction ? kAlikeInPart : kMuchAlike))) return false;
    if (!(share > kNothingOwn)) return is_little;
    term.columns = own / share;
    term.amplitudes *= share;
    term.cov *= share * share;
    return false;
  });
}

}  // namespace

LargeSearch::LargeSearch(const std::vector<Reading>& readings, const Scenario& scenario, const DiagnoseOptions& options,
                         const model::FollowMaker& follow, const Eigen::MatrixXd& targets)
    : readings_(readings), scenario_(scenario), options_(options), follow_(follow), how_(AnalysisOptionsOf(options)) {
  large_.targets = targets;
}

std::optional<LargeCauses> LargeSearch::Go(double most_left) {
  Begin();
  if (IsNothingButWalk(large_.first->encoder.run))
    TakeLoopInWalk();
  else
    TakeSignals();
  TakeLag();
  TakeLarge();
  if (power_ - kFewCauses * kLarge * kLarge > most_left) return std::nullopt;  // what is not large has yet to be taken
  TakeOtherLag();
  while (SearchOn()) TakeLarge();
  LeaveToLarge();
  Review();
  JudgeUnsure();
  TellWhatEachShows();
  TellWhatNamesLeave();
  large_.bent = Bent();
  return std::move(large_);
}

AnalysisOptions LargeSearch::For(int most_causes) const {
  AnalysisOptions how = how_;
  how.most_causes = most_causes;
  how.largest_only = most_causes < kMostCauses;
  // Over a part of a turn low orders are the pieces of any course.
  const bool is_turn = large_.first && LeastOrder(large_.first->encoder.context) == 1;
  if (!how.largest_only && is_turn) how.most_orders = kMostOrders;
  return how;
}

void LargeSearch::Begin() {
  EncoderRun begin = BuildRun(readings_, scenario_, follow_);
  LeaveTargetsFree(large_.targets, begin);
  large_.first = SearchIn(std::move(begin), options_.excluded, For(kFewCauses));
  most_searched_ = kFewCauses;
  null_ = large_.first->analysis.null;
  how_.null = &null_;
  fit_.emplace(large_, scenario_, follow_);
  power_ = fit_->PowerOf(fit_->Run().run.residual);
  WeighWritten();
}

/// What was held until all moved together beside the rest, and is anybody's guess then, has to go.
void LargeSearch::Review() {
  constexpr int kMostRounds = 3;  // one may undo what another does
  constexpr double kGuess = 2.0;
  const auto is_guess = [](const LargeCause& cause) { return Deviations(cause.effect) < kGuess; };
  for (int round = 0; round < kMostRounds && (round == 0 || std::ranges::any_of(large_.causes, is_guess));
       ++round) {
    DropNeedless();
    EndTies();
    MoveBesideTheRest();
    for (int again = 0; again < kMostRounds && (TakeOther() || Straighten()); ++again) MoveBesideTheRest();
  }
}

/// For all that is left, where the last search ended at the first.
/// @return false if there was no need.
bool LargeSearch::SearchOn() {
  std::unique_ptr<Searched>& last = large_.last ? large_.last : large_.first;
  const bool is_as_found = last->analysis.scanner != nullptr;  // no cause has been taken since, and dropped again
  if (most_searched_ == kMostCauses || (last->analysis.found.terms.empty() && is_as_found)) return false;
  last->analysis.scanner.reset();
  last = SearchIn(std::move(last->encoder), Excluded(large_.causes), For(kMostCauses));
  LeaveSharedToLarge(slopes_, large_.causes, *last);
  most_searched_ = kMostCauses;
  return true;
}

std::vector<std::string> LargeSearch::Excluded(const std::vector<LargeCause>& causes) const {
  std::vector<std::string> excluded = ThatAreOnce(causes, EncoderOf(scenario_).device.signal_periods);
  // A name that is given away leaves its orders to no shape without one.
  if (!excluded.empty() && !IsExcluded(options_, "periodic")) excluded.push_back("harmonic");
  excluded.insert(excluded.end(), options_.excluded.begin(), options_.excluded.end());
  return excluded;
}

void LargeSearch::Accept(const AskedAgain& asked, std::vector<LargeCause> causes, int most_causes) {
  // Its signatures were for the search alone, and the next one has its own.
  (large_.last ? large_.last : large_.first)->analysis.scanner.reset();
  auto searched = SearchWith(asked, causes, For(most_causes));
  most_searched_ = most_causes;
  TakeOver(asked, causes);
  slopes_ = asked.slopes;
  power_ = fit_->PowerOf(asked.left);
  large_.causes = std::move(causes);
  large_.last = std::move(searched);
}

/// Errors of targets are free.
EncoderRun LargeSearch::RunWith(const std::vector<EffectSettings>& effects) const {
  EncoderRun encoder = BuildRun(readings_, fit_->With(effects), follow_);
  LeaveTargetsFree(large_.targets, encoder);
  return encoder;
}

std::unique_ptr<Searched> LargeSearch::SearchWith(const AskedAgain& asked, const std::vector<LargeCause>& causes,
                                     const AnalysisOptions& how) const {
  EncoderRun encoder = RunWith(asked.effects);
  LeaveFree(asked, encoder.run.nuisance);
  TellSignalZero(asked.effects, encoder.context.device);
  std::unique_ptr<Searched> searched = SearchIn(std::move(encoder), Excluded(causes), how);
  LeaveSharedToLarge(asked.slopes, causes, *searched);
  return searched;
}

}  // namespace twinbench::diagnose::encoder
