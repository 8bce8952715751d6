#include "twin/benches/encoder_comparison/diagnosis/large_causes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "twin/benches/encoder_comparison/diagnosis/families.h"
#include "twin/benches/encoder_comparison/diagnosis/large_search.h"
#include "twin/benches/encoder_comparison/diagnosis/stop_errors.h"
#include "twin/benches/encoder_comparison/diagnosis/twin_fit.h"

namespace twinbench::diagnose::encoder {
namespace {

/// Large or not.
std::ptrdiff_t LoopsIn(const LargeCauses& large) {
  const Searched& last = large.Last();
  return std::ranges::count_if(large.causes, [&](const LargeCause& cause) { return IsLoop(cause.effect.name); }) +
         std::ranges::count_if(last.analysis.found.terms, [&](const Term& term) {
           return IsLoop(last.families[static_cast<std::size_t>(term.family)].effect);
         });
}

/// Free numbers of all that has a name.
double NamedNumbers(const LargeCauses& large) {
  std::size_t numbers = MovableOf(large.causes).size();
  const Searched& last = large.Last();
  for (const Term& term : last.analysis.found.terms) {
    if (last.families[static_cast<std::size_t>(term.family)].kind != Kind::kNamed) continue;
    numbers += static_cast<std::size_t>(term.shape.size() + term.amplitudes.size());
  }
  return static_cast<double>(numbers);
}

/// Schwarz's criterion, in the noise that the better of the two leaves.
bool IsBetterNamed(const LargeCauses& a, const LargeCauses& b) {
  constexpr double kStrongly = 6.0;  // Kass and Raftery, Bayes factors (1995)
  const auto readings = static_cast<double>(a.first->encoder.run.Rows());
  const LargeCauses& better = a.named_left < b.named_left ? a : b;
  const double noise = better.memory * std::max(1.0, better.named_left / readings);
  const double more = (a.named_left - b.named_left) / noise + std::log(readings) * (NamedNumbers(a) - NamedNumbers(b));
  return more < -kStrongly;
}

/// A gap that is over before the shaft has gone over it: the device would go back, which a delay does where the shaft turns at
/// once.
bool HasCrossedTooSoon(const LargeCauses& large) {
  constexpr double kTooSoon = 0.7, kFine = 0.3;  // of the width
  const double spacing_rad = FinestSpacing_rad(large.first->encoder.context);
  const auto is_too_soon = [&](double width_rad, double way_rad) {
    return way_rad < kTooSoon * std::abs(width_rad) && spacing_rad < kFine * std::abs(width_rad);
  };
  const Searched& last = large.Last();
  return std::ranges::any_of(large.causes, [&](const LargeCause& cause) {
    return cause.effect.name == "backlash" &&
           is_too_soon(cause.effect.parameters.at("width"), cause.effect.parameters.at("crossed_over"));
  }) || std::ranges::any_of(last.analysis.found.terms, [&](const Term& term) {
    const Family& family = last.families[static_cast<std::size_t>(term.family)];
    const bool has_way = family.effect == "backlash" && family.shapes.front().name == "crossed_over";
    return has_way && is_too_soon(term.amplitudes[0], term.shape[0]);
  });
}

/// Whether a hysteresis, or that and play which is crossed gradually, takes more than that part of the way that the shaft goes.
bool LoopTakes(double part, bool also_play, const LargeCauses& large) {
  const double longest_rad = part * RangeOfSetUp_rad(large.first->encoder.context);
  const Searched& last = large.Last();
  const auto is_long = [&](const std::string& effect, const auto& way_of) {
    return (effect == "hysteresis" && way_of("settles_over") > longest_rad) ||
           (also_play && effect == "backlash" && way_of("crossed_over") > longest_rad);
  };
  return std::ranges::any_of(large.causes, [&](const LargeCause& cause) {
    return is_long(cause.effect.name, [&](const char* way) { return cause.effect.parameters.at(way); });
  }) || std::ranges::any_of(last.analysis.found.terms, [&](const Term& term) {
    const Family& family = last.families[static_cast<std::size_t>(term.family)];
    return is_long(family.effect, [&](const char* way) { return family.shapes.front().name == way ? term.shape[0] : 0.0; });
  });
}

/// A loop may stand for several causes at once that are plain: for a lag and a scale, say.
LargeCauses OrWithoutLoops(LargeCauses found, const std::vector<Reading>& readings, const Scenario& scenario,
                           DiagnoseOptions options, const model::FollowMaker& follow) {
  constexpr double kNearly = 1.02, kRoughly = 1.5;
  constexpr double kOfTravel = 0.7;  // a hysteresis that does not end within it is a scale
  constexpr double kLong = 0.1;      // over such a way a loop of stops may be play and a curve
  const bool is_endless = LoopTakes(kOfTravel, false, found);
  if (!found.first->encoder.context.Moves()) {
    if (LoopsIn(found) < 2 && !LoopTakes(kLong, true, found)) return found;
    options.excluded.insert(options.excluded.end(), {"hysteresis", kGradualPlay});
  } else if (LoopsIn(found) == 0) {
    return found;
  } else {
    options.excluded.insert(options.excluded.end(), {"backlash", "hysteresis"});
    options.excluded.emplace_back("slip");  // an onset is no plainer than a reversal
  }
  // Two loops show anything, one against the other.
  const bool is_implausible = is_endless || HasCrossedTooSoon(found) || LoopsIn(found) > 1;
  std::optional<LargeCauses> plain =
      LargeSearch(readings, scenario, options, follow, {}).Go((is_implausible ? kRoughly : kNearly) * found.left);
  return plain && (is_implausible || IsBetterNamed(*plain, found)) ? *std::move(plain) : std::move(found);
}

/// What no cause and no structure shows, in units of noise, and their free numbers.
struct AllLeft {
  double power = 0.0, numbers = 0.0;
};

AllLeft AllLeftBy(const LargeCauses& large) {
  const Searched& last = large.Last();
  const EncoderRun& encoder = large.first->encoder;
  Eigen::VectorXd rows = encoder.run.residual;
  AllLeft left{0.0, NamedNumbers(large)};
  for (const LargeCause& cause : large.causes) rows -= cause.shown;
  for (const Term& term : last.analysis.found.terms) {
    rows -= term.columns * term.amplitudes;
    const bool is_named = last.families[static_cast<std::size_t>(term.family)].kind == Kind::kNamed;
    if (!is_named) left.numbers += static_cast<double>(term.amplitudes.size()) + 1.0;  // and where it is, or of what order
  }
  left.power = encoder.BesideSetUps(rows).cwiseQuotient(encoder.run.sigma).squaredNorm();
  return left;
}

/// Counts that are lost once a turn and come back are a scale, and a turn that is put right, and what these leave.
LargeCauses OrWithoutScale(LargeCauses found, const std::vector<Reading>& readings, const Scenario& scenario,
                           DiagnoseOptions options, const model::FollowMaker& follow) {
  const Searched& last = found.Last();
  const auto is_found = [&](const char* effect) {
    return std::ranges::any_of(found.causes, [&](const LargeCause& cause) { return cause.effect.name == effect; }) ||
           std::ranges::any_of(last.analysis.found.terms, [&](const Term& term) {
             return last.families[static_cast<std::size_t>(term.family)].effect == effect;
           });
  };
  if (!is_found("scale") || !is_found("lost counts")) return found;
  options.excluded.emplace_back("scale");
  LargeCauses plain = *LargeSearch(readings, scenario, options, follow, {}).Go();
  const AllLeft with = AllLeftBy(found), without = AllLeftBy(plain);
  const double rows = static_cast<double>(found.first->encoder.run.Rows());
  const double more = rows * std::log(without.power / with.power) + std::log(rows) * (without.numbers - with.numbers);
  return more < 0.0 ? std::move(plain) : std::move(found);
}

/// A scale that errs, where a straight line leaves little of what is seen at some targets: these have then no more
/// errors of their own than lie beside it. How well it is known is a matter of the targets, not of the readings.
std::optional<LargeCause> LineThroughTargets(const TwinFit& fit, Eigen::Index targets) {
  constexpr double kLittle = 0.1;
  const LinearRun& run = fit.Run().run;
  const auto family = std::ranges::find(fit.Families(), "scale", &Family::effect);
  if (family == fit.Families().end()) return {};
  const FittedCauses line =
      fit.Fit({LedBy({CauseFrom(*family, 0, run.residual, run.sigma, fit.projector())}, 0, run.bench)});
  const double all = fit.PowerOf(run.residual);
  if (line.causes.empty() || line.power > kLittle * all) return {};
  LargeCause scale = line.causes.front();
  scale.explained = all - line.power;
  scale.shown = fit.Shown({scale.effect});
  const double more = std::sqrt(static_cast<double>(run.Rows()) / static_cast<double>(targets));
  for (auto& [parameter, u] : scale.effect.finding.u) u *= more;
  for (ParameterEstimate& p : scale.causes.front().parameters) p.u *= more;
  return IsHeld(scale.effect) ? std::optional(std::move(scale)) : std::nullopt;
}

/// With the errors of the targets free beside a scale that is held: what it shows is told of the readings as they
/// are.
LargeCauses BesideLine(LargeCause line, LargeCauses plain, LargeCauses found) {
  if (!found.last) found.last = std::move(found.first);
  found.first = std::move(plain.first);
  found.causes.insert(found.causes.begin(), std::move(line));
  return found;
}

}  // namespace

LargeCauses FindLargeCauses(const std::vector<Reading>& readings, const Scenario& scenario,
                            const DiagnoseOptions& options, const model::FollowMaker& follow) {
  LargeCauses plain = OrWithoutLoops(*LargeSearch(readings, scenario, options, follow, {}).Go(), readings, scenario,
                                     options, follow);
  plain = OrWithoutScale(std::move(plain), readings, scenario, options, follow);
  const Eigen::MatrixXd targets = Targets(plain.first->encoder.context);
  if (targets.size() == 0 || !LeaveErrorsOfTargets(plain, targets)) return plain;
  const Eigen::MatrixXd few = TargetsThatStandOut(plain.first->encoder, targets);
  if (few.cols() == 0) return plain;
  if (few.cols() < targets.cols()) return *LargeSearch(readings, scenario, options, follow, few).Go();
  const TwinFit fit(plain, scenario, follow);
  std::optional<LargeCause> line = LineThroughTargets(fit, targets.cols());
  if (!line) return *LargeSearch(readings, scenario, options, follow, targets).Go();
  const Scenario with_line = fit.With({line->effect});
  DiagnoseOptions others = options;
  others.excluded.emplace_back("scale");
  LargeCauses found = *LargeSearch(readings, with_line, others, follow, targets).Go();
  return BesideLine(*std::move(line), std::move(plain), std::move(found));
}

}  // namespace twinbench::diagnose::encoder
