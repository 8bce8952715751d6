#include "tests/hidden/score_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

namespace twinbench::hidden {
namespace {

using Outcomes = std::vector<const Outcome*>;
using Test = std::function<bool(const Outcome&)>;

Outcomes Only(const Outcomes& outcomes, const Test& test) {
  Outcomes kept;
  std::ranges::copy_if(outcomes, std::back_inserter(kept), [&](const Outcome* o) { return test(*o); });
  return kept;
}

int Count(const Outcomes& outcomes, const Test& test) {
  return static_cast<int>(std::ranges::count_if(outcomes, [&](const Outcome* o) { return test(*o); }));
}

Test Graded(Grade grade) {
  return [grade](const Outcome& o) { return o.grade == grade; };
}

std::map<std::string, Outcomes> By(const Outcomes& outcomes,
                                   const std::function<std::string(const Outcome&)>& key) {
  std::map<std::string, Outcomes> groups;
  for (const Outcome* o : outcomes) groups[key(*o)].push_back(o);
  return groups;
}

/// The p at which ProbabilityOfAtMost falls to `level`.
double SolveAtMost(int count, int of, double level) {
  double low = 0.0, high = 1.0;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (ProbabilityOfAtMost(count, of, middle) > level ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::string Percent(int count, std::size_t of) {
  return of == 0 ? "-" : fmt::format("{:.0f} %", 100.0 * count / static_cast<double>(of));
}

std::string WithInterval(int count, std::size_t of) {
  if (of == 0) return "-";
  const auto [low, high] = Share{count, static_cast<int>(of)}.Interval95();
  return fmt::format("{}/{} = {:.1f} % ({:.1f} to {:.1f})", count, of, 100.0 * count / static_cast<double>(of),
                     100.0 * low, 100.0 * high);
}

double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return kNaN;
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

bool IsLeaveOneOut(const Outcome& o) {
  return o.set == "leave-one-out";
}
bool IsListed(const Outcome& o) {
  return !o.hidden.causes.empty() && !o.hidden.invisible && !IsLeaveOneOut(o);
}

std::string SetTable(const Outcomes& all) {
  std::string text =
      "## Answers by set\n\n"
      "| set | cases | detected | right name | tie with the truth | right or tie | answered unknown | wrong name | "
      "stated >= 0.9 and wrong |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [set, group] : By(Only(all, IsListed), [](const Outcome& o) { return o.set; })) {
    const auto count = [&group = group](const Test& test) { return Count(group, test); };
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", set, group.size(),
                        Percent(count(&Outcome::Detected), group.size()), count(Graded(Grade::kRight)),
                        count(Graded(Grade::kTie)), WithInterval(count(&Outcome::RightOrTie), group.size()),
                        count(Graded(Grade::kAnsweredUnknown)), count(Graded(Grade::kWrong)),
                        WithInterval(count([](const Outcome& o) { return o.confident_wrong; }), group.size()));
  }
  std::vector<double> sizes;
  for (const Outcome* o :
       Only(all, [](const Outcome& c) { return IsListed(c) && c.verdict == diagnose::Verdict::kTie; }))
    sizes.push_back(o->members);
  return text + fmt::format("\nTies: {}, median size {:.0f}, largest {:.0f}.\n\n", sizes.size(),
                            Quantile(sizes, 0.5), Quantile(sizes, 1.0));
}

std::string Effects(const Outcome& o) {
  std::string names;
  for (const Part& part : o.hidden.causes) names += (names.empty() ? "" : " + ") + part.effect;
  return names;
}

std::string EffectTable(const Outcomes& all) {
  std::string text =
      "## Answers by cause\n\n| set | cause | cases | detected | right | right and more | tie | large tie | partly "
      "| "
      "answered unknown | wrong | missed |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  const Outcomes single = Only(all, [](const Outcome& o) { return IsListed(o) && o.hidden.causes.size() == 1; });
  for (const auto& [key, group] : By(single, [](const Outcome& o) { return o.set + " | " + Effects(o); })) {
    text +=
        fmt::format("| {} | {} | {}", key, group.size(), Percent(Count(group, &Outcome::Detected), group.size()));
    for (const Grade g : {Grade::kRight, Grade::kRightAndMore, Grade::kTie, Grade::kLargeTie, Grade::kPartly,
                          Grade::kAnsweredUnknown, Grade::kWrong, Grade::kMissed})
      text += fmt::format(" | {}", Count(group, Graded(g)));
    text += " |\n";
  }
  return text + "\n";
}

std::string RhoTable(const Outcomes& all) {
  const std::vector<double> edges = {0.0, 5.0, 7.0, 10.0, 14.0, 20.0, 31.0};
  std::string text =
      "## Answers by size\n\nrho is the intended length of the signature after projection, in units of noise.\n\n"
      "| set | rho | cases | detected | right or tie |\n|---|---|---|---|---|\n";
  const Outcomes sized = Only(all, [](const Outcome& o) { return IsListed(o) && std::isfinite(o.hidden.rho); });
  for (const auto& [set, group] : By(sized, [](const Outcome& o) { return o.set; })) {
    for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
      const Outcomes bin =
          Only(group, [&](const Outcome& o) { return o.hidden.rho >= edges[k] && o.hidden.rho < edges[k + 1]; });
      if (bin.empty()) continue;
      text += fmt::format("| {} | {:.0f}-{:.0f} | {} | {} | {} |\n", set, edges[k], edges[k + 1], bin.size(),
                          Percent(Count(bin, &Outcome::Detected), bin.size()),
                          WithInterval(Count(bin, &Outcome::RightOrTie), bin.size()));
    }
  }
  return text + "\n";
}

std::string UnlistedTable(const Outcomes& all) {
  std::string text =
      "## Causes that the catalogue lacks\n\n| set | cause | cases | detected | unknown, right lock and channels | "
      "unknown, others | named | stated >= 0.9 |\n|---|---|---|---|---|---|---|---|\n";
  const Outcomes unlisted = Only(all, [](const Outcome& o) { return !o.hidden.unlisted.empty(); });
  const auto row = [&](const std::string& key, const Outcomes& group) {
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", key, group.size(),
                        Percent(Count(group, &Outcome::Detected), group.size()),
                        WithInterval(Count(group, Graded(Grade::kUnknown)), group.size()),
                        Count(group, Graded(Grade::kUnknownMisplaced)), Count(group, Graded(Grade::kWrong)),
                        Count(group, [](const Outcome& o) { return o.confident_wrong; }));
  };
  for (const auto& [key, group] : By(unlisted, [](const Outcome& o) { return o.set + " | " + o.hidden.unlisted; }))
    row(key, group);
  for (const auto& [set, group] : By(unlisted, [](const Outcome& o) { return o.set; })) row(set + " | all", group);
  return text + "\n";
}

