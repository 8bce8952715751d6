#include "twin/diagnose/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "twin/core/effect_catalogue.h"
#include "twin/core/units.h"

namespace twinbench::diagnose {
namespace {

constexpr std::size_t kWidth = 100;
constexpr std::size_t kMostExamples = 6;  // of a list; the file has all of it

std::string Percent(double share) {
  return std::isfinite(share) ? fmt::format("{:.0f} %", 100.0 * share) : "unknown";
}

std::string Spaced(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string Place(const std::string& effect, const std::string& where) {
  return where.empty() ? effect : effect + " at " + where;
}

std::string PValue(double p) {
  if (!std::isfinite(p)) return "";
  return p < 0.001 ? " (a chance below 1 in 1000)" : fmt::format(" (a chance of {:.2g})", p);
}

/// "psd_gain at psd_a_x (gain of one PSD axis and its amplifier): gain error 0.0031 +- 0.0002"
std::string Describe(const Cause& cause, const std::string& bench) {
  std::string text = Place(cause.effect, cause.where);
  if (const EffectEntry* entry = FindEffect(cause.effect, bench)) text += fmt::format(" ({})", entry->title);
  std::string values;
  for (const ParameterEstimate& p : cause.parameters) {
    if (std::isfinite(p.value))
      values += fmt::format("{}{} {}", values.empty() ? ": " : ", ", Spaced(p.name), WithUncertainty(p));
  }
  return text + values;
}

std::string Join(const std::vector<std::string>& parts, const char* separator) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : separator) + part;
  return text;
}

std::string Causes(const Diagnosis& d, const std::string& bench) {
  std::vector<std::string> parts;
  for (const Cause& cause : d.causes)
    parts.push_back(fmt::format("{}, probability {}", Describe(cause, bench), Percent(cause.probability)));
  return Join(parts, "; ");
}

std::string Rivals(const Diagnosis& d) {
  std::string text;
  for (const Cause& cause : d.causes) {
    std::vector<std::string> names;
    for (const Rival& rival : cause.indistinguishable_from)
      names.push_back(
          fmt::format("{} (can imitate {} of it)", Place(rival.effect, rival.where), Percent(rival.overlap)));
    if (!names.empty())
      text += fmt::format("Instead of {} it could be {}. ", Place(cause.effect, cause.where), Join(names, " or "));
  }
  return text;
}

std::string NextMeasurements(const Diagnosis& d) {
  std::vector<std::string> seen;
  for (const Cause& cause : d.causes) {
    const std::string& next = cause.next_measurement;
    if (!next.empty() && std::find(seen.begin(), seen.end(), next) == seen.end()) seen.push_back(next);
  }
  return seen.empty() ? "" : fmt::format("What would tell: {}. ", Join(seen, "; "));
}

std::string Found(const Diagnosis& d, const std::string& bench) {
  const std::string disagree = fmt::format("The readings do not agree with the scenario{}. ", PValue(d.alarm_p));
  switch (d.verdict) {
    case Verdict::kNone:
      return fmt::format("The readings agree with the scenario: nothing was found in {} readings{}. ", d.readings,
                         std::isfinite(d.alarm_p) ? fmt::format(" (p = {:.2g})", d.alarm_p) : "");
    case Verdict::kNamed:
      return disagree + fmt::format("Found: {}. ", Causes(d, bench));
    case Verdict::kTie:
      return disagree + fmt::format("These readings cannot tell which of these it is: {}. ", Causes(d, bench));
    case Verdict::kUnknown:
      break;
  }
  std::string text = disagree + fmt::format("No cause of the catalogue explains it: {}. ", d.unknown.signature);
  return d.causes.empty() ? text : text + fmt::format("Besides or instead, less surely: {}. ", Causes(d, bench));
}

std::string GainInWords(const Gain& gain, const LinearRun& run) {
  if (gain.folds == 0) return "";
  const auto in_unit = [&](double SI) { return fmt::format("{:.3g}", SI / run.to_SI); };
  if (!gain.positive)
    return "On passes that it was not fitted to, the extended model does not predict better; do not build on it. ";
  std::string share;
  if (std::isfinite(gain.fraction_removed)) {
    share = fmt::format(": {} (95 % interval {} to {}) of what can be removed", Percent(gain.fraction_removed),
                        Percent(gain.interval95[0]), Percent(gain.interval95[1]));
  }
  if (run.IsMixed())
    return fmt::format(
        "On passes that the model was not fitted to, its error falls from {:.3g} to {:.3g} times what noise alone "
        "leaves{}. ",
        gain.before_m / gain.noise_floor_m, gain.after_m / gain.noise_floor_m, share);
  return fmt::format(
      "On passes that the model was not fitted to, its error falls from {} to {} {}, where noise alone leaves {} "
      "{}{}. ",
      in_unit(gain.before_m), in_unit(gain.after_m), run.unit, in_unit(gain.noise_floor_m), run.unit, share);
}

std::string Smallest(const Diagnosis& d) {
  std::vector<std::string> parts;
  for (const Detectable& seen : d.detectable) {
    if (parts.size() == kMostExamples) break;
    const ParameterEstimate& p = seen.smallest;
    if (!std::isfinite(p.value)) continue;
    parts.push_back(fmt::format("{}: {} {:.2g}{}", Place(seen.effect, seen.where), Spaced(p.name),
                                p.value / p.to_SI, p.unit == "1" ? "" : " " + p.unit));
  }
  return parts.empty()
             ? ""
             : fmt::format("It would have been seen if larger than, for example, {}. ", Join(parts, "; "));
}

std::string Unseen(const Diagnosis& d) {
  std::vector<std::string> parts;
  for (const Invisible& invisible : d.invisible) {
    if (parts.size() == kMostExamples) break;
    parts.push_back(Place(invisible.effect, invisible.where) +
                    (invisible.could_bias.empty() ? "" : fmt::format(" ({})", invisible.could_bias)));
  }
  return parts.empty() ? "" : fmt::format("This run cannot see {}. ", Join(parts, "; "));
}

}  // namespace

