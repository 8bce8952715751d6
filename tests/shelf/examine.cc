#include "tests/shelf/judge.h"

#include "tests/hidden/judge.h"
#include "tests/support/thresholds.h"
#include "tools/twinbench/answers.h"
#include "twin/benches/expected.h"
#include "twin/benches/registry.h"
#include "twin/core/errors.h"

namespace twinbench::shelf {
namespace {

const std::string kFolder = TWINBENCH_TEST_DATA "/shelf";

tools::Imported ImportedCase(const std::string& name) {
  const std::string path = kFolder + "/" + name + ".csv";
  tools::ImportWish wish;
  wish.files = {path};
  tools::Imported taken = tools::ImportedFrom(wish);
  plausible::RefuseFatal(DoubtsAbout(taken.readings, taken.scenario), path);
  return taken;
}

std::string Told(const diagnose::Diagnosis& d) {
  std::string words = hidden::Judge({}, d).answer;
  if (d.verdict != diagnose::Verdict::kUnknown && diagnose::HasUnmodelled(d))
    words += " | and " + d.unknown.signature;
  return words;
}

}  // namespace

std::vector<std::string> CaseNames() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    if (entry.path().extension() == ".csv") names.push_back(entry.path().stem());
  }
  std::ranges::sort(names);
  return names;
}

Answer Examine(const std::string& name, bool asks_again) {
  const Truth truth = ReadTruth(kFolder + "/truth.json", name);
  Answer answer;
  answer.truth = InWords(truth);
  try {
    const tools::Imported taken = ImportedCase(name);
    diagnose::DiagnoseOptions options;
    if (asks_again) options.cache_folder = test::ThresholdsFolder();
    const diagnose::DiagnosisRun found = diagnose::Diagnose(taken.readings, taken.scenario, options);
    answer.words = Told(found.diagnosis);
    answer.judged = Judge(truth, found.diagnosis);
    if (asks_again && found.diagnosis.verdict != diagnose::Verdict::kNone && !truth.causes.empty())
      answer.second = hidden::Says(taken.readings, hidden::WrittenFile(taken.scenario, found), options);
  } catch (const InputError& refusal) {
    if (answer.words.empty()) {
      answer.words = std::string("refused: ") + refusal.what();
      answer.judged = {false, false, answer.words};
    } else {
      answer.second = std::string("refused: ") + refusal.what();
    }
  }
  return answer;
}

}  // namespace twinbench::shelf
