#include "twin/benches/hob_transmission/estimators/turns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "twin/core/errors.h"
#include "twin/core/units.h"

namespace twinbench::separate::hob {
namespace {

constexpr double kRunaway_rad = 0.1;  // no gearbox is out by 6 deg; a wrapped angle is by a turn

double ValueOf(const HobSample& s, Signal signal, double ratio) {
  const double encoders_rad = s.table_encoder_rad - ratio * s.hob_encoder_rad;
  if (signal == Signal::kEncoders) return encoders_rad;
  if (signal == Signal::kInterferometer) return s.interferometer_rad;
  return encoders_rad - s.interferometer_rad;
}

std::string Where(const HobSample& s) {
  return fmt::format("mounting {}, pass {}", s.setup, s.pass);
}

void CheckSample(const HobSample& s, const Pass& pass) {
  if (std::abs(s.direction) != 1)
    throw InputError(Where(s), fmt::format("direction is {}", s.direction), "+1 or -1");
  if (!std::isfinite(s.head_rad)) throw InputError(Where(s), "the head angle is missing", "one per mounting");
  if (!pass.th_rad.empty() && s.head_rad != pass.head_rad)
    throw InputError(Where(s), "the head angle changes", "one head angle per mounting");
}

void CheckValue(const HobSample& s, double value_rad, const Pass& pass) {
  if (pass.value_rad.empty() || std::abs(value_rad - pass.value_rad.front()) < kRunaway_rad) return;
  throw InputError(Where(s), fmt::format("the signal wanders by {:.3g} rad", value_rad - pass.value_rad.front()),
                   "unwrapped angles and the ratio that was geared");
}

void Append(const HobSample& s, double value_rad, EncoderZero zero, Pass& pass) {
  CheckSample(s, pass);
  CheckValue(s, value_rad, pass);
  pass.setup = s.setup;
  pass.pass = s.pass;
  pass.direction = s.direction;
  pass.head_rad = s.head_rad;
  pass.th_rad.push_back(s.table_encoder_rad + (zero == EncoderZero::kReferenceMark ? s.head_rad : 0.0));
  pass.value_rad.push_back(value_rad);
  pass.hob_rad.push_back(s.hob_encoder_rad);
}

void CheckHeads(const std::vector<Pass>& passes) {
  for (std::size_t i = 1; i < passes.size(); ++i) {
    if (passes[i].setup == passes[i - 1].setup && passes[i].head_rad != passes[i - 1].head_rad)
      throw InputError(fmt::format("mounting {}", passes[i].setup), "the head angle changes between passes",
                       "one head angle per mounting");
  }
}

/// Half the usual way from sample to sample. Turns are cut so far ahead of their first sample: a sample that lies a whole turn
/// behind the first, as a counter's lines do, would fall on either side by rounding or noise, and an end a sample short is no turn.
double HalfStep_rad(const Pass& pass) {
  std::vector<double> steps_rad;
  for (std::size_t i = 1; i < pass.th_rad.size(); ++i) steps_rad.push_back(std::abs(pass.th_rad[i] - pass.th_rad[i - 1]));
  if (steps_rad.empty()) return 0.0;
  const auto middle = steps_rad.begin() + std::ssize(steps_rad) / 2;
  std::ranges::nth_element(steps_rad, middle);
  return 0.5 * *middle;
}

/// Turns since the pass began; a sample that jitters back over the start belongs to the first one.
int TurnOf(const Pass& pass, double th_rad, double half_step_rad) {
  const double turns = (pass.direction * (th_rad - pass.th_rad.front()) + half_step_rad) / units::turn;
  return std::max(0, static_cast<int>(std::floor(turns)));
}

Eigen::VectorXd Picked(const std::vector<double>& values, const std::vector<std::size_t>& picked) {
  Eigen::VectorXd result(std::ssize(picked));
  for (std::size_t i = 0; i < picked.size(); ++i) result[static_cast<Eigen::Index>(i)] = values[picked[i]];
  return result;
}

}  // namespace

std::vector<Pass> SortPasses(const std::vector<HobSample>& samples, const TransmissionOptions& options,
                             Signal signal) {
  std::map<std::tuple<int, int, int>, Pass> sorted;
  for (const HobSample& s : samples) {
    const double value_rad = ValueOf(s, signal, options.table_turns_per_hob_turn);
    if (!std::isfinite(s.table_encoder_rad) || !std::isfinite(value_rad)) continue;
    Append(s, value_rad, options.zero, sorted[{s.setup, -s.direction, s.pass}]);
  }
  std::vector<Pass> passes;
  passes.reserve(sorted.size());
  for (auto& [key, pass] : sorted) passes.push_back(std::move(pass));
  CheckHeads(passes);
  return passes;
}

std::vector<Turn> CutIntoTurns(const Pass& pass) {
  const double half_step_rad = HalfStep_rad(pass);
  std::map<int, std::vector<std::size_t>> samples_of;
  for (std::size_t i = 0; i < pass.th_rad.size(); ++i)
    samples_of[TurnOf(pass, pass.th_rad[i], half_step_rad)].push_back(i);
  std::vector<Turn> turns;
  for (const auto& [index, picked] : samples_of) {
    const double middle_rad = pass.th_rad.front() + pass.direction * (index + 0.5) * units::turn;
    turns.push_back({index, middle_rad, Picked(pass.th_rad, picked), Picked(pass.value_rad, picked)});
  }
  return turns;
}

}  // namespace twinbench::separate::hob
