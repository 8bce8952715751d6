#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/diagnosis/family_parts.h"
#include "twin/core/units.h"
#include "twin/diagnose/unknown/collector.h"
#include "twin/model/signals.h"

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

/// Squares of the rows that columns take, each mounting's mean put aside.
class Taken {
 public:
  Taken(const Eigen::VectorXd& rows, const std::vector<int>& setup)
      : setups_(model::Indicators(setup)), rows_(Aside(rows)) {}

  double All() const { return rows_.squaredNorm(); }
  double By(const Eigen::VectorXd& column) const {
    const Eigen::VectorXd beside = Aside(column);
    const double square = beside.squaredNorm();
    return square > 0.0 ? std::pow(beside.dot(rows_), 2) / square : 0.0;
  }
  /// Of one period.
  double ByWave(const Eigen::VectorXd& angle_rad) const {
    const Eigen::MatrixXd wave = model::Wave(angle_rad);
    const Eigen::VectorXd first = Aside(wave.col(0));
    Eigen::VectorXd second = Aside(wave.col(1));
    if (first.squaredNorm() > 0.0) second -= first * (first.dot(second) / first.squaredNorm());
    return By(first) + By(second);
  }

 private:
  Eigen::VectorXd Aside(const Eigen::VectorXd& rows) const {
    const Eigen::VectorXd readings = setups_.colwise().sum();
    return rows - setups_ * (setups_.transpose() * rows).cwiseQuotient(readings);
  }

  Eigen::MatrixXd setups_;
  Eigen::VectorXd rows_;
};

/// Its edges explain what no wave of its period can: else it is an order like any other.
bool ShowsEdges(const Digit& digit, const EncoderRun& encoder, const Taken& taken) {
  constexpr double kClearly = 25.0;  // in squares of the noise, or of what is left
  constexpr int kEvery = 4;          // of its zeros: edges show there, too
  const Eigen::VectorXd& device_rad = encoder.context.device_rad;
  double most = 0.0;
  for (int g = 0; g < Digit::kZeros; g += kEvery)
    most = std::max(most, taken.By(LackOf(digit, device_rad, digit.Zero_rad(g))));
  const double readings = static_cast<double>(device_rad.size()),
               noise = encoder.run.sigma.squaredNorm() / readings;
  const double left = (taken.All() - most) / readings;
  return most > taken.ByWave(device_rad * (units::turn / digit.Period_rad())) + kClearly * std::max(noise, left);
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
  const Taken taken(encoder.run.residual, c.setup);
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
