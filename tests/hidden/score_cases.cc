#include <fmt/format.h>

#include <algorithm>

#include "tests/hidden/score_format.h"
#include "tests/hidden/score_sections.h"
#include "tests/hidden/score_table.h"

// Cases one by one: those that went wrong for the reader, all of them for a program.
namespace twinbench::hidden {
namespace {

bool IsSatisfactory(const Outcome& o) {
  return o.RightOrTie() || o.grade == Grade::kQuiet || o.grade == Grade::kUnknown ||
         (IsLeaveOneOut(o) && !o.confident_wrong);
}

std::string FailureRow(const Outcome& o) {
  constexpr std::size_t kMostCharacters = 160;
  std::string answer = o.answer.substr(0, kMostCharacters);
  std::ranges::replace(answer, '|', '/');
  return fmt::format("| {} | {} | {} | {:.1f} | {} | {} |\n", o.set, o.name, InWords(o.hidden), o.hidden.rho,
                     GradeName(o.grade), answer);
}

/// "amplitude 2.3e-05 +- 2e-06 of 2.4e-05; phase ...", SI.
std::string ParametersInWords(const Outcome& o) {
  std::string text;
  for (const ParameterCheck& p : o.parameters)
    text += fmt::format("{}{} {:.5g} +- {:.2g} of {:.5g}", text.empty() ? "" : "; ", p.name, p.value, p.u, p.truth);
  return text;
}

std::string Quoted(std::string text) {
  std::ranges::replace(text, '"', '\'');
  return "\"" + text + "\"";
}

std::string CsvRow(const Outcome& o) {
  return fmt::format("{},{},{},{},{:.3g},{},{},{:.4f},{:d},{:.3g},{:.3g},{},{:.3f},{:.3f},{:.3f},{:.2f}\n", o.set,
                     o.name, Quoted(InWords(o.hidden)), Quoted(o.hidden.noise), o.hidden.rho, GradeName(o.grade),
                     Quoted(o.answer), o.probability, o.confident_wrong, o.alarm_p, o.rho,
                     Quoted(ParametersInWords(o)), o.gain, o.gain_interval95[0], o.gain_interval95[1], o.seconds);
}

}  // namespace

std::string FailureSection(const Outcomes& all) {
  std::string text = "## Answers that are not right\n\n" + TableHead("set | case | hidden | rho | grade | answer");
  for (const Outcome* o : Only(all, std::not_fn(IsSatisfactory))) text += FailureRow(*o);
  return text;
}

std::string CasesCsv(const std::vector<Outcome>& outcomes) {
  std::string text =
      "set,case,hidden,noise,rho,grade,answer,probability,confident_wrong,alarm_p,fitted_rho,parameters,gain,"
      "gain_lower,gain_upper,seconds\n";
  for (const Outcome& o : outcomes) text += CsvRow(o);
  return text;
}

}  // namespace twinbench::hidden
