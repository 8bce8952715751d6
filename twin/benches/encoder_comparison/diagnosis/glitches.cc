#include "twin/benches/encoder_comparison/diagnosis/glitches.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/distributions.h"
#include "twin/core/units.h"
#include "twin/diagnose/conclusion.h"
#include "twin/diagnose/recurrence.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose::encoder {
namespace {

constexpr int kBesideOne = 7;     // readings on either side
constexpr int kLongest = 5;       // glitch
constexpr double kFarOff = 12.0;  // in medians of absolute distances: eight deviations of normal noise
constexpr double kHalfFar = 6.0;
constexpr double kMostShare = 0.05;
constexpr double kSamePlace = 0.25;  // of the way from one reading to the next

/// Rows from `first` to `last` that are of i's mounting, but not i.
std::vector<double> Around(const LinearRun& run, int i, int first, int last) {
  std::vector<double> values;
  for (int k = std::max(0, first); k <= std::min(run.schedule.Readings() - 1, last); ++k) {
    if (k != i &&
        run.schedule.setup[static_cast<std::size_t>(k)] == run.schedule.setup[static_cast<std::size_t>(i)])
      values.push_back(run.residual[k]);
  }
  return values;
}

/// What nearly all readings lie within: a signal that is cut off or a code that is missing leaves it by no more
/// than that.
double UsualRange(const LinearRun& run) {
  constexpr double kOutside = 0.05;
  std::vector<double> values(run.residual.begin(), run.residual.end());
  std::ranges::sort(values);
  const auto outside = static_cast<std::size_t>(kOutside * static_cast<double>(values.size()));
  return values[values.size() - 1 - outside] - values[outside];
}

/// How far each reading is from the middle of those around it, in what these scatter by or usually do; 0 of one
/// that lies no farther than all of them do.
std::vector<double> Farness(const LinearRun& run, const Eigen::VectorXd& relative_noise) {
  const double range = UsualRange(run);
  std::vector<double> away, scatter;
  for (int i = 0; i < run.schedule.Readings(); ++i) {
    std::vector<double> around = Around(run, i, i - kBesideOne, i + kBesideOne);
    const double middle = around.empty() ? run.residual[i] : Median(around);
    for (double& x : around) x = std::abs(x - middle);
    away.push_back(std::abs(run.residual[i] - middle) / std::max(1.0, relative_noise[i]));
    scatter.push_back(around.empty() ? 0.0 : Median(std::move(around)));
  }
  const double usual = Median(scatter);
  for (std::size_t i = 0; i < away.size(); ++i) {
    const bool is_far = usual > 0.0 && away[i] > range;
    away[i] = is_far ? away[i] / std::max(usual, scatter[i]) : 0.0;
  }
  return away;
}

/// A servo that is sent far is far behind, and no worse for that.
bool GoesOnAsUsual(const Schedule& s, int begin, int end, double usual_step_rad) {
  constexpr double kLeap = 3.0;
  for (int i = std::max(1, begin); i <= std::min(end, s.Readings() - 1); ++i) {
    if (std::abs(s.reference_rad[i] - s.reference_rad[i - 1]) > kLeap * usual_step_rad) return false;
  }
  return true;
}

/// Those before rows [begin, end) and those behind agree, as they do not beside a step. Where a recording ends (or
/// begins) with very few that are very far off there is one side only.
bool Returns(const LinearRun& run, const std::vector<double>& farness, int begin, int end) {
  constexpr std::size_t kFewest = 3;
  constexpr double kAgree = 0.5, kVeryFar = 5.0 * kFarOff;
  const std::vector<double> before = Around(run, begin, begin - kBesideOne, begin - 1),
                            behind = Around(run, begin, end, end + kBesideOne - 1);
  const auto is_very_far = [&](int i) { return farness[static_cast<std::size_t>(i)] > kVeryFar; };
  bool are_very_far = end - begin <= static_cast<int>(kFewest);
  for (int i = begin; i < end; ++i) are_very_far = are_very_far && is_very_far(i);
  if (before.empty() || behind.empty()) return are_very_far;
  if (std::min(before.size(), behind.size()) < kFewest && !are_very_far) return false;
  const double a = Median(before), b = Median(behind);
  for (int i = begin; i < end; ++i) {
    if (std::abs(a - b) > kAgree * std::abs(run.residual[i] - 0.5 * (a + b))) return false;
  }
  return true;
}

/// Another time that its place of the turn was passed it read the same: a curve that jumps where a course turns has
/// one reading behind the jump.
bool IsOfItsPlace(const LinearRun& run, int row, double usual_step_rad) {
  constexpr double kAgree = 0.25;
  const Schedule& s = run.schedule;
  const double off = run.residual[row] - Median(Around(run, row, row - kBesideOne, row + kBesideOne));
  for (int k = 0; k < s.Readings(); ++k) {
    const bool is_there = std::abs(std::remainder(s.reference_rad[k] - s.reference_rad[row], units::turn)) <
                          kSamePlace * usual_step_rad;
    if (is_there && std::abs(k - row) > kBesideOne &&
        std::abs(run.residual[k] - run.residual[row]) < kAgree * std::abs(off))
      return true;
  }
  return false;
}

double UsualStep_rad(const Schedule& s) {
  std::vector<double> steps_rad;
  for (int i = 1; i < s.Readings(); ++i) steps_rad.push_back(std::abs(s.reference_rad[i] - s.reference_rad[i - 1]));
  return Median(std::move(steps_rad));
}

/// Two of them at one place of the turn, in two passes, are the place's.
bool ComeBack(const std::vector<int>& begins, const Schedule& s, double usual_step_rad) {
  for (const int a : begins) {
    for (const int b : begins) {
      const bool is_other_pass = s.pass[static_cast<std::size_t>(a)] != s.pass[static_cast<std::size_t>(b)];
      const double apart_rad = std::remainder(s.reference_rad[a] - s.reference_rad[b], units::turn);
      if (is_other_pass && std::abs(apart_rad) < kSamePlace * usual_step_rad) return true;
    }
  }
  return false;
}

double MiddleBeside(const Eigen::VectorXd& rows, const std::vector<int>& left_out, int i) {
  std::vector<double> values;
  for (int k = std::max(0, i - kBesideOne); k <= std::min(static_cast<int>(rows.size()) - 1, i + kBesideOne); ++k) {
    if (!std::ranges::binary_search(left_out, k)) values.push_back(rows[k]);
  }
  return Median(std::move(values));
}

/// "631, 640 to 642".
std::string Places(const Glitches& glitches, const std::vector<int>& reading) {
  constexpr std::size_t kMost = 8;
  std::string text;
  std::size_t told = 0;
  for (std::size_t k = 0; k < glitches.rows.size(); ++told) {
    std::size_t end = k + 1;
    while (end < glitches.rows.size() && glitches.rows[end] == glitches.rows[end - 1] + 1) ++end;
    const int first = reading[static_cast<std::size_t>(glitches.rows[k])],
              last = reading[static_cast<std::size_t>(glitches.rows[end - 1])];
    if (told < kMost)
      text +=
          fmt::format("{}{}{}", text.empty() ? "" : ", ", first, last > first ? fmt::format(" to {}", last) : "");
    k = end;
  }
  return told > kMost ? text + ", ..." : text;
}

double SumOfSquares(const Cause& outliers, double readings) {
  const auto value = [&](const char* name) {
    return std::ranges::find(outliers.parameters, name, &ParameterEstimate::name)->value;
  };
  return value("fraction") * readings * std::pow(value("size"), 2);
}

void TellFar(const Glitches& glitches, DiagnosisRun& result) {
  Diagnosis& d = result.diagnosis;
  const auto readings = static_cast<double>(result.run.schedule.Readings());
  NoiseCause far;
  far.log_bayes = 0.5 * kFarOff * kFarOff * static_cast<double>(glitches.rows.size());
  far.outliers = glitches.rows;
  double squares = glitches.size_rad.squaredNorm();
  const auto other = std::ranges::find(d.causes, "outliers", &Cause::effect);
  double others = 0.0;
  if (other != d.causes.end()) {
    others =
        std::round(readings * std::ranges::find(other->parameters, "fraction", &ParameterEstimate::name)->value);
    squares += SumOfSquares(*other, readings);
    d.causes.erase(other);
  }
  const double count = others + static_cast<double>(glitches.rows.size());
  far.outlier_size = std::sqrt(squares / count) / result.run.sigma.mean();
  Cause cause = OutlierCause(far, result.run);
  ParameterEstimate& fraction = *std::ranges::find(cause.parameters, "fraction", &ParameterEstimate::name);
  fraction.value = count / readings;
  fraction.u = fraction.value / std::sqrt(count);
  d.causes.push_back(std::move(cause));
  if (d.verdict == Verdict::kNone) d.verdict = Verdict::kNamed;
  d.alarm_p = std::min(d.alarm_p, std::exp(-far.log_bayes));
  d.notes.push_back(fmt::format(
      "readings far from all around them, by up to {:.3g} {}: {}; everything else was found without them",
      glitches.size_rad.cwiseAbs().maxCoeff() / result.run.to_SI, result.run.unit,
      Places(glitches, result.run.schedule.reading)));
}

/// Those that the search has left out are with them.
std::vector<int> FarRows(const Glitches& glitches, const DiagnosisRun& result) {
  constexpr double kLeftOut = 1e3;  // times the noise
  std::vector<int> rows = glitches.rows;
  for (int k = 0; k < result.run.Rows(); ++k) {
    if (result.noise.sigma[k] > kLeftOut * result.run.sigma[k] && std::ranges::count(glitches.rows, k) == 0)
      rows.push_back(k);
  }
  std::ranges::sort(rows);
  return rows;
}

/// One or two, where another pass went by between its readings: a fault of a place that is narrower than their
/// distance shows no more often, a code of a converter that is missing.
bool MayBeOfPlaces(const std::vector<int>& rows, const Schedule& s) {
  constexpr std::size_t kFew = 2;
  constexpr double kBetween = 0.02;  // of the way from one reading to the next
  const double step_rad = UsualStep_rad(s);
  return !rows.empty() && rows.size() <= kFew && std::ranges::all_of(rows, [&](int row) {
    double nearest_rad = units::turn;
    for (int i = 0; i < s.Readings(); ++i) {
      const bool is_own_pass = s.pass[static_cast<std::size_t>(i)] == s.pass[static_cast<std::size_t>(row)];
      if (is_own_pass || std::ranges::count(rows, i) > 0) continue;
      nearest_rad =
          std::min(nearest_rad, std::abs(std::remainder(s.reference_rad[i] - s.reference_rad[row], units::turn)));
    }
    return nearest_rad > kBetween * step_rad && nearest_rad < step_rad;
  });
}

/// Single readings are the more usual reason.
void DoubtFew(const std::vector<int>& rows, DiagnosisRun& result) {
  Diagnosis& d = result.diagnosis;
  const auto outliers = std::ranges::find(d.causes, "outliers", &Cause::effect);
  if (outliers == d.causes.end() || !MayBeOfPlaces(rows, result.run.schedule)) return;
  outliers->probability = std::min(outliers->probability, tuning::kNotProven);
  d.unknown.probability = std::max(d.unknown.probability, 1.0 - tuning::kNotProven);
  d.unknown.signature += fmt::format(
      "{}fault of a place that is narrower than the distance of readings, synchronous with "
      "reference angle, on angle",
      d.unknown.signature.empty() ? "" : " | ");
  if (d.verdict == Verdict::kNamed) d.verdict = Verdict::kTie;
}

}  // namespace