std::string AlarmTable(const Outcomes& all) {
  std::string text =
      "## False alarms\n\n| set | noise | clean runs | alarms (95 % interval) |\n|---|---|---|---|\n";
  const Outcomes clean = Only(all, [](const Outcome& o) { return o.hidden.IsClean(); });
  const auto row = [&](const std::string& key, const Outcomes& group) {
    text += fmt::format("| {} | {} | {} |\n", key, group.size(),
                        WithInterval(Count(group, Graded(Grade::kFalseAlarm)), group.size()));
  };
  for (const auto& [key, group] : By(clean, [](const Outcome& o) { return o.set + " | " + o.hidden.noise; }))
    row(key, group);
  for (const auto& [set, group] : By(clean, [](const Outcome& o) { return o.set; })) row(set + " | all", group);
  return text + "\n";
}

std::string LeaveOneOutTable(const Outcomes& all) {
  std::string text =
      "## Leave one cause out\n\nThe true cause is struck from the catalogue; every name is wrong. `structural`: "
      "wrong "
      "names that these readings cannot tell from the truth.\n\n| cause | cases | named above 0.9 | of these "
      "structural "
      "| unknown | tie | none |\n|---|---|---|---|---|---|---|\n";
  const Outcomes struck = Only(all, IsLeaveOneOut);
  const auto row = [&](const std::string& key, const Outcomes& group) {
    const auto verdict = [&group = group](diagnose::Verdict v) {
      return Count(group, [v](const Outcome& o) { return o.verdict == v; });
    };
    text += fmt::format(
        "| {} | {} | {} | {} | {} | {} | {} |\n", key, group.size(),
        WithInterval(Count(group, [](const Outcome& o) { return o.confident_wrong; }), group.size()),
        Count(group, [](const Outcome& o) { return o.confident_wrong && o.confident_alike; }),
        verdict(diagnose::Verdict::kUnknown), verdict(diagnose::Verdict::kTie), verdict(diagnose::Verdict::kNone));
  };
  for (const auto& [key, group] : By(struck, Effects)) row(key, group);
  row("all", struck);
  return text + "\n";
}