std::string Wrapped(const std::string& text) {
  std::istringstream in(text);
  std::string wrapped, line;
  for (std::string word; in >> word;) {
    if (!line.empty() && line.size() + 1 + word.size() > kWidth) {
      wrapped += line + '\n';
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return wrapped + line + '\n';
}

std::string WithUncertainty(const ParameterEstimate& p) {
  const double value = p.value / p.to_SI, u = p.u / p.to_SI;
  const std::string unit = p.unit == "1" ? "" : " " + p.unit;
  if (!std::isfinite(u) || u <= 0.0) return fmt::format("{:.3g}{}", value, unit);
  const int decimals = static_cast<int>(1.0 - std::floor(std::log10(u)));
  if (decimals > 6) return fmt::format("{:.4g} +- {:.2g}{}", value, u, unit);
  return fmt::format("{:.{}f} +- {:.{}f}{}", value, std::max(decimals, 0), u, std::max(decimals, 0), unit);
}

std::string InWords(const DiagnosisRun& run) {
  const Diagnosis& d = run.diagnosis;
  std::string text = Found(d, run.run.bench) + Rivals(d) + NextMeasurements(d) + GainInWords(d.gain, run.run);
  if (d.verdict == Verdict::kNone) text += Smallest(d);
  text += Unseen(d);
  if (!d.noise.empty()) text += fmt::format("Noise: {}. ", Join(d.noise, "; "));
  if (d.left_out > 0) text += fmt::format("Left out: {} readings without usable values. ", d.left_out);
  if (!d.notes.empty()) text += fmt::format("Note: {}.", Join(d.notes, "; "));
  return Wrapped(text);
}

}  // namespace twinbench::diagnose
