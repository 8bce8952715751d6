#include <fmt/format.h>

#include <cmath>

#include "tests/hidden/score_format.h"
#include "tests/hidden/score_sections.h"

// What a named cause explains of readings that were kept from the fit.
namespace twinbench::hidden {
namespace {

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

constexpr double kWanted = 0.9;

bool Reaches(const Outcome& o) {
  return o.gain_interval95[1] >= kWanted;
}

bool SurelyReaches(const Outcome& o) {
  return o.gain_interval95[0] >= kWanted;
}

std::string GainRow(const std::string& set, const Outcomes& group) {
  const std::vector<double> gains = Values(group, &Outcome::gain);
  const Mean mean = MeanOf(gains);
  return fmt::format("| {} | {} | {} | {} | {:.3f} +- {:.3f} | {:.3f} | {:.3f} |\n", set, group.size(),
                     WithInterval(ShareOf(group, Reaches)), Count(group, SurelyReaches), mean.value, mean.u,
                     Quantile(gains, 0.5), Quantile(gains, 0.1));
}

}  // namespace

std::string GainSection(const Outcomes& all) {
  const Outcomes named =
      Only(all, [](const Outcome& o) { return IsListed(o) && o.RightOrTie() && std::isfinite(o.gain); });
  return "## Held-out gain\n\nOf rightly named causes: share of the removable variance of readings that were not "
         "used, unbiased (above 1 by noise). Where the removable variance is small against the scatter of the "
         "noise, the share of one case is uncertain: it reaches 0.9 unless its 95 % interval lies below, and "
         "surely "
         "if the interval lies above. The mean is the plain one, with its standard uncertainty.\n\n" +
         TableHead("set | named | reaches 0.9 | surely | mean | median | 10th percentile") +
         Rows(By(named, &Outcome::set), GainRow) + "\n";
}

}  // namespace twinbench::hidden
