#include "tests/hidden/judge.h"

#include "twin/benches/circular_motion/settings.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/names.h"
#include "twin/benches/registry.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/errors.h"
#include "twin/core/happened_once.h"
#include "twin/diagnose/extend.h"

namespace twinbench::hidden {
namespace {

using diagnose::Cause, diagnose::Diagnosis, diagnose::Verdict;

constexpr int kLargestTie = 3;

bool Matches(const Cause& cause, const Part& part) {
  return cause.effect == part.effect && (part.where.empty() || cause.where.empty() || cause.where == part.where);
}

bool IsThere(const Cause& cause, const Hidden& hidden) {
  return std::ranges::any_of(hidden.causes, [&](const Part& part) { return Matches(cause, part); });
}

bool IsAlike(const Cause& cause, const Hidden& hidden) {
  return std::ranges::find(hidden.alike, cause.effect) != hidden.alike.end();
}

const Cause* CauseFor(const Part& part, const Diagnosis& d) {
  const auto found = std::ranges::find_if(d.causes, [&](const Cause& cause) { return Matches(cause, part); });
  return found == d.causes.end() ? nullptr : &*found;
}

/// One part of the signature has the lock, and itself or one of its alternatives names exactly the channels.
bool HasSignature(const Hidden& hidden, const std::string& signature) {
  return std::ranges::any_of(Split(signature, " | "), [&](const std::string& part) {
    if (std::ranges::none_of(hidden.locks,
                             [&](const std::string& lock) { return part.find(lock) != std::string::npos; }))
      return false;
    if (hidden.channels.empty()) return true;
    const std::size_t others = part.find("; or the same on ");
    if (ChannelsIn(part.substr(0, others)) == hidden.channels) return true;
    if (others == std::string::npos) return false;
    return std::ranges::any_of(Split(part.substr(others + 17), ", "),
                               [&](const std::string& place) { return ChannelsIn(place) == hidden.channels; });
  });
}

Grade GradeUnlisted(const Hidden& hidden, const Diagnosis& d) {
  if (d.verdict == Verdict::kNone) return Grade::kMissed;
  if (d.verdict != Verdict::kUnknown) return Grade::kWrong;
  return HasSignature(hidden, d.unknown.signature) ? Grade::kUnknown : Grade::kUnknownMisplaced;
}

Grade GradeListed(const Hidden& hidden, const Diagnosis& d) {
  if (d.verdict == Verdict::kNone) return hidden.invisible ? Grade::kQuiet : Grade::kMissed;
  if (d.verdict == Verdict::kUnknown) return Grade::kAnsweredUnknown;
  const auto found = std::ranges::count_if(hidden.causes, [&](const Part& part) { return CauseFor(part, d); });
  if (found == 0) return Grade::kWrong;
  if (found < std::ssize(hidden.causes)) return Grade::kPartly;
  if (d.verdict == Verdict::kTie) return std::ssize(d.causes) <= kLargestTie ? Grade::kTie : Grade::kLargeTie;
  const bool more = std::ranges::any_of(d.causes, [&](const Cause& cause) { return !IsThere(cause, hidden); });
  return more ? Grade::kRightAndMore : Grade::kRight;
}

Grade GradeOf(const Hidden& hidden, const Diagnosis& d) {
  if (hidden.IsClean()) return d.verdict == Verdict::kNone ? Grade::kQuiet : Grade::kFalseAlarm;
  return hidden.unlisted.empty() ? GradeListed(hidden, d) : GradeUnlisted(hidden, d);
}

bool Names(const Diagnosis& d) { return d.verdict == Verdict::kNamed || d.verdict == Verdict::kTie; }

bool IsSurelyWrong(const Hidden& hidden, const Diagnosis& d) {
  return Names(d) && std::ranges::any_of(d.causes, [&](const Cause& cause) {
    return cause.probability >= kSure && !IsThere(cause, hidden) && !IsAlike(cause, hidden);
  });
}

void AddParameters(const Diagnosis& d, Outcome& outcome) {
  if (!Names(d)) return;
  for (const Part& part : outcome.hidden.causes) {
    const Cause* cause = CauseFor(part, d);
    if (!cause) continue;
    for (const diagnose::ParameterEstimate& p : cause->parameters) {
      const auto truth = part.parameters.find(p.name);
      if (truth == part.parameters.end()) continue;
      outcome.parameters.push_back(
          {p.name, p.value, p.u, truth->second, p.name == "phase" ? 2.0 * units::kPi : 0.0});
    }
  }
}

std::string AnswerOf(const Diagnosis& d) {
  std::string text = diagnose::VerdictName(d.verdict);
  for (const Cause& cause : d.causes) {
    text += fmt::format(" [{}{}{} {:.2f}]", cause.effect, cause.where.empty() ? "" : " ", cause.where,
                        cause.probability);
  }
  if (d.verdict == Verdict::kUnknown)
    text += fmt::format(" {:.2f}: {}", d.unknown.probability, d.unknown.signature);
  return text;
}

/// The p at which ProbabilityOfAtMost falls to `level`.
double SolveAtMost(int count, int of, double level) {
  double low = 0.0, high = 1.0;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (ProbabilityOfAtMost(count, of, middle) > level ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

const std::vector<int> kOtherWay = {-1, 1, 1, -1};

void Reschedule(EncoderProcedureSettings& p) {
  p.start_rad += 50.0 * units::deg;
  p.stop_interval_s *= 1.25;
  p.interval_s *= 1.1;
}

void Reschedule(CircularProcedureSettings& p) {
  p.start_rad += 70.0 * units::deg;
  p.dwell_s += 1.0;
}

}  // namespace

std::string InWords(const Hidden& hidden) {
  if (!hidden.unlisted.empty()) return "unlisted " + hidden.unlisted;
  std::string text;
  for (const Part& part : hidden.causes)
    text += (text.empty() ? "" : " + ") + part.effect + (part.where.empty() ? "" : " " + part.where);
  return text.empty() ? "none" : text;
}

double ParameterCheck::Error() const {
  return period > 0.0 ? std::remainder(value - truth, period) : value - truth;
}

bool ParameterCheck::Covers() const { return std::abs(Error()) <= 1.96 * u; }

std::vector<std::string> Split(const std::string& text, const std::string& separator) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(separator, at), text.size());
    parts.push_back(text.substr(at, end - at));
    at = end + separator.size();
  }
  return parts;
}

