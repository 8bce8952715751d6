#include "twin/diagnose/folds.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "twin/diagnose/at.h"

namespace twinbench::diagnose {
namespace {

constexpr int kBlockReadings = 6;
constexpr int kMostFolds = 20;  // more passes are left out several at a time
constexpr int kTimeFolds = 4;  // of a run without repeated passes
constexpr int kShortSweep = kTimeFolds * kBlockReadings;

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

/// A calibration in which the target itself moves, by few steps.
bool IsShortSweep(const Schedule& s) {
  int count = 0;
  double least_rad = kNaN, most_rad = kNaN;
  for (int i = 0; i < s.Readings(); ++i) {
    if (s.phase[At(i)] != Phase::kCalibration) continue;
    ++count;
    least_rad = std::fmin(least_rad, s.target_rad[i]);
    most_rad = std::fmax(most_rad, s.target_rad[i]);
  }
  return count < kShortSweep && most_rad > least_rad;
}

/// Readings of a block of the calibration: a short sweep is taken apart reading by reading, or its scale would have
/// to be predicted from one end of it.
int CalibrationBlock(const Schedule& s) {
  return IsShortSweep(s) ? 1 : kBlockReadings;
}

/// Folds by blocks of time for all readings that have none. Every circle begins with another fold than the one
/// before: positions that one leaves out are in the others.
void AddFoldsOfTime(const Schedule& s, Folds& folds) {
  const int in_calibration = CalibrationBlock(s);
  int in_turn = 0;                                  // in readings of a usual block
  std::map<std::pair<int, int>, int> circle, read;  // by set-up and pass
  for (int i = 0; i < s.Readings(); ++i) {
    int& fold = folds.of_reading[At(i)];
    if (fold >= 0) continue;
    if (s.phase[At(i)] == Phase::kFullCircle) {
      const std::pair<int, int> of = {s.setup[At(i)], s.pass[At(i)]};
      const int number = circle.try_emplace(of, static_cast<int>(circle.size())).first->second;
      fold = (read[of]++ / kBlockReadings + number) % folds.count;
      continue;
    }
    fold = in_turn / kBlockReadings % folds.count;
    in_turn += s.phase[At(i)] == Phase::kCalibration ? kBlockReadings / in_calibration : 1;
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
    const int place = static_cast<int>(std::find(known.begin(), known.end(), s.pass[At(i)]) - known.begin()) % kMostFolds;
    folds.of_reading[At(i)] = place;
    folds.count = std::max(folds.count, place + 1);
  }
  if (folds.count == 0) folds.count = kTimeFolds;
  AddFoldsOfTime(s, folds);
  return folds;
}

Folds FoldsOfTime(const Schedule& s) {
  Folds folds{std::vector<int>(At(s.Readings()), -1), kTimeFolds};
  AddFoldsOfTime(s, folds);
  return folds;
}

std::vector<int> BlocksOfReadings(const Schedule& s) {
  using Sweep = std::tuple<int, int, int>;  // set-up, pass, readings of a block
  std::map<Sweep, int> seen;                // readings so far
  std::map<std::pair<Sweep, int>, int> number;
  std::vector<int> block(At(s.Readings()));
  const int in_calibration = CalibrationBlock(s);
  for (int i = 0; i < s.Readings(); ++i) {
    const int length = s.phase[At(i)] == Phase::kCalibration ? in_calibration : kBlockReadings;
    const Sweep sweep = {s.setup[At(i)], s.pass[At(i)], length};
    const int in_sweep = seen[sweep]++ / length;
    block[At(i)] = number.try_emplace({sweep, in_sweep}, static_cast<int>(number.size())).first->second;
  }
  return block;
}

}  // namespace twinbench::diagnose