std::string ReliabilityTable(const Outcomes& all) {
  const std::vector<double> edges = {0.5, 0.8, 0.9, 0.95, 0.99, 1.0001};
  std::string text =
      "## Calibration of the stated probabilities\n\nEvery probability of an answer, leave-one-out apart. The "
      "probability of a name is capped.\n\n| stated | answers | mean stated | so it is |\n|---|---|---|---|\n";
  std::vector<Stated> stated;
  for (const Outcome* o : all) {
    if (!IsLeaveOneOut(*o)) stated.insert(stated.end(), o->stated.begin(), o->stated.end());
  }
  for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
    int count = 0, so = 0;
    double sum = 0.0;
    for (const Stated& s : stated) {
      if (s.probability < edges[k] || s.probability >= edges[k + 1]) continue;
      ++count;
      so += s.is_so ? 1 : 0;
      sum += s.probability;
    }
    text += fmt::format("| {:.2f}-{:.2f} | {} | {} | {} |\n", edges[k], edges[k + 1], count,
                        count ? fmt::format("{:.3f}", sum / count) : "-",
                        WithInterval(so, static_cast<std::size_t>(count)));
  }
  return text + "\n";
}

std::string ParameterTable(const Outcomes& all) {
  std::map<std::string, std::vector<ParameterCheck>> by;
  for (const Outcome* o : all) {
    if (IsLeaveOneOut(*o)) continue;
    for (const ParameterCheck& p : o->parameters) {
      if (!std::isfinite(p.u)) continue;
      by[o->set + " | all"].push_back(p);
      by[fmt::format("{} | {} {}", o->set, Effects(*o), p.name)].push_back(p);
    }
  }
  std::string text =
      "## Sizes of the causes found\n\n| set | parameter | values | truth within 95 % interval | median "
      "value/truth "
      "|\n|---|---|---|---|---|\n";
  for (const auto& [key, checks] : by) {
    std::vector<double> ratios;
    for (const ParameterCheck& p : checks) ratios.push_back((p.truth + p.Error()) / p.truth);
    const auto covered = static_cast<int>(std::ranges::count_if(checks, &ParameterCheck::Covers));
    text += fmt::format("| {} | {} | {} | {:.3f} |\n", key, checks.size(), WithInterval(covered, checks.size()),
                        Quantile(ratios, 0.5));
  }
  return text + "\n";
}

struct Mean {
  double value = kNaN, u = kNaN;
};
Mean MeanOf(const std::vector<double>& values) {
  double sum = 0.0, square = 0.0;
  for (const double v : values) sum += v;
  const double n = static_cast<double>(values.size()), mean = sum / n;
  for (const double v : values) square += (v - mean) * (v - mean);
  return {mean, std::sqrt(square / (n * (n - 1.0)))};
}

std::string GainTable(const Outcomes& all) {
  std::string text =
      "## Held-out gain\n\nOf rightly named causes: share of the removable variance of readings that were not "
      "used, "
      "unbiased (above 1 by noise). Where the removable variance is small against the scatter of the noise, the "
      "share "
      "of one case is uncertain: it reaches 0.9 unless its 95 % interval lies below, and surely if the interval "
      "lies "
      "above. The mean is the plain one, with its standard uncertainty.\n\n"
      "| set | named | reaches 0.9 | surely | mean | median | 10th percentile |\n|---|---|---|---|---|---|---|\n";
  const Outcomes named = Only(all, [](const Outcome& o) {
    return IsListed(o) && (o.grade == Grade::kRight || o.grade == Grade::kTie) && std::isfinite(o.gain);
  });
  const auto is_reached = [](const Outcome& o) { return o.gain_interval95[1] >= 0.9; };
  const auto is_sure = [](const Outcome& o) { return o.gain_interval95[0] >= 0.9; };
  for (const auto& [set, group] : By(named, [](const Outcome& o) { return o.set; })) {
    std::vector<double> gains;
    for (const Outcome* o : group) gains.push_back(o->gain);
    const Mean mean = MeanOf(gains);
    text += fmt::format("| {} | {} | {} | {} | {:.3f} +- {:.3f} | {:.3f} | {:.3f} |\n", set, group.size(),
                        WithInterval(Count(group, is_reached), group.size()), Count(group, is_sure), mean.value,
                        mean.u, Quantile(gains, 0.5), Quantile(gains, 0.1));
  }
  return text + "\n";
}