Glitches FindGlitches(const LinearRun& run, const Eigen::VectorXd& relative_noise) {
  const Schedule& s = run.schedule;
  const double usual_step_rad = UsualStep_rad(s);
  if (!(usual_step_rad > 0.0)) return {};  // places that are read again and again
  const std::vector<double> farness = Farness(run, relative_noise);
  Glitches found;
  std::vector<int> begins;
  for (int i = 0; i < s.Readings(); ++i) {
    int end = i;
    while (end < s.Readings() && farness[static_cast<std::size_t>(end)] > kFarOff) ++end;
    if (end == i) continue;
    const int longest = i == 0 ? 1 : kLongest;  // what fades away from the beginning on is no glitch
    if (end - i <= longest && GoesOnAsUsual(s, i, end, usual_step_rad) && Returns(run, farness, i, end) &&
        !IsOfItsPlace(run, i, usual_step_rad)) {
      begins.push_back(i);
      for (int k = i; k < end; ++k) found.rows.push_back(k);
    }
    i = end;
  }
  const auto half_far = std::ranges::count_if(farness, [](double f) { return f > kHalfFar && f <= kFarOff; });
  const auto count = std::ssize(found.rows);
  if (2 * half_far > count || static_cast<double>(count) > kMostShare * s.Readings()) return {};
  if (!RecurrenceOf(begins, run).empty() || ComeBack(begins, s, usual_step_rad)) return {};
  found.size_rad.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const int row = found.rows[static_cast<std::size_t>(k)];
    found.size_rad[k] = run.residual[row] - MiddleBeside(run.residual, found.rows, row);
  }
  return found;
}

void Bridge(const Glitches& glitches, Eigen::VectorXd& rows) {
  for (Eigen::Index k = 0; k < glitches.size_rad.size(); ++k)
    rows[glitches.rows[static_cast<std::size_t>(k)]] -= glitches.size_rad[k];
}

void TellGlitches(const Glitches& glitches, const Scenario& scenario, DiagnosisRun& result) {
  if (!glitches.rows.empty()) TellFar(glitches, result);
  const bool are_stated = std::ranges::count(scenario.effects, "outliers", &EffectSettings::name) > 0;
  if (!are_stated) DoubtFew(FarRows(glitches, result), result);
}

}  // namespace twinbench::diagnose::encoder
