#include <fmt/core.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <thread>

#include "tests/foreign/foreign_sections.h"
#include "tests/foreign/plans.h"
#include "twin/benches/names.h"
#include "twin/core/bench_format.h"
#include "twin/core/errors.h"

// Has machines diagnosed that share nothing with the program, and prints how true the answers are.
namespace twinbench::foreign {
namespace {

namespace fs = std::filesystem;

struct Options {
  int each = 2, several = 56, clean = 400, twins = 6, threads = 1;
  std::uint64_t first_seed = 1;
  std::string only, out, cases, keep;
};

/// Thresholds of this run only: those of another version of the engine would be wrong.
class TemporaryFolder {
 public:
  TemporaryFolder() { fs::create_directories(path_); }
  ~TemporaryFolder() { fs::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string Path() const { return path_; }

 private:
  fs::path path_ = fs::temp_directory_path() / fmt::format("twinbench-foreign-score-{}", ::getpid());
};

std::vector<Plan> PlansOf(const Options& o, const std::string& cache_folder) {
  std::vector<Plan> plans = KindPlans(o.each, o.first_seed);
  for (const auto& part : {SeveralPlans(o.several, o.first_seed), CleanPlans(o.clean, o.first_seed),
                           TwinPlans(o.twins, o.first_seed, cache_folder)})
    plans.insert(plans.end(), part.begin(), part.end());
  std::erase_if(plans,
                [&](const Plan& plan) { return (plan.set + " " + plan.name).find(o.only) == std::string::npos; });
  return plans;
}

/// Readings and scenario of a case, for whoever wants to look at it with the program.
void Keep(const Plan& plan, const std::string& folder) {
  const Machine machine = plan.make();
  std::string name = plan.set + " " + plan.name;
  std::ranges::replace_if(
      name, [](char c) { return c == ' ' || c == '/' || c == ':' || c == ','; }, '_');
  const fs::path at = fs::path(folder) / name;
  fs::create_directories(at);
  WriteReadingsCsv(machine.readings({}), machine.believed.bench, (at / "readings.csv").string());
  WriteReadingsCsv(machine.readings({2, false, true}), machine.believed.bench, (at / "another_run.csv").string());
  std::ofstream(at / "scenario.toml") << WriteScenario(machine.believed);
}

Answers ExamineAll(const std::vector<Plan>& plans, const Options& o, const std::string& cache_folder) {
  Answers answers(plans.size());
  std::atomic<std::size_t> next = 0;
  std::mutex reporting;
  int done = 0;
  const auto work = [&] {
    for (std::size_t k = next++; k < plans.size(); k = next++) {
      answers[k] = Examine(plans[k], cache_folder);
      const std::lock_guard lock(reporting);
      fmt::print(stderr, "{}/{} {} {}: {} {:.1f} s\n", ++done, plans.size(), plans[k].set, plans[k].name,
                 answers[k].outcome.answer.substr(0, 100), answers[k].outcome.seconds);
    }
  };
  std::vector<std::thread> workers;
  for (int k = 0; k < o.threads; ++k) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  return answers;
}

std::string CommandOf(const Options& o) {
  const std::string only = o.only.empty() ? "" : fmt::format(" --only \"{}\"", o.only);
  return fmt::format("foreign_score --each {} --several {} --clean {} --twins {} --first-seed {}{}", o.each,
                     o.several, o.clean, o.twins, o.first_seed, only);
}

void Score(const Options& o) {
  const TemporaryFolder cache;
  const std::vector<Plan> plans = PlansOf(o, cache.Path());
  if (!o.keep.empty()) {
    for (const Plan& plan : plans) Keep(plan, o.keep);
    return;
  }
  const Answers answers = ExamineAll(plans, o, cache.Path());
  const std::string text = fmt::format(
      "# Score of the diagnosis on foreign machines\n\nMade by `{}` from the top folder; do not edit.\n\n{}",
      CommandOf(o), ForeignTables(answers));
  if (!o.cases.empty()) std::ofstream(o.cases) << ForeignCsv(answers);
  if (!o.out.empty()) std::ofstream(o.out) << text;
  if (o.out.empty()) fmt::print("{}", text);
}

}  // namespace
}  // namespace twinbench::foreign

int main(int argc, char** argv) {
  CLI::App app("Diagnoses machines that share nothing with the program, and scores the answers");
  twinbench::foreign::Options o;
  app.add_option("--each", o.each, "machines of each kind that the catalogue lacks")->capture_default_str();
  app.add_option("--several", o.several, "machines with several causes")->capture_default_str();
  app.add_option("--clean", o.clean, "machines in order")->capture_default_str();
  app.add_option("--twins", o.twins, "causes on each bench without a foreign generator")->capture_default_str();
  app.add_option("--first-seed", o.first_seed, "other seeds, other machines")->capture_default_str();
  app.add_option("--only", o.only, "only cases with this in their set and name");
  app.add_option("--threads", o.threads, "cases at a time")->check(CLI::Range(1, 64));
  app.add_option("--out", o.out, "write the score here instead of stdout");
  app.add_option("--cases", o.cases, "write one row a case here");
  app.add_option("--keep", o.keep, "diagnose nothing: write readings and scenario of each case below this folder");
  CLI11_PARSE(app, argc, argv);
  try {
    twinbench::foreign::Score(o);
  } catch (const twinbench::InputError& refusal) {
    fmt::print(stderr, "{}\n", refusal.what());
    return 1;
  }
  return 0;
}
