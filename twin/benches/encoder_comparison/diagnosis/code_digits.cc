#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/diagnosis/family_parts.h"
#include "twin/benches/encoder_comparison/diagnosis/taken.h"
#include "twin/core/units.h"
#include "twin/diagnose/unknown/collector.h"

namespace twinbench::diagnose::encoder {
namespace {

enum class Code { kBinary, kGray };

/// One bit of an absolute code.
struct Digit {
  static constexpr int kZeros = 400;  // that are tried

  Code code = Code::kBinary;
  double worth_rad = 0.0;  // of the binary bit; a track of a Gray code has the period of the bit above

  double Period_rad() const { return (code == Code::kBinary ? 2.0 : 4.0) * worth_rad; }
  /// Half a period on a binary bit is the same with the other sign.
  double Zero_rad(int g) const { return (code == Code::kBinary ? 0.5 : 1.0) * Period_rad() * g / kZeros; }
};

/// What the angle reads too much by, in what the bit is worth, where the bit is not counted: all of it wherever it
/// is set. A track of a Gray code decides how all bits below it are read, so that they run backwards where it
/// fails.
Eigen::VectorXd LackOf(const Digit& digit, const Eigen::VectorXd& device_rad, double zero_rad) {
  const Eigen::ArrayXd turns = (device_rad.array() - zero_rad) / digit.Period_rad(), at = turns - turns.floor();
  if (digit.code == Code::kBinary) return (at >= 0.5).cast<double>();
  const Eigen::ArrayXd back = (at < 0.5).select(2.0 - 8.0 * at, 6.0 - 8.0 * at);
  return (at >= 0.25 && at < 0.75).select(back, 0.0);
}

/// A bit that is not counted, or counted as another one, is off by about what it is worth.
bool IsOfItsWorth(const Digit& digit, double size_rad) {
  constexpr double kLeast = 0.4, kLikely = 0.2;
  const double share = std::abs(size_rad) / digit.worth_rad;
  return digit.code == Code::kBinary ? share > kLeast : std::abs(share - 1.0) < kLikely;
}

/// Its edges explain what no wave of its period can: else it is an order like any other.
bool ShowsEdges(const Digit& digit, const EncoderRun& encoder, const Taken& taken) {
  constexpr double kClearly = 25.0;  // in squares of the noise, or of what is left
  constexpr int kEvery = 4;          // of its zeros: edges show there, too
  const Eigen::VectorXd& device_rad = encoder.context.device_rad;
  Eigen::VectorXd best = LackOf(digit, device_rad, 0.0);
  for (int g = kEvery; g < Digit::kZeros; g += kEvery) {
    Eigen::VectorXd lack = LackOf(digit, device_rad, digit.Zero_rad(g));
    if (taken.By(lack) > taken.By(best)) best = std::move(lack);
  }
  const double most = taken.By(best), readings = static_cast<double>(device_rad.size());
  const double noise = encoder.run.sigma.squaredNorm() / readings, left = (taken.All() - most) / readings;
  return IsOfItsWorth(digit, taken.SizeOf(best)) &&
         most > taken.ByWave(device_rad * (units::turn / digit.Period_rad())) + kClearly * std::max(noise, left);
}

std::string WordsOf(const Digit& digit) {
  const std::string of = digit.code == Code::kBinary ? "bit of a binary code" : "track of a Gray code";
  return fmt::format("{} that is wrong, worth {:.4g} deg, synchronous with device angle", of,
                     digit.worth_rad / units::deg);
}

}  // namespace

std::vector<Family> CodeDigitFamilies(const EncoderRun& encoder, const unknown::Design& design) {
  constexpr int kMostBits = 20;
  const SignalContext& c = encoder.context;
  const Eigen::VectorXd device_rad = c.device_rad;
  const Taken taken(encoder);
  const double range_rad = RangeOfSetUp_rad(c),
               least_rad = std::max(units::turn * std::pow(0.5, kMostBits), encoder.run.sigma.mean());
  unknown::Collector collect(std::make_shared<const unknown::Design>(design));
  for (double worth_rad = units::turn / 2.0; worth_rad >= least_rad; worth_rad /= 2.0) {
    for (const Code code : {Code::kBinary, Code::kGray}) {
      const Digit digit{code, worth_rad};
      if (digit.Period_rad() > range_rad) continue;
      if (!ShowsEdges(digit, encoder, taken)) continue;
      collect.Add(
          "digit", Digit::kZeros,
          [=](int g) { return Eigen::MatrixXd(LackOf(digit, device_rad, digit.Zero_rad(g))); },
          [words = WordsOf(digit)](int) { return words; });
    }
  }
  return collect.Take();
}

}  // namespace twinbench::diagnose::encoder
