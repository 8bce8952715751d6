#include "twin/benches/hob_transmission/told_orders.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>

#include "twin/benches/hob_transmission/bench.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/core/units.h"
#include "twin/diagnose/tuning.h"
#include "twin/model/course.h"

namespace twinbench::benches::hob {
namespace {

using diagnose::Cause, diagnose::ParameterEstimate;

constexpr double kAlike = 0.02;  // of its size: two waves are one, whatever the noise

const ParameterEstimate* Found(const Cause& cause, const std::string& name) {
  const auto found = std::ranges::find(cause.parameters, name, &ParameterEstimate::name);
  return found == cause.parameters.end() ? nullptr : &*found;
}

/// Periods of a frequency per turn of the hob, whose angle is more even than that of the table which it drives.
double PeriodsPerTurn(const model::Course& course, double frequency_Hz) {
  const Eigen::VectorXd since_s = course.time_s.array() - course.time_s.mean();
  const double hob_rad_s = since_s.dot(course.reference_rad) / since_s.squaredNorm();
  return units::turn * frequency_Hz / std::abs(hob_rad_s);
}

/// By how much the two waves are not the same at all readings, as a share of their size.
double Unlikeness(const model::Course& course, double periods_per_turn, double frequency_Hz) {
  const auto sum = [&](double sense) {
    std::complex<double> all;
    for (Eigen::Index i = 0; i < course.time_s.size(); ++i)
      all += std::polar(1.0, sense * periods_per_turn * course.reference_rad[i] - units::turn * frequency_Hz * course.time_s[i]);
    return std::norm(all / static_cast<double>(course.time_s.size()));
  };
  return std::sqrt(std::max(0.0, 1.0 - std::max(sum(1.0), sum(-1.0))));
}

/// Whatever can err so often per turn of the hob, and a whole number of times per turn of something.
std::vector<Cause> ErringSo(double periods_per_turn, const TransmissionSettings& train, const Cause& tone) {
  const double of_table = periods_per_turn * train.HobOrder();
  const auto is = [](double one, double other) { return std::abs(one - other) < 1e-6 * other; };
  const auto is_whole = [&](double order) { return order > 2.5 && is(std::round(order), order); };
  std::vector<Cause> all;
  const auto add = [&](const char* effect, const char* where, double factor, std::optional<double> order = {}) {
    Cause& one = all.emplace_back();
    one.effect = effect;
    one.where = where;
    if (order) one.parameters.push_back({.name = "order", .unit = "1", .value = *order});
    if (const ParameterEstimate* const amplitude = Found(tone, "amplitude")) {
      one.parameters.push_back(*amplitude);
      one.parameters.back().value *= factor;
      one.parameters.back().u *= factor;
    }
  };
  if (is(of_table, train.gear_teeth)) add("gear_mesh", "", 1.0);
  if (is(of_table, train.WormOrder())) add("worm", "", 1.0);
  if (is(periods_per_turn, 1.0)) add("hob_runout", "", 1.0);
  if (is_whole(of_table)) add("periodic", "table", 1.0, std::round(of_table));
  if (is_whole(periods_per_turn)) add("periodic", "hob", train.HobOrder(), std::round(periods_per_turn));
  return all;
}

/// The nearest of the counts that anything errs by: whole numbers per turn of the hob, and per turn of the table.
std::vector<double> WholeNear(double periods_per_turn, const TransmissionSettings& train) {
  const double of_table = std::round(periods_per_turn * train.HobOrder());
  std::vector<double> whole = {std::round(periods_per_turn), of_table / train.HobOrder()};
  if (train.WormOrder() > 0.0) whole.push_back(train.WormOrder() / train.HobOrder());
  return whole;
}

bool IsListed(const std::vector<Cause>& causes, const Cause& one) {
  return std::ranges::any_of(causes, [&](const Cause& c) { return c.effect == one.effect && c.where == one.where; });
}

/// All that errs like the tone; empty: nothing does, or the run tells them.
std::vector<Cause> AlikeInAngle(const Cause& tone, const model::Course& course, const TransmissionSettings& train,
                                double frequency_Hz) {
  constexpr double kClearly = 0.2;  // of its size, whatever the noise
  const double seen = std::isfinite(tone.rho) && tone.rho > 0.0 ? diagnose::tuning::kBaarda / tone.rho : kClearly;
  std::vector<Cause> alike;
  for (const double whole : WholeNear(PeriodsPerTurn(course, frequency_Hz), train)) {
    if (!(whole > 0.0) || Unlikeness(course, whole, frequency_Hz) > std::clamp(seen, kAlike, kClearly)) continue;
    for (Cause& one : ErringSo(whole, train, tone)) {
      if (!IsListed(alike, one)) alike.push_back(std::move(one));
    }
  }
  return alike;
}

/// One thing with several names: each is as probable as the others.
void NameTogether(std::vector<Cause>& group) {
  const double share = group.front().probability / static_cast<double>(group.size());
  for (Cause& one : group) {
    one.probability = share;
    one.log_evidence = group.front().log_evidence;
    one.rho = group.front().rho;
    for (const Cause& other : group)
      if (&other != &one) one.indistinguishable_from.push_back({other.effect, other.where, 1.0});
    one.next_measurement = NextMeasurement("tone", "periodic");
  }
}

}  // namespace

void TellOrdersOfTones(const std::vector<Reading>& samples, const Scenario& scenario, diagnose::Diagnosis& diagnosis) {
  if (samples.size() < 3) return;
  const model::Course course = model::CourseOf(samples);
  const TransmissionSettings& train = HobOf(scenario).transmission;
  std::vector<Cause> told;
  for (const Cause& cause : diagnosis.causes) {
    const ParameterEstimate* const frequency = cause.effect == "tone" ? Found(cause, "frequency") : nullptr;
    std::vector<Cause> group = {cause};
    if (frequency != nullptr) {
      const double of_hob = PeriodsPerTurn(course, frequency->value);
      for (Cause& alike : AlikeInAngle(cause, course, train, frequency->value))
        if (!IsListed(diagnosis.causes, alike)) group.push_back(std::move(alike));
      if (group.size() > 1) {
        NameTogether(group);
        if (diagnosis.verdict == diagnose::Verdict::kNamed) diagnosis.verdict = diagnose::Verdict::kTie;
      } else if (Unlikeness(course, of_hob, frequency->value) < kAlike) {
        diagnosis.notes.push_back(
            fmt::format("all readings are of one speed, where a tone of {:.5g} Hz may as well be an error of order {:.4g} of "
                        "the table's turn or {:.4g} of the hob's",
                        frequency->value, of_hob * train.HobOrder(), of_hob));
      }
    }
    std::ranges::move(group, std::back_inserter(told));
  }
  diagnosis.causes = std::move(told);
}

}  // namespace twinbench::benches::hob
