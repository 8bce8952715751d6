#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/textbook.h"

namespace twinbench::diagnose::screen {
namespace {

/// A way to sort the rows.
struct Sorting {
  std::string name;                         // "pass"
  std::vector<std::string> group = {};      // "pass 3"
  std::vector<std::vector<int>> rows = {};  // one a group
  Eigen::ArrayXd dof = {};                  // what the unknowns leave of each
};

using Label = std::pair<Phase, int>;

std::string GroupName(const std::string& sorting, Label label) {
  std::string name = fmt::format("{} {}", sorting, label.second);
  if (sorting == "direction") name = label.second > 0 ? "forward" : label.second < 0 ? "backward" : "at rest";
  return label.first == Phase::kFullCircle ? name : fmt::format("{} ({})", name, PhaseName(label.first));
}

/// Groups that leave enough to compare.
void AddSorting(const Judged& judged, const std::string& name, const std::vector<int>& number,
                std::vector<Sorting>& all) {
  constexpr double kLeastDof = 2.0;
  std::map<Label, std::vector<int>> rows;
  for (const std::vector<int>& of_channel : judged.rows) {
    for (const int row : of_channel) {
      const int i = judged.run.ReadingOf(row);
      rows[{judged.run.schedule.phase[i], number[i]}].push_back(row);
    }
  }
  Sorting sorting{name};
  std::vector<double> dof;
  for (auto& [label, of_group] : rows) {
    if (const double left = judged.redundancy(of_group).sum(); left >= kLeastDof) {
      sorting.group.push_back(GroupName(name, label));
      sorting.rows.push_back(std::move(of_group));
      dof.push_back(left);
    }
  }
  sorting.dof = Eigen::ArrayXd::Map(dof.data(), std::ssize(dof));
  if (dof.size() > 1) all.push_back(std::move(sorting));
}

Sorting ByChannel(const Judged& judged) {
  Sorting sorting{"channel"};
  const std::vector<int> channels = judged.Channels(8);
  sorting.dof.resize(std::ssize(channels));
  for (const int c : channels) {
    sorting.dof[std::ssize(sorting.rows)] = judged.redundancy(judged.rows[c]).sum();
    sorting.group.push_back(judged.run.channels[c]);
    sorting.rows.push_back(judged.rows[c]);
  }
  return sorting;
}

std::vector<Sorting> AllSortings(const Judged& judged) {
  const Schedule& s = judged.run.schedule;
  std::vector<Sorting> all;
  if (Sorting channels = ByChannel(judged); channels.rows.size() > 1) all.push_back(std::move(channels));
  AddSorting(judged, "mounting", s.setup, all);
  AddSorting(judged, "pass", s.pass, all);
  AddSorting(judged, "direction", s.direction, all);
  AddSorting(judged, "measuring position", s.position, all);
  return all;
}

/// Squares of all rows, as they are and in units of the mean square of each channel.
struct Squares {
  Eigen::ArrayXd plain, levelled;

  Eigen::ArrayXd SumsOf(const Sorting& sorting) const {
    const Eigen::ArrayXd& squares = sorting.name == "channel" ? plain : levelled;
    return Eigen::ArrayXd::NullaryExpr(std::ssize(sorting.rows),
                                       [&](Eigen::Index g) { return squares(sorting.rows[g]).sum(); });
  }
};

Squares SquaresOf(const Judged& judged, const Eigen::VectorXd& residual) {
  Squares squares{residual.array().square(), residual.array().square()};
  for (const std::vector<int>& rows : judged.rows) {
    const double sum = squares.plain(rows).sum();
    if (sum > 0.0) squares.levelled(rows) *= judged.redundancy(rows).sum() / sum;
  }
  return squares;
}

/// Root mean square of each group over that of all others.
Eigen::ArrayXd Ratios(const Eigen::ArrayXd& sums, const Eigen::ArrayXd& dof) {
  return (sums / dof / ((sums.sum() - sums) / (dof.sum() - dof)).max(1e-300)).max(1e-300).sqrt();
}

void TellGroups(const Judged& judged, const Sorting& sorting, const Eigen::VectorXd& residual, ResidualTest& test) {
  const LinearRun& run = judged.run;
  const Eigen::ArrayXd sums = SquaresOf(judged, residual).SumsOf(sorting), ratio = Ratios(sums, sorting.dof);
  int most = 0, least = 0;
  const Eigen::ArrayXd deviation = ratio.log() * sorting.dof.sqrt();
  deviation.maxCoeff(&most);
  deviation.minCoeff(&least);
  test.statistic = Bartlett(sums, sorting.dof);
  const int channel = run.ChannelOf(sorting.rows[most].front());
  if (sorting.name == "channel") SetEffect(run, channel, Beside(TypicalSigma(run, channel), ratio[most]), test);
  test.reading = fmt::format(
      "residuals differ by {}: {} has {:.2f} times, {} {:.2f} times the rms of all others: more noise, or an "
      "error, "
      "that is there only",
      sorting.name, sorting.group[most], ratio[most], sorting.group[least], ratio[least]);
}

}  // namespace

/// Bartlett's test, about the known mean zero, of each way to sort the rows.
std::optional<Test> VarianceByGroup(const Judged& judged) {
  const std::vector<Sorting> sortings = AllSortings(judged);
  if (sortings.empty()) return std::nullopt;
  Test test{.name = "variance by group"};
  for (const Sorting& sorting : sortings) test.items.push_back("by " + sorting.name);
  test.scores = [&judged, sortings](const Eigen::MatrixXd& residual) {
    return ByColumn(residual, [&](const Eigen::VectorXd& of_run) {
      const Squares squares = SquaresOf(judged, of_run);
      return Eigen::VectorXd(Eigen::VectorXd::NullaryExpr(std::ssize(sortings), [&](Eigen::Index k) {
        const Eigen::ArrayXd& dof = sortings[k].dof;
        return NormalScore(Bartlett(squares.SumsOf(sortings[k]), dof), static_cast<double>(dof.size() - 1));
      }));
    });
  };
  test.tell = [&judged, sortings](int item, const Eigen::VectorXd& residual, ResidualTest& told) {
    TellGroups(judged, sortings[item], residual, told);
  };
  return test;
}

}  // namespace twinbench::diagnose::screen
