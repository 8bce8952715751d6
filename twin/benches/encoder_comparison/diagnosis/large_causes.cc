#include "twin/benches/encoder_comparison/diagnosis/large_causes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "twin/benches/encoder_comparison/diagnosis/large_search.h"
#include "twin/benches/encoder_comparison/diagnosis/part_of_readings.h"
#include "twin/benches/encoder_comparison/diagnosis/stop_errors.h"

namespace twinbench::diagnose::encoder {
namespace {

/// What stays behind on a reversal, with a course of its own behind it.
constexpr std::array kLoops = {"backlash", "hysteresis"};

/// Large or not.
bool HasLoop(const LargeCauses& large) {
  const auto is_loop = [](const std::string& effect) { return std::ranges::count(kLoops, effect) > 0; };
  const Searched& last = large.Last();
  return std::ranges::any_of(large.causes, [&](const LargeCause& cause) { return is_loop(cause.effect.name); }) ||
         std::ranges::any_of(last.analysis.found.terms, [&](const Term& term) {
           return is_loop(last.families[static_cast<std::size_t>(term.family)].effect);
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

/// On the move a loop may stand for several causes at once that are plain: for a lag and a scale, say.
LargeCauses OrWithoutLoops(LargeCauses found, const std::vector<Reading>& readings, const Scenario& scenario,
                           DiagnoseOptions options, const model::FollowMaker& follow) {
  constexpr double kNearly = 1.02;
  if (!HasLoop(found) || !found.first->encoder.context.Moves()) return found;
  options.excluded.insert(options.excluded.end(), kLoops.begin(), kLoops.end());
  options.excluded.emplace_back("slip");  // an onset is no plainer than a reversal
  std::optional<LargeCauses> plain = LargeSearch(readings, scenario, options, follow, {}).Go({}, kNearly * found.left);
  return plain && IsBetterNamed(*plain, found) ? *std::move(plain) : std::move(found);
}

}  // namespace

LargeCauses FindLargeCauses(const std::vector<Reading>& readings, const Scenario& scenario,
                            const DiagnoseOptions& options, const model::FollowMaker& follow) {
  const std::vector<Reading> part = PartOf(readings);
  std::vector<LargeCause> known;
  if (part.size() < readings.size()) known = LargeSearch(part, scenario, options, follow, {}).Look();
  LargeCauses plain = OrWithoutLoops(*LargeSearch(readings, scenario, options, follow, {}).Go(known), readings, scenario,
                                     options, follow);
  const Eigen::MatrixXd targets = Targets(plain.first->encoder.context);
  if (targets.size() == 0 || !LeaveErrorsOfTargets(plain, targets)) return plain;
  return *LargeSearch(readings, scenario, options, follow, targets).Go(known);
}

}  // namespace twinbench::diagnose::encoder
