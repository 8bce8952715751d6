#include "tests/hidden/known_wrong.h"

#include <regex>

#include "tests/support/in_parallel.h"
#include "tests/support/thresholds.h"
#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/core/whole_file.h"

namespace twinbench::hidden {
namespace {

const std::string kPath = TWINBENCH_TEST_DATA "/known_wrong.txt";

std::string Key(const std::string& set, const std::string& name) { return set + " | " + name; }

std::string WordsOf(const Outcome& o) {
  return fmt::format("hides {} (rho {:.0f}): {}", InWords(o.hidden), o.hidden.rho, o.answer);
}

KnownWrong EntryOf(const std::string& line, const std::string& place) {
  static const std::regex entry(R"(\s*(.*?)\s*\|\s*(.*?)\s*\|\s*(.*\S)\s*)");
  std::smatch parts;
  if (!std::regex_match(line, parts, entry)) throw InputError(place, "is \"" + line + "\"", "set | case | why it is wrong");
  return {parts[1], parts[2], parts[3]};
}

std::string InLines(const std::string& title, const std::vector<std::string>& cases) {
  std::string text = cases.empty() ? "" : "\n" + title;
  for (const std::string& one : cases) text += "\n  " + one;
  return text;
}

/// An InputError is the outcome kRefused.
Outcome OutcomeOf(const Plan& plan) {
  const Case made = plan.make();
  const diagnose::DiagnoseOptions quick = test::QuickOptions();
  diagnose::DiagnoseOptions options = made.options;
  options.cache_folder = quick.cache_folder;
  options.null_runs = std::min(options.null_runs, quick.null_runs);
  Outcome outcome;
  try {
    outcome = Judge(made.hidden, diagnose::Diagnose(made.readings, made.scenario, options).diagnosis);
  } catch (const InputError& refusal) {
    outcome.hidden = made.hidden;
    outcome.answer = std::string("refused: ") + refusal.what();
  }
  outcome.set = plan.set;
  outcome.name = plan.name;
  return outcome;
}

}  // namespace

std::vector<Answered> AnsweredOf(const std::vector<Outcome>& outcomes) {
  std::vector<Answered> answered;
  for (const Outcome& o : outcomes) answered.push_back({o.set, o.name, IsRight(o), WordsOf(o)});
  return answered;
}

std::vector<KnownWrong> ParseKnownWrong(const std::string& text, const std::string& path) {
  std::istringstream in(text);
  std::vector<KnownWrong> known;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (!line.empty() && line.front() != '#') known.push_back(EntryOf(line, fmt::format("{}:{}", path, number)));
  }
  return known;
}

const std::vector<KnownWrong>& KnownWrongCases() {
  static const std::vector<KnownWrong> known = ParseKnownWrong(BytesOfFile(kPath), kPath);
  return known;
}

::testing::AssertionResult WrongOnlyWhereKnown(const std::vector<Answered>& answered,
                                               const std::vector<KnownWrong>& known) {
  std::set<std::string> sets, expected;
  for (const Answered& a : answered) sets.insert(a.set);
  for (const KnownWrong& k : known) {
    if (sets.contains(k.set)) expected.insert(Key(k.set, k.name));
  }
  std::vector<std::string> lost, won;
  for (const Answered& a : answered) {
    const bool is_known = expected.erase(Key(a.set, a.name)) > 0;
    if (a.is_right == is_known) (is_known ? won : lost).push_back(Key(a.set, a.name) + " " + a.words);
  }
  if (lost.empty() && won.empty() && expected.empty()) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << InLines("wrong, and no known one:", lost)
                                       << InLines("right now: take them out of tests/data/known_wrong.txt", won)
                                       << InLines("no case any more: take them out of tests/data/known_wrong.txt",
                                                  {expected.begin(), expected.end()});
}

int FewestOf(int of, double caught) {
  constexpr double kPower = 0.9;
  int fewest = 0;
  while (fewest <= of && ProbabilityOfAtMost(fewest - 1, of, caught) < kPower) ++fewest;
  return fewest;
}

::testing::AssertionResult IsPooledRate(int count, std::size_t of, double claimed, double caught) {
  constexpr double kFalseFailures = 0.02;
  const int cases = static_cast<int>(of), fewest = FewestOf(cases, caught);
  const double fails_anyway = ProbabilityOfAtMost(fewest - 1, cases, claimed);
  if (fails_anyway > kFalseFailures) {
    return ::testing::AssertionFailure() << fmt::format("{} cases do not tell {} from {}: {} of {} would fail", of,
                                                        claimed, caught, fails_anyway, claimed);
  }
  if (count >= fewest) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << count << " of " << of << ", at least " << fewest << " where " << claimed
                                       << " is claimed";
}

::testing::AssertionResult IsShareOf(int count, std::size_t of, double claimed) {
  constexpr double kEachSide = 0.005;
  const int cases = static_cast<int>(of);
  const double so_few = ProbabilityOfAtMost(count, cases, claimed),
               so_many = 1.0 - ProbabilityOfAtMost(count - 1, cases, claimed);
  if (of > 0 && so_few > kEachSide && so_many > kEachSide) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << count << " of " << of << " where " << claimed
                                       << " is claimed: so few have a probability of " << so_few << ", so many of "
                                       << so_many;
}

std::vector<Outcome> RunReduced(const std::vector<Plan>& plans, int threads) {
  std::vector<Outcome> outcomes(plans.size());
  test::InParallel(plans.size(), threads, [&](std::size_t k) { outcomes[k] = OutcomeOf(plans[k]); });
  return outcomes;
}

int CountOf(const std::vector<Outcome>& outcomes, bool (*test)(const Outcome&)) {
  return static_cast<int>(std::ranges::count_if(outcomes, test));
}

std::string Others(const std::vector<Outcome>& outcomes, bool (*right)(const Outcome&)) {
  std::string text;
  for (const Outcome& o : outcomes) {
    if (!right(o)) text += fmt::format("\n  {} {} {}", o.set, o.name, WordsOf(o));
  }
  return text;
}

}  // namespace twinbench::hidden
