#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "tests/hidden/score_format.h"
#include "tests/hidden/score_sections.h"

// Is what is stated at 90 % so in nine cases of ten?
namespace twinbench::hidden {
namespace {

std::vector<Stated> AllStated(const Outcomes& outcomes) {
  std::vector<Stated> stated;
  for (const Outcome* o : outcomes) stated.insert(stated.end(), o->stated.begin(), o->stated.end());
  return stated;
}

std::vector<Stated> Between(double from, double to, const std::vector<Stated>& stated) {
  std::vector<Stated> bin;
  std::ranges::copy_if(stated, std::back_inserter(bin),
                       [&](const Stated& s) { return s.probability >= from && s.probability < to; });
  return bin;
}

std::string MeanStated(const std::vector<Stated>& bin) {
  if (bin.empty()) return "-";
  double sum = 0.0;
  for (const Stated& s : bin) sum += s.probability;
  return fmt::format("{:.3f}", sum / static_cast<double>(bin.size()));
}

std::string CalibrationRow(double from, double to, const std::vector<Stated>& bin) {
  const auto so = std::ranges::count_if(bin, &Stated::is_so);
  return fmt::format("| {:.2f}-{:.2f} | {} | {} | {} |\n", from, to, bin.size(), MeanStated(bin),
                     WithInterval({static_cast<int>(so), static_cast<int>(bin.size())}));
}

}  // namespace

std::string CalibrationSection(const Outcomes& all) {
  constexpr std::array kEdges = {0.5, 0.8, 0.9, 0.95, 0.99, 1.0001};  // the last one lets 1 in
  const std::vector<Stated> stated = AllStated(Only(all, std::not_fn(IsLeaveOneOut)));
  std::string text =
      "## Calibration of the stated probabilities\n\nEvery probability of an answer, leave-one-out apart. The "
      "probability of a name is capped.\n\n" +
      TableHead("stated | answers | mean stated | so it is");
  for (std::size_t k = 0; k + 1 < kEdges.size(); ++k)
    text += CalibrationRow(kEdges[k], kEdges[k + 1], Between(kEdges[k], kEdges[k + 1], stated));
  return text + "\n";
}

}  // namespace twinbench::hidden