std::string TimeTable(const Outcomes& all) {
  std::string text =
      "## Time of one diagnosis\n\n| set | median [s] | 95th percentile [s] | longest [s] |\n|---|---|---|---|\n";
  for (const auto& [set, group] : By(all, [](const Outcome& o) { return o.set; })) {
    std::vector<double> seconds;
    for (const Outcome* o : group) seconds.push_back(o->seconds);
    text += fmt::format("| {} | {:.2f} | {:.2f} | {:.2f} |\n", set, Quantile(seconds, 0.5), Quantile(seconds, 0.95),
                        Quantile(seconds, 1.0));
  }
  return text + "\n";
}

bool IsSatisfactory(const Outcome& o) {
  return o.RightOrTie() || o.grade == Grade::kQuiet || o.grade == Grade::kUnknown ||
         (IsLeaveOneOut(o) && !o.confident_wrong);
}

std::string FailureList(const Outcomes& all) {
  std::string text =
      "## Answers that are not right\n\n| set | case | hidden | rho | grade | answer "
      "|\n|---|---|---|---|---|---|\n";
  for (const Outcome* o : all) {
    if (IsSatisfactory(*o)) continue;
    std::string answer = o->answer.substr(0, 160);
    for (std::size_t at = 0; (at = answer.find('|', at)) != std::string::npos;) answer[at] = '/';
    text += fmt::format("| {} | {} | {} | {:.1f} | {} | {} |\n", o->set, o->name, InWords(o->hidden), o->hidden.rho,
                        GradeName(o->grade), answer);
  }
  return text;
}

/// "amplitude 2.3e-05 +- 2e-06 of 2.4e-05; phase ...", SI.
std::string ParametersInWords(const Outcome& o) {
  std::string text;
  for (const ParameterCheck& p : o.parameters)
    text += fmt::format("{}{} {:.5g} +- {:.2g} of {:.5g}", text.empty() ? "" : "; ", p.name, p.value, p.u, p.truth);
  return text;
}

std::string Quoted(std::string text) {
  std::ranges::replace(text, '"', '\'');
  return "\"" + text + "\"";
}

}  // namespace

double ProbabilityOfAtMost(int count, int of, double p) {
  if (p <= 0.0) return 1.0;
  if (p >= 1.0) return count >= of ? 1.0 : 0.0;
  double sum = 0.0;
  for (int k = 0; k <= count; ++k) {
    const double choose = std::lgamma(of + 1.0) - std::lgamma(k + 1.0) - std::lgamma(of - k + 1.0);
    sum += std::exp(choose + k * std::log(p) + (of - k) * std::log1p(-p));
  }
  return sum;
}

std::array<double, 2> Share::Interval95() const {
  if (of == 0) return {0.0, 1.0};
  return {count == 0 ? 0.0 : SolveAtMost(count - 1, of, 0.975), count == of ? 1.0 : SolveAtMost(count, of, 0.025)};
}

std::string ScoreTable(const std::vector<Outcome>& outcomes) {
  Outcomes all;
  for (const Outcome& o : outcomes) all.push_back(&o);
  return SetTable(all) + EffectTable(all) + RhoTable(all) + UnlistedTable(all) + AlarmTable(all) +
         LeaveOneOutTable(all) + ReliabilityTable(all) + ParameterTable(all) + GainTable(all) + TimeTable(all) +
         FailureList(all);
}

std::string CasesCsv(const std::vector<Outcome>& outcomes) {
  std::string text =
      "set,case,hidden,noise,rho,grade,answer,probability,confident_wrong,alarm_p,fitted_rho,parameters,gain,"
      "gain_lower,gain_upper,seconds\n";
  for (const Outcome& o : outcomes) {
    text +=
        fmt::format("{},{},{},{},{:.3g},{},{},{:.4f},{:d},{:.3g},{:.3g},{},{:.3f},{:.3f},{:.3f},{:.2f}\n", o.set,
                    o.name, Quoted(InWords(o.hidden)), Quoted(o.hidden.noise), o.hidden.rho, GradeName(o.grade),
                    Quoted(o.answer), o.probability, o.confident_wrong, o.alarm_p, o.rho,
                    Quoted(ParametersInWords(o)), o.gain, o.gain_interval95[0], o.gain_interval95[1], o.seconds);
  }
  return text;
}

}  // namespace twinbench::hidden