std::vector<std::string> ChannelsIn(const std::string& signature) {
  const std::map<std::string, std::vector<std::string>> patterns = {
      {"yaw", {"psd_a_x", "psd_b_x"}},
      {"tilt", {"psd_a_y", "psd_b_y"}},
      {"roll", {"psd_a_y", "psd_b_y"}},
      {"lateral", {"psd_a_x", "psd_b_x"}},
      {"all", {"psd_a_x", "psd_a_y", "psd_b_x", "psd_b_y"}}};
  std::set<std::string> channels;
  for (const char* channel : kChannelNames) {
    if (signature.find(channel) != std::string::npos) channels.insert(channel);
  }
  if (channels.empty()) {
    for (const auto& [pattern, members] : patterns) {
      if (signature.find(pattern) != std::string::npos) channels.insert(members.begin(), members.end());
    }
  }
  return {channels.begin(), channels.end()};
}

Outcome Judge(const Hidden& hidden, const Diagnosis& diagnosis) {
  Outcome outcome{.hidden = hidden, .grade = GradeOf(hidden, diagnosis), .verdict = diagnosis.verdict,
                  .answer = AnswerOf(diagnosis), .gain = diagnosis.gain.fraction_removed,
                  .sure_wrong = IsSurelyWrong(hidden, diagnosis)};
  AddParameters(diagnosis, outcome);
  return outcome;
}

double ProbabilityOfAtMost(int count, int of, double p) {
  if (p <= 0.0) return 1.0;
  if (p >= 1.0) return count >= of ? 1.0 : 0.0;
  double sum = 0.0;  // of no k at all: count may be -1
  for (int k = 0; k <= count; ++k) {
    const double choose = std::lgamma(of + 1.0) - std::lgamma(k + 1.0) - std::lgamma(of - k + 1.0);
    sum += std::exp(choose + k * std::log(p) + (of - k) * std::log1p(-p));
  }
  return sum;
}

std::array<double, 2> Share::Interval95() const {
  if (of == 0) return {0.0, 1.0};
  return {count == 0 ? 0.0 : SolveAtMost(count - 1, of, 0.975), count == of ? 1.0 : SolveAtMost(count, of, 0.025)};
}

Scenario WrittenFile(const Scenario& believed, const diagnose::DiagnosisRun& found) {
  return ParseScenario(diagnose::ExtendedToml(believed, found, "hidden case"), "extended.toml", ".");
}

std::string Says(const std::vector<Reading>& readings, const Scenario& scenario,
                 const diagnose::DiagnoseOptions& options) {
  try {
    const diagnose::Diagnosis said = diagnose::Diagnose(readings, scenario, options).diagnosis;
    return said.verdict == diagnose::Verdict::kNone ? "" : Judge({}, said).answer;
  } catch (const InputError& refusal) {
    return std::string("refused: ") + refusal.what();
  }
}

Scenario WithOtherSchedule(Scenario scenario) {
  scenario = InRun(scenario, scenario.repeat + 1);
  const std::string& bench = scenario.bench;
  if (bench == kEncoderBench) Reschedule(EncoderOf(scenario).encoder_procedure);
  if (bench == kCircularBench) Reschedule(CircularOf(scenario).procedure);
  if (bench == kFreeformBench) FreeformOf(scenario).freeform_procedure.interval_s *= 1.25;
  if (bench == kHobBench) HobOf(scenario).hob_procedure.passes = {-1, 1};
  if (bench == kRotaryBench) RotaryOf(scenario).procedure.passes = kOtherWay;
  if (bench == kRotaryBench) RotaryOf(scenario).procedure.dwell_s = {1.5, 3.0};
  if (bench == kTurntableBench) TurntableOf(scenario).turntable_procedure.passes = kOtherWay;
  if (bench == kTurntableBench) TurntableOf(scenario).turntable_procedure.dwell_s = {1.0, 3.0};
  return scenario;
}

Scenario OnAnotherDay(const Scenario& actual) {
  Scenario another = WithOtherSchedule(actual);
  EnvironmentSettings& room = another.environment;
  room.temperature_degC += 0.6;
  room.drift_K_h = -room.drift_K_h;
  room.swing_period_s *= 1.3;
  return another;
}

}  // namespace twinbench::hidden
