#include "twin/diagnose/folds.h"

#include <algorithm>
#include <map>
#include <utility>

namespace twinbench::diagnose {
namespace {

constexpr int kBlockReadings = 6;
constexpr int kTimeFolds = 4;  // of a run without repeated passes

std::size_t At(int i) {
  return static_cast<std::size_t>(i);
}

/// The full-circle passes of each set-up in the order of their first readings.
std::map<int, std::vector<int>> PassesOfSetups(const Schedule& s) {
  std::map<int, std::vector<int>> passes;
  for (int i = 0; i < s.Readings(); ++i) {
    if (s.phase[At(i)] != Phase::kFullCircle) continue;
    std::vector<int>& known = passes[s.setup[At(i)]];
    if (std::find(known.begin(), known.end(), s.pass[At(i)]) == known.end()) known.push_back(s.pass[At(i)]);
  }
  return passes;
}

/// Folds by blocks of time for all readings that have none.
void AddFoldsOfTime(Folds& folds) {
  int in_turn = 0;
  for (int& fold : folds.of_reading) {
    if (fold < 0) fold = in_turn++ / kBlockReadings % folds.count;
  }
}

}  // namespace

Folds MakeFolds(const Schedule& s) {
  const auto passes = PassesOfSetups(s);
  Folds folds{std::vector<int>(At(s.Readings()), -1), 0};
  for (int i = 0; i < s.Readings(); ++i) {
    if (s.phase[At(i)] != Phase::kFullCircle) continue;
    const std::vector<int>& known = passes.at(s.setup[At(i)]);
    if (known.size() < 2) continue;
    const auto place = std::find(known.begin(), known.end(), s.pass[At(i)]) - known.begin();
    folds.of_reading[At(i)] = static_cast<int>(place);
    folds.count = std::max(folds.count, static_cast<int>(place) + 1);
  }
  if (folds.count == 0) folds.count = kTimeFolds;
  AddFoldsOfTime(folds);
  return folds;
}

Folds FoldsOfTime(const Schedule& s) {
  Folds folds{std::vector<int>(At(s.Readings()), -1), kTimeFolds};
  AddFoldsOfTime(folds);
  return folds;
}

std::vector<int> BlocksOfReadings(const Schedule& s) {
  std::map<std::pair<int, int>, int> seen;  // readings of a set-up and pass so far
  std::map<std::pair<std::pair<int, int>, int>, int> number;
  std::vector<int> block(At(s.Readings()));
  for (int i = 0; i < s.Readings(); ++i) {
    const std::pair<int, int> sweep = {s.setup[At(i)], s.pass[At(i)]};
    const int in_sweep = seen[sweep]++ / kBlockReadings;
    block[At(i)] = number.try_emplace({sweep, in_sweep}, static_cast<int>(number.size())).first->second;
  }
  return block;
}

}  // namespace twinbench::diagnose
