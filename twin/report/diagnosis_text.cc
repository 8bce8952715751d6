#include "twin/report/diagnosis_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/diagnose/words.h"
#include "twin/report/diagnosis_tables.h"
#include "twin/report/sound.h"
#include "twin/report/text_table.h"
#include "twin/report/verdict_line.h"

namespace twinbench::report {
namespace {

using diagnose::Diagnosis;
using diagnose::Verdict;

/// What a first look can do without.
struct Remark {
  std::string name;  // "noise"
  std::string text;  // whole lines
};

std::string Sentence(const std::string& head, const std::string& text) {
  return Paragraph(head, text, head.size(), kPageWidth);
}

std::string WithUnit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : fmt::format("{} [{}]", name, unit);
}

std::string CurveOfPage(const DiagnosisPage& page, Letters letters) {
  const diagnose::ErrorCurve& c = page.shown.curve;
  const bool is_error = page.found.run.Channels() == 1;
  CurveText curve;
  curve.title =
      WithUnit(is_error ? "Error" : "Residual of " + c.channel, c.unit) + " against the " + c.along;
  curve.x_name = WithUnit(c.along, c.along_unit);
  curve.x = c.x;
  curve.forward = c.forward;
  curve.backward = c.backward;
  if (!c.is_directed) curve.forward_name = "all readings";
  return PlotOf(curve, letters);
}

/// Residual tests that stand out although nothing was found, by name.
std::string TestsStandingOut(const std::vector<diagnose::ResidualTest>& tests) {
  constexpr std::size_t kMostNamed = 3;
  const std::vector<diagnose::ResidualTest> out = StandingOut(tests);
  std::string names;
  for (std::size_t k = 0; k < std::min(out.size(), kMostNamed); ++k) names += (k > 0 ? ", " : "") + out[k].name;
  if (out.empty()) return "";
  return Sentence("! ", fmt::format("{} of {} residual tests stand{} out nevertheless: {}{}", out.size(),
                                    tests.size(), out.size() == 1 ? "s" : "", names, out.size() > kMostNamed ? ", ..." : ""));
}

/// What limits the answer, a line or two each.
std::string Warnings(const DiagnosisPage& page) {
  const Diagnosis& d = page.found.diagnosis;
  std::string text;
  if (d.gain.folds > 0 && !d.gain.positive && std::ranges::count(d.notes, diagnose::kNoGainNote) == 0)
    text += Sentence("! ", diagnose::GainInWords(d.gain, page.found.run));
  for (const std::string& note : d.notes) text += Sentence("! ", note);
  if (d.left_out > 0)
    text += Sentence("! ", fmt::format("{} left out of the search, without a value that can be compared",
                                     d.left_out == 1 ? "1 reading" : fmt::format("{} readings", d.left_out)));
  if (d.verdict == Verdict::kNone) text += TestsStandingOut(page.residual_tests);
  return text;
}

void Add(const std::string& name, const std::string& text, std::vector<Remark>& remarks) {
  if (!text.empty()) remarks.push_back({name, text});
}

std::string ChanceInWords(const Diagnosis& d) {
  if (d.verdict == Verdict::kNone || !std::isfinite(d.alarm_p)) return "";
  const std::string share =
      d.alarm_p < 0.001 ? "fewer than 1 in 1000 runs" : fmt::format("{:.2g} % of runs", 100.0 * d.alarm_p);
  return Sentence("Chance: ", share + " without any effect would disagree with the scenario as much");
}

std::string RemovedInWords(const diagnose::Gain& gain) {
  if (gain.folds == 0 || !std::isfinite(gain.fraction_removed)) return "";
  std::string text = fmt::format("{} (95 % interval {} to {}) of what a perfect model would remove there",
                                 diagnose::Percent(gain.fraction_removed), diagnose::Percent(gain.interval95[0]),
                                 diagnose::Percent(gain.interval95[1]));
  if (std::isfinite(gain.another_run))
    text += fmt::format("; {} expected on another run{}", diagnose::Percent(gain.another_run),
                        gain.has_tables_of_run ? ", of which this run's tables say nothing: leave them out there" : "");
  return Sentence("Removed: ", text);
}

std::string NoiseInWords(const Diagnosis& d) {
  std::string text;
  for (const std::string& words : d.noise) text += Sentence("Noise: ", words);
  return text;
}

/// @param verbose  All harmonics stand with the significant ones then.
std::vector<Remark> RemarksOn(const DiagnosisPage& page, bool verbose) {
  const Diagnosis& d = page.found.diagnosis;
  std::vector<Remark> remarks;
  Add("chance", ChanceInWords(d), remarks);
  Add("share removed", RemovedInWords(d.gain), remarks);
  if (const std::string all = HarmonicsTable(page.found, true);
      !verbose && all != HarmonicsTable(page.found, false))
    Add("all harmonics", all, remarks);
  Add("noise", NoiseInWords(d), remarks);
  Add("smallest detectable sizes", DetectableTable(d), remarks);
  Add("what is not observable", InvisibleTable(d), remarks);
  if (!page.residual_tests.empty())
    Add("residual tests", Sentence("", ResidualTestsInWords(page.residual_tests)), remarks);
  return remarks;
}

std::string Further(const std::vector<Remark>& remarks, bool verbose) {
  std::string text;
  for (const Remark& remark : remarks)
    text += verbose ? "\n" + remark.text : (text.empty() ? "" : ", ") + remark.name;
  if (verbose || remarks.empty()) return text;
  return "\n" + Sentence("", fmt::format("--verbose adds {} further remark{}: {}", remarks.size(),
                                         remarks.size() == 1 ? "" : "s", text));
}

/// Blocks of lines, apart by an empty one.
std::string Apart(const std::vector<std::string>& blocks) {
  std::string text;
  for (const std::string& block : blocks) {
    if (!block.empty()) text += (text.empty() ? "" : "\n") + block;
  }
  return text;
}

}  // namespace

std::string DiagnosisText(const DiagnosisPage& page, const PageStyle& style) {
  const diagnose::DiagnosisRun& found = page.found;
  const diagnose::Gain& gain = found.diagnosis.gain;
  const std::string gained = gain.positive ? Sentence("Held-out improvement: ", GainInWords(gain, found.run)) : "";
  return InPrint(Apart({VerdictLine(found.diagnosis, page.source, page.shown.share) + "\n",
                        CauseTable(found, page.shown) + NextMeasurements(found.diagnosis),
                        HarmonicsTable(found, style.verbose), CurveOfPage(page, style.letters), gained + Warnings(page)}) +
                 Further(RemarksOn(page, style.verbose), style.verbose));
}

}  // namespace twinbench::report
