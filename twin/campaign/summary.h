#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "twin/campaign/table.h"
#include "twin/campaign/trial.h"

namespace twinbench::campaign {

/// One number over the trials, or all numbers of one list together: "score.target.ez_arcsec[]".
struct ResultSummary {
  std::int64_t count = 0;  // finite values
  double mean = 0.0;
  double sd = 0.0;  // over trials; of a list, each number about its own mean
  double rms_u = 0.0;
  std::int64_t scored = 0;  // those whose error is known
  double rms_error = 0.0;   // of values that differ from trial to trial, what u is to be held against
  double bias = 0.0;        // mean error; of a list, root mean square of those of its numbers
  double coverage95 = 0.0;  // share of errors within their k u

  /// Numbers of a list that cancel each other leave what rounding makes of them: that is none.
  double ShownMean() const { return std::abs(mean) < 1e-12 * sd ? 0.0 : mean; }
};

struct WorstTrial {
  std::int64_t trial = 0;
  std::string result;
  double normed = 0.0;  // its largest |error| / u
};

/// What a table comes to, row by row.
class Summary {
 public:
  void Add(const TrialRow& row);

  std::map<std::string, ResultSummary> Results() const;
  /// Furthest from the truth in stated uncertainties first.
  std::vector<WorstTrial> Worst(std::size_t most) const;
  const std::vector<TrialRow>& Lost() const { return lost_; }  // without results
  const std::map<std::string, std::int64_t>& Verdicts() const { return verdicts_; }
  std::int64_t Trials() const { return trials_; }

 private:
  /// Sums of one number; mean and sum of squares about it as Welford (Technometrics 4 (1962) 419-420) takes them.
  struct Sums {
    std::int64_t count = 0, scored = 0, covered = 0;
    double mean = 0.0, about_mean = 0.0, sum_u2 = 0.0, sum_error = 0.0, sum_error2 = 0.0;
    std::int64_t count_u = 0;
    void Add(const TrialResult& result);
  };

  std::int64_t trials_ = 0;
  std::map<std::string, Sums> sums_;
  std::vector<WorstTrial> worst_;
  std::vector<TrialRow> lost_;
  std::map<std::string, std::int64_t> verdicts_;
};

/// Of all rows of a table.
Summary SummaryOf(const Table& table);

/// For a person: a line a result, verdicts, lost and worst trials with the command that shows each again.
std::string SummaryText(const Summary& summary, const std::string& study_path);

}  // namespace twinbench::campaign
