#include <fmt/format.h>

#include <cmath>
#include <complex>

#include "twin/benches/encoder_comparison/diagnosis/family_parts.h"
#include "twin/core/units.h"
#include "twin/diagnose/unknown/collector.h"

namespace twinbench::diagnose::encoder {
namespace {

enum class Code { kBinary, kGray };

/// One bit of an absolute code.
struct Digit {
  Code code = Code::kBinary;
  double worth_rad = 0.0;  // of the binary bit; a track of a Gray code has the period of the bit above

  double Period_rad() const { return (code == Code::kBinary ? 2.0 : 4.0) * worth_rad; }
};

/// What the angle reads too much by, in what the bit is worth, where the bit is not counted: all of it wherever it
/// is set. A track of a Gray code decides how all bits below it are read, so that they run backwards where it
/// fails.
/// @param periods  From where the code begins.
Eigen::ArrayXd LackOf(Code code, const Eigen::ArrayXd& periods) {
  const Eigen::ArrayXd at = periods - periods.floor();
  if (code == Code::kBinary) return (at >= 0.5).cast<double>();
  const Eigen::ArrayXd back = (at < 0.5).select(2.0 - 8.0 * at, 6.0 - 8.0 * at);
  return (at >= 0.25 && at < 0.75).select(back, 0.0);
}

/// The residual over one period of a digit: sums and numbers of the readings in each part of it.
class Folded {
 public:
  static constexpr Eigen::Index kParts = 100;

  Folded(const EncoderRun& encoder, const Digit& digit) : digit_(digit) {
    const Eigen::ArrayXd periods = encoder.context.device_rad.array() / digit.Period_rad();
    for (Eigen::Index i = 0; i < periods.size(); ++i) {
      const double at = periods[i] - std::floor(periods[i]), row = encoder.run.residual[i];
      const auto part = std::min(static_cast<Eigen::Index>(at * kParts), kParts - 1);
      sum_[part] += row;
      count_[part] += 1.0;
      wave_ += row * std::polar(1.0, at * units::turn);
      square_ += row * row;
    }
  }

  /// Squares of the residual that a digit takes, and the digit's size, with the zero where it takes most.
  struct Taken {
    double square = 0.0, size_rad = 0.0;
  };
  Taken Best() const {
    const Eigen::ArrayXd parts = Eigen::ArrayXd::LinSpaced(kParts, 0.5, kParts - 0.5) / static_cast<double>(kParts);
    Taken best;
    for (Eigen::Index zero = 0; zero < kParts; ++zero) {
      const Eigen::ArrayXd lack =
          LackOf(digit_.code, parts - static_cast<double>(zero) / static_cast<double>(kParts));
      const double mean = (count_ * lack).sum() / count_.sum(), own = (count_ * (lack - mean).square()).sum();
      const double with = ((lack - mean) * sum_).sum();
      if (own > 0.0 && with * with / own > best.square) best = {with * with / own, with / own};
    }
    return best;
  }
  double ByWave() const { return 2.0 * std::norm(wave_) / count_.sum(); }
  double All() const { return square_; }

 private:
  const Digit& digit_;
  Eigen::ArrayXd sum_ = Eigen::ArrayXd::Zero(kParts), count_ = Eigen::ArrayXd::Zero(kParts);
  std::complex<double> wave_;
  double square_ = 0.0;
};

/// A bit that is not counted, or counted as another one, is off by about what it is worth.
bool IsOfItsWorth(const Digit& digit, double size_rad) {
  constexpr double kLeast = 0.4, kLikely = 0.2;
  const double share = std::abs(size_rad) / digit.worth_rad;
  return digit.code == Code::kBinary ? share > kLeast : std::abs(share - 1.0) < kLikely;
}

/// Its edges explain what no wave of its period can: else it is an order like any other.
bool ShowsEdges(const Digit& digit, const EncoderRun& encoder) {
  constexpr double kClearly = 25.0;  // in squares of the noise, or of what is left
  const Folded folded(encoder, digit);
  const Folded::Taken best = folded.Best();
  const auto readings = static_cast<double>(encoder.run.Rows());
  const double noise = encoder.run.sigma.squaredNorm() / readings, left = (folded.All() - best.square) / readings;
  return IsOfItsWorth(digit, best.size_rad) && best.square > folded.ByWave() + kClearly * std::max(noise, left);
}

std::string WordsOf(const Digit& digit) {
  const std::string of = digit.code == Code::kBinary ? "bit of a binary code" : "track of a Gray code";
  return fmt::format("{} that is wrong, worth {:.4g} deg, synchronous with device angle", of,
                     digit.worth_rad / units::deg);
}

}  // namespace

std::vector<Family> CodeDigitFamilies(const EncoderRun& encoder, const unknown::Design& design) {
  constexpr int kMostBits = 20, kBegins = 400;  // of the code that are tried
  const Eigen::ArrayXd device_rad = encoder.context.device_rad;
  const double range_rad = RangeOfSetUp_rad(encoder.context),
               least_rad = std::max(units::turn * std::pow(0.5, kMostBits), encoder.run.sigma.mean());
  unknown::Collector collect(std::make_shared<const unknown::Design>(design));
  for (double worth_rad = units::turn / 2.0; worth_rad >= least_rad; worth_rad /= 2.0) {
    for (const Code code : {Code::kBinary, Code::kGray}) {
      const Digit digit{code, worth_rad};
      if (digit.Period_rad() > range_rad || !ShowsEdges(digit, encoder)) continue;
      collect.Add(
          "digit", kBegins,
          [=](int g) {
            return Eigen::MatrixXd(
                LackOf(digit.code, device_rad / digit.Period_rad() - static_cast<double>(g) / kBegins));
          },
          [words = WordsOf(digit)](int) { return words; });
    }
  }
  return collect.Take();
}

}  // namespace twinbench::diagnose::encoder
