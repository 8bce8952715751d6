#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/units.h"
#include "twin/diagnose/hob/collector.h"

namespace twinbench::diagnose::hob {
namespace {

/// Time from 0 to 1 over each mounting, or over the whole run.
Eigen::VectorXd OverMounting(const SignalContext& c) {
  const Eigen::VectorXd since_s = SinceMounting_s(c);
  return since_s / std::max(since_s.maxCoeff(), 1e-6);
}
Eigen::VectorXd OverRun(const SignalContext& c) {
  const Eigen::VectorXd t_s = c.schedule.time_s.array() - c.schedule.time_s[0];
  return t_s / std::max(t_s.maxCoeff(), 1e-6);
}

/// Each mounting has a wander of its own: nobody sees what goes on between them.
void AddWander(Collector& collect) {
  constexpr int kTerms = 8;
  const SignalContext& c = collect.context();
  const Eigen::ArrayXd phase = units::kPi * OverMounting(c).array();
  const auto term = [phase, setups = SetUps(c)](int g) {
    return InEachSetUp(((g + 1) * phase).cos().matrix(), setups);
  };
  collect.Add({"wander"}, BaseOf(collect.common().context, kTerms, term),
              [](int g) { return fmt::format("slow wander locked to time, {} half periods a mounting", g + 1); });
  Eigen::MatrixXd all(c.Samples(), 0);
  for (int g = 0; g < kTerms / 2; ++g) {
    const Eigen::MatrixXd one = term(g);
    all.conservativeResize(Eigen::NoChange, all.cols() + one.cols());
    all.rightCols(one.cols()) = one;
  }
  collect.Add({"wander"}, all, "slow wander locked to time");
}

void AddTones(Collector& collect) {
  const Common& common = collect.common();
  if (!common.tones) return;
  const Shape frequency{
      "frequency",          "Hz", 1.0, 0.5 * common.frequencies_Hz.front(), 1.1 * common.frequencies_Hz.back(),
      common.frequencies_Hz};
  collect.AddOver(
      {"tone", kSameShape}, frequency, common.tones,
      [context = common.context](const Eigen::VectorXd& f_Hz) { return Tone(*context, f_Hz[0]); },
      [values = common.frequencies_Hz](int g) {
        return fmt::format("tone at {:.4g} Hz locked to time", values[static_cast<std::size_t>(g)]);
      });
}

}  // namespace

void AddInTime(Collector& collect) {
  const SignalContext& c = collect.context();
  collect.Add({"trend", kSameShape}, Unit(OverRun(c)), "linear trend locked to time");
  collect.Add({"step", kSameShape}, collect.common().steps, [onsets = collect.common().onsets](int g) {
    return fmt::format("step at reading {} locked to time", onsets[static_cast<std::size_t>(g)]);
  });
  AddWander(collect);
  AddTones(collect);
  collect.AddModulated({"growing harmonic"}, std::min(24, collect.common().table_orders->grid), OverRun(c),
                       "order {} locked to table angle that grows with time");
}

namespace {

Eigen::MatrixXd Indicators(const std::vector<int>& label) {
  std::vector<int> values = label;
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  Eigen::MatrixXd indicators = Eigen::MatrixXd::Zero(std::ssize(label), std::ssize(values));
  for (std::size_t i = 0; i < label.size(); ++i)
    indicators(static_cast<Eigen::Index>(i), std::ranges::lower_bound(values, label[i]) - values.begin()) = 1.0;
  return indicators;
}

/// Waves of low orders that differ from one value of a label to the next.
void AddByLabel(Collector& collect, const std::string& what, const Eigen::MatrixXd& which, int last) {
  const auto waves = [orders_rad = collect.context().table_rad, which](int g) {
    return InEachSetUp(Wave((g + 1) * orders_rad), which);
  };
  collect.Add({what + " harmonic"}, BaseOf(collect.common().context, last, waves), [what](int g) {
    return fmt::format("order {} locked to table angle that differs from {} to {}", g + 1, what, what);
  });
}

}  // namespace

void AddByMounting(Collector& collect) {
  constexpr Eigen::Index kMost = 24;
  const SignalContext& c = collect.context();
  std::vector<int> passes;  // those of different mountings are different
  for (std::size_t i = 0; i < c.schedule.pass.size(); ++i)
    passes.push_back(100000 * c.schedule.setup[i] + c.schedule.pass[i]);
  const Eigen::MatrixXd pass = Indicators(passes), setup = Indicators(c.schedule.setup);
  if (pass.cols() > setup.cols() && pass.cols() <= kMost) {
    collect.Add({"pass"}, pass, "offset of each pass, locked to the pass");
    AddByLabel(collect, "pass", pass, 3);
  }
  if (setup.cols() > 1 && setup.cols() <= kMost) AddByLabel(collect, "set-up", setup, 6);
}

}  // namespace twinbench::diagnose::hob
