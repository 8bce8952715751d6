#include <fcntl.h>
#include <sys/resource.h>
#include <sys/time.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "tests/fuzz/target.h"
#include "tests/perf/timing.h"
#include "tests/support/sanitized.h"

/// Feeds every target its seeds and inputs made of them, without a fuzzer: `fuzz [--seconds s] [--only target] [file ...]`.
/// `fuzz --write DIR` writes the seeds into a folder a target, where libFuzzer begins.
/// An input that ends the program, throws what is no answer, takes longer than kMost_s or more memory than kMost_KB is written to
/// fuzz-<target>-<what> in the working folder.
namespace twinbench::fuzz {
namespace {

namespace fs = std::filesystem;

using test::kSanitized;

constexpr int kMost_s = kSanitized ? 20 : 2;                 // of processor time, for one input
constexpr long kMost_KB = kSanitized ? 2'000'000 : 400'000;     // of memory, at any time
constexpr std::size_t kLargestSeed = 1 << 18;

struct Wanted {
  double seconds = 0.25;  // of processor time, a target
  std::string only, write_to;
  std::vector<std::string> files;
};

/// What a signal handler may look at.
std::string now_read, now_target;

void KeepInput(const char* what) {
  const std::string path = "fuzz-" + now_target + "-" + what;
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const bool kept = file >= 0 && write(file, now_read.data(), now_read.size()) == static_cast<ssize_t>(now_read.size());
  std::fprintf(stderr, "%s: %s; the input is %s\n", now_target.c_str(), what, kept ? path.c_str() : "lost");
}

void OnSignal(int signal) {
  KeepInput(signal == SIGVTALRM ? "hang" : "crash");
  _exit(1);
}

long Peak_KB() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return used.ru_maxrss;
}

/// From here on the peak is of what comes.
void ForgetPeak() {
  std::ofstream("/proc/self/clear_refs") << "5";
}

/// Strikes OnSignal.
void GiveUpAfter(int seconds) {
  itimerval timer{};
  timer.it_value.tv_sec = seconds;
  setitimer(ITIMER_VIRTUAL, &timer, nullptr);
}

bool Read(const Target& target, std::string input) {
  now_read = std::move(input);
  GiveUpAfter(kMost_s);
  try {
    target.read(now_read);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", target.name, error.what());
    KeepInput("throw");
    return false;
  }
  if (Peak_KB() <= kMost_KB) return true;
  KeepInput("memory");
  return false;
}

void AddSeeds(const fs::path& place, std::vector<std::string>& seeds) {
  std::vector<fs::path> files;
  if (fs::is_directory(place)) {
    for (const auto& entry : fs::directory_iterator(place)) files.push_back(entry.path());
  } else if (fs::exists(place)) {
    files.push_back(place);
  }
  std::ranges::sort(files);
  for (const fs::path& file : files) {
    if (fs::is_regular_file(file) && fs::file_size(file) <= kLargestSeed) seeds.push_back(BytesOfFile(file));
  }
}

std::vector<std::string> SeedsOf(const Target& target) {
  const fs::path root = TWINBENCH_SOURCE_DIR;
  std::vector<std::string> seeds;
  std::istringstream places(target.seeds);
  for (std::string place; places >> place;) AddSeeds(root / place, seeds);
  AddSeeds(root / "tests/data/fuzz" / target.name, seeds);
  if (target.made_seeds) std::ranges::move(target.made_seeds(), std::back_inserter(seeds));
  return seeds;
}

/// @return whether every input was answered.
bool Try(const Target& target, const Wanted& wanted) {
  now_target = target.name;
  const std::vector<std::string> seeds = SeedsOf(target);
  if (seeds.empty()) {
    std::fprintf(stderr, "%s: there is no seed\n", target.name);
    return false;
  }
  const double begin_s = perf::Seconds();
  for (const std::string& seed : seeds) {
    if (!Read(target, seed)) return false;
  }
  std::uint64_t number = 0;
  while (perf::Seconds() - begin_s < wanted.seconds) {
    if (!Read(target, Mutated(seeds, number++))) return false;
  }
  std::printf("%-14s %3zu seeds, %7llu made of them, %.2f s\n", target.name, seeds.size(),
              static_cast<unsigned long long>(number), perf::Seconds() - begin_s);
  return true;
}

bool TryFiles(const Target& target, const Wanted& wanted) {
  now_target = target.name;
  return std::ranges::all_of(wanted.files, [&](const std::string& file) { return Read(target, BytesOfFile(file)); });
}

bool WriteSeeds(const Target& target, const std::string& folder) {
  const fs::path place = fs::path(folder) / target.name;
  fs::create_directories(place);
  int number = 0;
  for (const std::string& seed : SeedsOf(target)) {
    std::ofstream out(place / std::to_string(number++), std::ios::binary);
    if (!(out << seed)) return false;
  }
  return number > 0;
}

bool Treat(const Target& target, const Wanted& wanted) {
  ForgetPeak();
  if (!wanted.write_to.empty()) return WriteSeeds(target, wanted.write_to);
  return wanted.files.empty() ? Try(target, wanted) : TryFiles(target, wanted);
}

Wanted Parse(int argc, char** argv) {
  Wanted wanted;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    const bool has_next = k + 1 < argc;
    if (word == "--seconds" && has_next) wanted.seconds = std::stod(argv[++k]);
    else if (word == "--only" && has_next) wanted.only = argv[++k];
    else if (word == "--write" && has_next) wanted.write_to = argv[++k];
    else wanted.files.push_back(word);
  }
  return wanted;
}

}  // namespace
}  // namespace twinbench::fuzz

int main(int argc, char** argv) {
  using namespace twinbench::fuzz;
  const Wanted wanted = Parse(argc, argv);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGVTALRM}) std::signal(signal, OnSignal);
  bool good = true, any = false;
  for (const Target& target : Targets()) {
    if (!wanted.only.empty() && wanted.only != target.name) continue;
    any = true;
    good = Treat(target, wanted) && good;
  }
  if (!any) std::fprintf(stderr, "there is no target %s\n", wanted.only.c_str());
  return good && any ? 0 : 1;
}
