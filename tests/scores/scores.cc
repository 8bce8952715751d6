#include <CLI/CLI.hpp>
#include <mutex>

#include "tests/perf/timing.h"
#include "tests/scores/sets.h"
#include "tests/support/in_parallel.h"
#include "twin/core/bench_format.h"
#include "twin/core/scenario_schema.h"
#include "twin/core/whole_file.h"

// Hides causes, has them diagnosed, and keeps case by case how right the answers are.
namespace twinbench::scores {
namespace {

struct Options {
  std::string bench, set, only, read, out, since, page;
  int threads = 2;
  Amount amount;
  std::string command = "tools/scores";  // where things are written to is no part of it
};

Plans PlansOf(const Options& options) {
  Plans plans;
  for (const Set& set : Sets()) {
    if (!options.set.empty() && options.set != set.name) continue;
    for (const std::string& bench : BenchNames()) {
      if (options.bench.empty() || options.bench == bench) Append(set.plans(bench, options.amount), plans);
    }
  }
  std::erase_if(plans, [&](const Plan& plan) { return plan.name.find(options.only) == std::string::npos; });
  if (plans.empty()) throw InputError("scores", "has no such case", "another --set, --bench or --only");
  return plans;
}

Row RowOf(const Plan& plan) {
  Row row{plan.set, plan.bench, Unquoted(plan.name)};
  const double begin_s = perf::Seconds(CLOCK_THREAD_CPUTIME_ID);
  try {
    plan.examine(row);
  } catch (const std::exception& end) {  // one case lost, as in a campaign
    row.marks[kRight] = false;
    row.answer = std::string("ended: ") + end.what();
  }
  row.seconds = perf::Seconds(CLOCK_THREAD_CPUTIME_ID) - begin_s;
  return row;
}

/// Rows are written as they come, too: a run that is stopped keeps those that it has.
Rows Scored(const Plans& plans, const Options& options) {
  Rows rows(plans.size()), done;
  std::mutex reporting;
  test::InParallel(plans.size(), options.threads, [&](std::size_t k) {
    rows[k] = RowOf(plans[k]);
    const std::scoped_lock lock(reporting);
    done.push_back(rows[k]);
    if (!options.out.empty()) WriteFileAtOnce(options.out, Csv(done));
    fmt::print(stderr, "{}/{} {} {} {} [{}] {}: {} {:.1f} s\n", done.size(), plans.size(), rows[k].set, rows[k].bench,
               rows[k].name, rows[k].hidden, rows[k].marks[kRight].value_or(false) ? "right" : "WRONG",
               rows[k].answer.substr(0, 100), rows[k].seconds);
  });
  return rows;
}

std::string PageOf(const Options& options, const std::string& summary) {
  return fmt::format(
      "# Scores\n\nMade by `{} --page FILE` from the top folder; do not edit. What the sets are: `tools/scores "
      "--help`. A name is sure from 0.8 on; \"second run silent\" and \"gain right\" (within 0.05 of what is "
      "stated) are of another run of the same machine with the written file.\n\n{}",
      options.command, summary);
}

/// Before hours are spent on what cannot be written then.
void CheckFolderOf(const std::string& path) {
  if (path.empty()) return;
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  if (!std::filesystem::is_directory(folder))
    throw InputError(path, "cannot be written", "a file in a folder that exists");
}

/// @return the exit code.
int Score(const Options& options) {
  for (const std::string& path : {options.out, options.page}) CheckFolderOf(path);
  const Rows before = options.since.empty() ? Rows{} : ReadRows(options.since);
  const Rows rows = options.read.empty() ? Scored(PlansOf(options), options) : ReadRows(options.read);
  const std::string summary = Summary(rows);
  if (!options.out.empty()) WriteFileAtOnce(options.out, Csv(rows));
  if (!options.page.empty()) WriteFileAtOnce(options.page, PageOf(options, summary));
  fmt::print("{}", summary);
  if (options.since.empty()) return 0;
  const Comparison comparison = Compare(rows, before);
  fmt::print("\n## Since {}\n\n{}", options.since, InWords(comparison));
  return comparison.IsWorse() ? 1 : 0;
}

std::string SetsInWords() {
  std::string text = "Sets:\n";
  for (const Set& set : Sets()) text += fmt::format("  {:<14} {}\n", set.name, set.words);
  return text +
         "\nExit code: 0; 1 if with --since a mark of all cases together has become worse at p <= 0.05; 2 if a "
         "file cannot be read or written.";
}

std::vector<std::string> SetNames() {
  std::vector<std::string> names;
  for (const Set& set : Sets()) names.push_back(set.name);
  return names;
}

void SetCommand(Options& options) {
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) options.command += fmt::format(" {} {}", name, value);
  };
  add("--bench", options.bench);
  add("--set", options.set);
  add("--only", options.only);
  if (options.amount.is_long) options.command += " --long";
  add("--first-seed", options.amount.first_seed == 1 ? "" : std::to_string(options.amount.first_seed));
}

}  // namespace
}  // namespace twinbench::scores

int main(int argc, char** argv) {
  using namespace twinbench::scores;
  CLI::App app("Hides causes in readings, has them diagnosed, and keeps case by case how right the answers are");
  Options options;
  app.footer(SetsInWords());
  app.add_option("--bench", options.bench, "only this one")->check(CLI::IsMember(twinbench::BenchNames()));
  app.add_option("--set", options.set, "only this one")->check(CLI::IsMember(SetNames()));
  app.add_option("--only", options.only, "only cases with this in their name");
  app.add_flag("--long", options.amount.is_long, "some four times as many cases: for the night");
  app.add_option("--first-seed", options.amount.first_seed, "other seeds, other cases")->capture_default_str();
  app.add_option("--threads", options.threads, "cases at a time")->check(CLI::Range(1, 64))->capture_default_str();
  app.add_option("--read", options.read, "run nothing: summary, page and comparison of this file");
  app.add_option("-o", options.out, "write one row a case here (CSV)");
  app.add_option("--since", options.since, "compare with this earlier file, case by case");
  app.add_option("--page", options.page, "write the summary here (Markdown)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& refusal) {
    return app.exit(refusal) == 0 ? 0 : 2;
  }
  SetCommand(options);
  try {
    return Score(options);
  } catch (const std::runtime_error& refusal) {
    fmt::print(stderr, "{}\n", refusal.what());
    return 2;
  }
}
