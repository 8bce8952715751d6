#include <fmt/format.h>

#include <algorithm>

#include "tests/foreign/foreign_sections.h"
#include "tests/hidden/score_sections.h"

// Cases one by one, and what the other score has tables for.
namespace twinbench::foreign {
namespace {

/// A section of the other score, of the answers that it is about.
std::string Borrowed(std::string (*section)(const hidden::Outcomes&), const Answers& answers, Condition of) {
  hidden::Outcomes outcomes;
  for (const Answer& a : answers) {
    if (of(a)) outcomes.push_back(&a.outcome);
  }
  return section(outcomes);
}

std::string Shortened(std::string text) {
  constexpr std::size_t kMostCharacters = 150;
  text = text.substr(0, kMostCharacters);
  std::ranges::replace(text, '|', '/');
  return text;
}

std::string FailureRow(const Answer& a) {
  const std::string gain =
      HasGain(a) ? fmt::format("{:.3f} / {:.3f}", a.stated_gain, a.file_gain) : std::string("-");
  return fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", a.set, a.name, a.truth.kind, ShortcomingsOf(a),
                     Shortened(a.outcome.answer), gain, a.second.empty() ? "-" : Shortened(a.second));
}

std::string Quoted(std::string text) {
  std::ranges::replace(text, '"', '\'');
  return "\"" + text + "\"";
}

std::string CsvRow(const Answer& a) {
  return fmt::format("{},{},{},{},{},{:.4f},{},{:.4f},{},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.2f}\n", a.set,
                     Quoted(a.name), Quoted(a.truth.kind), Quoted(ShortcomingsOf(a)), Quoted(a.outcome.answer),
                     a.outcome.probability, a.wrong, a.wrong_at, a.missing, Quoted(a.second), a.stated_gain,
                     a.stated_interval[0], a.stated_interval[1], a.file_gain, a.outcome.seconds);
}

}  // namespace

AnswerGroups GroupsOf(const Answers& answers, Condition of, std::string (*key)(const Answer&)) {
  AnswerGroups groups;
  for (const Answer& a : answers) {
    if (of(a)) groups[key(a)].push_back(a);
  }
  return groups;
}

std::string SetOf(const Answer& a) {
  return a.set;
}

std::string RowsOf(const AnswerGroups& groups, std::string (*row)(const std::string& key, const Answers& group)) {
  std::string text;
  for (const auto& [key, group] : groups) text += row(key, group);
  return text;
}

std::string CalibrationOf(const Answers& answers) {
  return Borrowed(hidden::CalibrationSection, answers, IsFaulty);
}

std::string TimeOf(const Answers& answers) {
  return Borrowed(hidden::TimeSection, answers, IsAny) +
         "Making the case, both diagnoses and the gain on another run together.\n\n";
}

std::string FailureSection(const Answers& answers) {
  std::string text = "## Cases that fall short\n\nGain: stated / of the file.\n\n" +
                     hidden::TableHead("set | case | hidden | falls short | answer | gain | second diagnosis");
  for (const Answer& a : answers) text += ShortcomingsOf(a).empty() ? "" : FailureRow(a);
  return text;
}

std::string ForeignCsv(const Answers& answers) {
  std::string text =
      "set,case,hidden,falls_short,answer,probability,wrong,wrong_at,missing,second,stated_gain,stated_lower,"
      "stated_upper,file_gain,seconds\n";
  for (const Answer& a : answers) text += CsvRow(a);
  return text;
}

}  // namespace twinbench::foreign
