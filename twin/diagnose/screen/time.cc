#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr int kWaves = 8;
constexpr std::array<double, 4> kDecays = {0.01, 0.03, 0.1, 0.3};  // time constant / duration of the run

/// Half cosine waves over the run, 1 to 8.
void TestWander(const Sample& s, const Eigen::VectorXd& part, Tests& tests) {
  Scan scan{{Eigen::MatrixXd(part.size(), kWaves)}, 1};
  ScanWords words{"time: wander", {}, "a slow change in the room, the source or a mounting"};
  for (int k = 1; k <= kWaves; ++k) {
    scan.shapes[0].col(k - 1) = (std::numbers::pi * k * part.array()).cos();
    words.items.push_back(fmt::format("{} half wave{} over the run", k, k == 1 ? "" : "s"));
  }
  Keep(TestScan(s, scan, words), tests);
}

void TestDrift(const Sample& s, const Eigen::VectorXd& part, Tests& tests) {
  const ScanWords words{"time: drift", {"the time"}, "steady drift of the source, a detector or a mounting"};
  Keep(TestScan(s, {{part}, 1}, words), tests);
}

/// Logarithm of the time since the set-up began: amplitude per decade, at scales of 10 s to 10 min.
void TestCreep(const Sample& s, const Eigen::VectorXd& in_setup_s, Tests& tests) {
  Scan scan{{Eigen::MatrixXd(in_setup_s.size(), 3)}, 1};
  ScanWords words{"time: creep", {}, "a mounting that creeps after it was clamped (amplitude per decade)"};
  for (double scale_s : {10.0, 60.0, 600.0}) {
    scan.shapes[0].col(static_cast<Eigen::Index>(words.items.size())) =
        (1.0 + in_setup_s.array() / scale_s).log10();
    words.items.push_back(fmt::format("the logarithm of 1 + time in the set-up / {:.0f} s", scale_s));
  }
  Keep(TestScan(s, scan, words), tests);
}

void TestWarmUp(const Sample& s, const Eigen::VectorXd& part, const Eigen::VectorXd& in_setup, Tests& tests) {
  Scan scan{{Eigen::MatrixXd(part.size(), 2 * std::ssize(kDecays))}, 1};
  ScanWords words{"time: exponential", {}, "warming up, or relaxing after it was touched"};
  for (const auto& [time, since] :
       {std::pair(part, "start of the run"), std::pair(in_setup, "start of the set-up")}) {
    for (double decay : kDecays) {
      scan.shapes[0].col(static_cast<Eigen::Index>(words.items.size())) = (-time.array() / decay).exp();
      words.items.push_back(
          fmt::format("an exponential since the {} that decays in {:.2g} of the run", since, decay));
    }
  }
  Keep(TestScan(s, scan, words), tests);
}

}  // namespace

Tests TestTime(const Sample& sample) {
  const Schedule& schedule = sample.run.schedule;
  Tests tests;
  if (!Varies(schedule.time_s)) return tests;
  const double start_s = schedule.time_s.minCoeff(), duration_s = schedule.time_s.maxCoeff() - start_s;
  const Eigen::VectorXd part = (schedule.time_s.array() - start_s) / duration_s;
  const Eigen::VectorXd in_setup_s = TimeInSetup_s(schedule);
  TestWander(sample, part, tests);
  TestDrift(sample, part, tests);
  TestCreep(sample, in_setup_s, tests);
  TestWarmUp(sample, part, in_setup_s / duration_s, tests);
  return tests;
}

}  // namespace twinbench::diagnose::screen
