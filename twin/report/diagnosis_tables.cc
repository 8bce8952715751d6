#include "twin/report/diagnosis_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/core/effect_catalogue.h"
#include "twin/core/units.h"
#include "twin/diagnose/cause_groups.h"
#include "twin/diagnose/words.h"
#include "twin/report/sound.h"
#include "twin/report/text_table.h"

namespace twinbench::report {
namespace {

using diagnose::Cause;
using diagnose::Diagnosis;
using diagnose::DiagnosisRun;
using diagnose::Harmonic;
using diagnose::ParameterEstimate;
using diagnose::Percent;
using diagnose::Verdict;
using Cells = std::vector<std::vector<std::string>>;

std::string NameAndTitle(const Cause& cause, const std::string& bench) {
  const EffectEntry* const entry = FindEffect(cause.effect, bench);
  return diagnose::Place(cause.effect, cause.where) + (entry ? "\n  " + entry->title : "");
}

/// A line a parameter.
std::string SizeLines(const Cause& cause) {
  std::string lines;
  for (const ParameterEstimate& p : cause.parameters) {
    if (std::isfinite(p.value) && IsDetermined(p.u, p.lower, p.upper)) lines += (lines.empty() ? "" : "\n") + diagnose::NameAndSize(p);
  }
  return lines;
}

/// Its own size, or how well it stands for the first of its group.
std::string SizeOfMember(const std::vector<Cause>& causes, const diagnose::CauseGroup& group, std::size_t member) {
  const std::string sizes = SizeLines(causes[group[member]]);
  const double overlap = Imitates(causes, group, member);
  if (!sizes.empty() || member == 0 || !std::isfinite(overlap)) return sizes;
  return fmt::format("aliased: explains {} of it", Percent(overlap));
}

void AddGroup(const DiagnosisRun& found, const diagnose::CauseGroup& group, double share, Cells& rows) {
  const std::vector<Cause>& causes = found.diagnosis.causes;
  for (std::size_t i = 0; i < group.size(); ++i) {
    const Cause& cause = causes[group[i]];
    rows.push_back({(i > 0 ? "or " : "") + NameAndTitle(cause, found.run.bench), SizeOfMember(causes, group, i),
                    Percent(cause.probability), i == 0 ? Percent(share) : ""});
  }
}

/// "order 7, ... | decay ..." as a line each.
std::string SignatureLines(std::string signature) {
  for (std::size_t at = 0; (at = signature.find(" | ", at)) != std::string::npos;) signature.replace(at, 3, "\n");
  return signature;
}

/// The meaning, or the order above that has the same.
std::string MeaningOnce(const Harmonic& harmonic, std::map<std::string, int>& told) {
  const auto [at, is_new] = told.try_emplace(harmonic.meaning, harmonic.order);
  return is_new ? harmonic.meaning : fmt::format("as order {}", at->second);
}

}  // namespace

std::string CauseTable(const DiagnosisRun& found, const diagnose::Shown& shown) {
  const Diagnosis& d = found.diagnosis;
  Cells rows, unmodelled;
  if (diagnose::HasUnmodelled(d))
    unmodelled = {{"unmodelled effect", SignatureLines(d.unknown.signature), Percent(d.unknown.probability),
                   Percent(shown.share_unnamed)}};
  if (d.verdict == Verdict::kUnknown) rows = unmodelled;
  for (const diagnose::CauseGroup& group : GroupsByShare(d.causes, shown.share)) AddGroup(found, group, diagnose::ShareOf(group, shown.share), rows);
  if (d.verdict != Verdict::kUnknown) rows.insert(rows.end(), unmodelled.begin(), unmodelled.end());
  if (rows.empty()) return "";
  return "Causes (share: of the variance beyond noise)\n" +
         TextTable({{"cause"}, {"size ± u", false, true}, {"probability", true}, {"share", true}}, rows,
                   kPageWidth);
}

std::string NextMeasurements(const Diagnosis& d) {
  std::string text;
  std::vector<std::string> told;
  for (const Cause& cause : d.causes) {
    if (cause.next_measurement.empty() || std::ranges::count(told, cause.next_measurement) > 0) continue;
    told.push_back(cause.next_measurement);
    text += Paragraph(told.size() == 1 ? "Next: " : "and: ", cause.next_measurement, 6, kPageWidth);
  }
  return text;
}

std::string HarmonicsTable(const DiagnosisRun& found, bool all) {
  const std::vector<Harmonic>& harmonics = found.diagnosis.harmonics;
  const std::string& unit = found.run.unit;
  std::map<std::string, int> told;
  Cells rows;
  for (const Harmonic& h : harmonics) {
    if (!all && !IsSignificant(h, harmonics.size())) continue;
    const ParameterEstimate amplitude{"", unit, found.run.to_SI, h.amplitude_rad, h.u_amplitude_rad};
    const ParameterEstimate phase{"", "deg", units::deg, h.phase_rad, h.u_phase_rad};
    rows.push_back({fmt::format("{}", h.order), diagnose::WithUncertainty(amplitude),
                    diagnose::WithUncertainty(phase), MeaningOnce(h, told)});
  }
  if (rows.empty()) return "";
  return "Harmonics of the error: amplitude * cos(order * angle + phase)\n" +
         TextTable({{"order", true}, {"amplitude ± u", true}, {"phase ± u", true}, {"what it may mean"}}, rows,
                   kPageWidth);
}

std::string DetectableTable(const Diagnosis& d) {
  Cells rows;
  for (const diagnose::Detectable& seen : d.detectable) {
    if (std::isfinite(seen.smallest.value))
      rows.push_back({diagnose::Place(seen.effect, seen.where), diagnose::NameAndSize(seen.smallest)});
  }
  return TextTable({{"effect"}, {"smallest detectable size"}}, rows, kPageWidth);
}

std::string InvisibleTable(const Diagnosis& d) {
  Cells rows;
  for (const diagnose::Invisible& unseen : d.invisible)
    rows.push_back({diagnose::Place(unseen.effect, unseen.where), unseen.could_bias});
  return TextTable({{"not observable in this run"}, {"what it could bias"}}, rows, kPageWidth);
}

}  // namespace twinbench::report
