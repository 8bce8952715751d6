#include "twin/benches/encoder_comparison/diagnosis/told.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/diagnose/tuning.h"
#include "twin/diagnose/unknown/collector.h"

namespace twinbench::diagnose::encoder {
namespace {

struct Step {
  double size, u;  // SI
  int at_reading;
  int counts = 0;  // signed: how many times the smallest
};

/// What all have in common.
struct Count {
  double size = kNaN, u = kNaN;
};

double ValueOf(const Cause& cause, const std::string& parameter, double ParameterEstimate::*member) {
  const auto found = std::ranges::find(cause.parameters, parameter, &ParameterEstimate::name);
  return found == cause.parameters.end() ? kNaN : (*found).*member;
}

std::vector<Step> StepsAmong(const std::vector<Cause>& causes) {
  std::vector<Step> steps;
  for (const Cause& cause : causes) {
    const double size = ValueOf(cause, "step", &ParameterEstimate::value);
    if (cause.effect != "slip" || !std::isfinite(size)) continue;
    const double at = ValueOf(cause, "at_reading", &ParameterEstimate::value);
    steps.push_back({size, ValueOf(cause, "step", &ParameterEstimate::u), static_cast<int>(std::lround(at))});
  }
  return steps;
}

Count CountOf(const std::vector<Step>& steps) {
  double products = 0.0, squares = 0.0;
  for (const Step& s : steps) {
    products += s.counts * s.size / (s.u * s.u);
    squares += s.counts * s.counts / (s.u * s.u);
  }
  return {products / squares, 1.0 / std::sqrt(squares)};
}

/// One that is taken back soon: of the angle as well as of the time, if it is passed once.
bool IsBump(const std::vector<Step>& steps, int readings) {
  constexpr double kSoon = 0.15;
  return steps.size() == 2 && steps[0].size * steps[1].size < 0.0 &&
         std::abs(steps[0].at_reading - steps[1].at_reading) < kSoon * readings;
}

/// In counts of the smallest. @return false if they are not: two at least have to be equal, and each has to be
/// known well enough for a whole number to mean something, which of a bump is less.
bool AreCounts(std::vector<Step>& steps, bool is_bump) {
  const double sharp = is_bump ? 0.3 : 0.1;
  constexpr double kRounding = 0.01;  // of a count
  constexpr int kMost = 8;
  if (steps.size() < 2) return false;
  const auto size_of = [](const Step& s) { return std::abs(s.size); };
  const double smallest = size_of(std::ranges::min(steps, {}, size_of));
  for (Step& s : steps) s.counts = static_cast<int>(std::lround(s.size / smallest));
  if (std::ranges::count_if(steps, [](const Step& s) { return std::abs(s.counts) == 1; }) < 2) return false;
  const Count count = CountOf(steps);
  return std::ranges::all_of(steps, [&](const Step& s) {
    const double apart = std::abs(s.size - s.counts * count.size);
    return std::abs(s.counts) <= kMost && s.u < sharp * count.size &&
           apart < tuning::kHeadline * s.u + kRounding * count.size;
  });
}

std::string Words(const std::vector<Step>& steps, const Count& count, const LinearRun& run) {
  std::string at;
  for (const Step& s : steps) at += fmt::format("{}{} ({:+})", at.empty() ? "" : ", ", s.at_reading, s.counts);
  return fmt::format(
      "lost counts: {} steps of one size at readings {}, function of time, on angle, amplitude {:.3g} "
      "± {:.1g} {}",
      steps.size(), at, count.size / run.to_SI, count.u / run.to_SI, run.unit);
}

std::string WordsOfBump(const std::vector<Step>& steps, const Count& count, const LinearRun& run) {
  const std::vector<int>& numbers = run.schedule.reading;
  const auto at = [&](int reading) {
    const auto row = std::ranges::lower_bound(numbers, reading) - numbers.begin();
    return run.schedule.reference_rad[std::min<Eigen::Index>(row, run.Rows() - 1)] / run.to_SI;
  };
  const int first = steps[0].at_reading, last = steps[1].at_reading - 1;
  return fmt::format("bump from reading {} to {}, which is from {:.4g} to {:.4g} {}, function of angle or time, on angle, amplitude {:.3g} ± {:.1g} {}",
                     first, last, at(first), at(last), run.unit, steps[0].counts * count.size / run.to_SI, count.u / run.to_SI, run.unit);
}

bool IsSlip(const Accepted& accepted) {
  return accepted.family.effect == "slip";
}

/// All of them with one amplitude, as the steps that the twin can carry out.
Accepted Together(const std::vector<Accepted>& accepted, const std::vector<Step>& steps, const Count& count,
                  const LinearRun& run) {
  Accepted all;
  all.family.kind = Kind::kUnknown;
  all.family.effect = "lost counts";
  all.family.where = "angle";
  all.family.amplitudes = {{"amplitude", run.unit, run.to_SI, count.size}};
  all.amplitudes = Eigen::VectorXd::Constant(1, count.size);
  all.columns = Eigen::MatrixXd::Zero(run.Rows(), 1);
  for (const Accepted& a : accepted) {
    if (IsSlip(a)) all.columns += a.columns * a.amplitudes / count.size;
  }
  std::vector<Product> products;
  for (const Step& s : steps)
    products.push_back(
        {unknown::SignalOf("step", "", {{"at_reading", s.at_reading}}), 0, false, s.size / count.size});
  all.family.products = [products](const Eigen::VectorXd&, int) { return products; };
  return all;
}

}  // namespace

void TellEqualSteps(DiagnosisRun& result) {
  Diagnosis& d = result.diagnosis;
  std::vector<Step> steps = StepsAmong(d.causes);
  const bool is_bump = IsBump(steps, result.run.Rows());
  if (std::ranges::count_if(result.accepted, IsSlip) != std::ssize(steps) || !AreCounts(steps, is_bump)) return;
  std::ranges::sort(steps, {}, &Step::at_reading);
  const Count count = CountOf(steps);
  Accepted together = Together(result.accepted, steps, count, result.run);
  double others = 0.0;
  for (const Accepted& a : result.accepted) {
    if (!IsSlip(a)) others += (a.columns * a.amplitudes).squaredNorm();
  }
  const bool is_most = (together.columns * together.amplitudes).squaredNorm() > others;
  std::erase_if(result.accepted, IsSlip);
  result.accepted.push_back(std::move(together));
  std::erase_if(d.causes, [](const Cause& cause) { return cause.effect == "slip"; });
  if (is_most || d.causes.empty()) d.verdict = Verdict::kUnknown;
  d.unknown.probability = tuning::kListed;
  d.unknown.signature =
      (is_bump ? WordsOfBump : Words)(steps, count, result.run) + (d.unknown.signature.empty() ? "" : " | " + d.unknown.signature);
}

}  // namespace twinbench::diagnose::encoder
