#pragma once

#include <map>
#include <string>

#include "tests/foreign/foreign_counts.h"
#include "tests/hidden/score_format.h"

/// The score of foreign machines in Markdown, section by section.
namespace twinbench::foreign {

// section_answers.cc
std::string SummarySection(const Answers& answers);
std::string KindSection(const Answers& answers);
std::string SeveralSection(const Answers& answers);
std::string CleanSection(const Answers& answers);

// section_files.cc
std::string SecondSection(const Answers& answers);
std::string GainSection(const Answers& answers);

// section_cases.cc
std::string CalibrationOf(const Answers& answers);
std::string TimeOf(const Answers& answers);
std::string FailureSection(const Answers& answers);
/// One row a case, for programs.
std::string ForeignCsv(const Answers& answers);

using AnswerGroups = std::map<std::string, Answers>;
AnswerGroups GroupsOf(const Answers& answers, Condition of, std::string (*key)(const Answer&));
std::string SetOf(const Answer& a);

/// The row of each group.
std::string RowsOf(const AnswerGroups& groups, std::string (*row)(const std::string& key, const Answers& group));

inline std::string ForeignTables(const Answers& answers) {
  return SummarySection(answers) + KindSection(answers) + SeveralSection(answers) + CalibrationOf(answers) +
         CleanSection(answers) + SecondSection(answers) + GainSection(answers) + TimeOf(answers) +
         FailureSection(answers);
}

}  // namespace twinbench::foreign
