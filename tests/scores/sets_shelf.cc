#include "tests/scores/sets.h"
#include "tests/shelf/examine.h"
#include "twin/benches/names.h"

// Recordings of tests/data/shelf.
namespace twinbench::scores {
namespace {

void Fill(const shelf::Answer& answer, Row& row) {
  row.hidden = answer.truth;
  row.answer = (answer.judged.why.empty() || answer.judged.why == answer.words ? "" : answer.judged.why + " <- ") +
               answer.words;
  row.marks[kRight] = answer.judged.is_right;
  row.marks[kSureWrong] = answer.judged.is_sure_wrong;
  if (!answer.second) return;
  row.marks[kSecondSilent] = answer.second->empty();
  if (!answer.second->empty()) row.answer += "; again: " + *answer.second;
}

}  // namespace

Plans ShelfSet(const std::string& bench, const Amount& amount) {
  Plans plans;
  if (bench != kEncoderBench) return plans;
  for (const std::string& name : shelf::CaseNames()) {
    plans.push_back({"shelf", bench, name, [name, cache = amount.cache_folder](Row& row) {
                       Fill(shelf::Examine(name, cache, true), row);
                     }});
  }
  return plans;
}

}  // namespace twinbench::scores
