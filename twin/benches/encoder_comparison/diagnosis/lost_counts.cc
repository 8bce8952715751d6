#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/diagnosis/family_parts.h"
#include "twin/core/units.h"
#include "twin/diagnose/unknown/collector.h"

namespace twinbench::diagnose::encoder {
namespace {

/// What happens where a spot of the scale is passed.
enum class Passing { kLostForwards, kLostBackwards, kComesBack, kCatchesUp };

std::string WordsOf(Passing passing) {
  switch (passing) {
    case Passing::kLostForwards:
      return "lost counts, the same each time that {:.1f} deg is passed forwards, synchronous with device angle";
    case Passing::kLostBackwards:
      return "lost counts, the same each time that {:.1f} deg is passed backwards, synchronous with device angle";
    case Passing::kComesBack:
      return "lost counts where {:.1f} deg is passed, which come back on the way back, synchronous with device "
             "angle";
    case Passing::kCatchesUp:
      break;
  }
  return "turn that is not whole and put right at {:.1f} deg, synchronous with device angle";
}

/// How often the spot was passed until each reading, or the share of a turn behind it.
Eigen::VectorXd CourseOf(Passing passing, const Eigen::VectorXd& device_rad, double spot_rad) {
  const Eigen::ArrayXd turns = (device_rad.array() - spot_rad) / units::turn, whole = turns.floor();
  if (passing == Passing::kCatchesUp) return turns - whole;
  if (passing == Passing::kComesBack) return whole - whole[0];
  Eigen::VectorXd lost = Eigen::VectorXd::Zero(device_rad.size());
  const double sense = passing == Passing::kLostForwards ? 1.0 : -1.0;
  for (Eigen::Index i = 1; i < lost.size(); ++i)
    lost[i] = lost[i - 1] + std::max(0.0, sense * (whole[i] - whole[i - 1]));
  return lost;
}

/// Steps that share one size.
std::vector<Product> StepsOf(const Eigen::VectorXd& course, const std::vector<int>& reading) {
  std::vector<Product> steps;
  for (Eigen::Index i = 1; i < course.size(); ++i) {
    const double step = course[i] - course[i - 1];
    if (step == 0.0) continue;
    const int at = reading[static_cast<std::size_t>(i)];
    steps.push_back({unknown::SignalOf("step", "", {{"at_reading", at}}), 0, false, step});
  }
  return steps;
}

/// Half way between neighbouring readings, all turns on one; of many that follow each other the widest: repeated
/// readings of one place have nothing between them.
std::vector<double> Spots_rad(const Eigen::VectorXd& device_rad) {
  constexpr std::size_t kMost = 1000;
  std::vector<double> within;
  for (const double angle_rad : device_rad)
    within.push_back(angle_rad - units::turn * std::floor(angle_rad / units::turn));
  std::ranges::sort(within);
  if (!within.empty()) within.push_back(within.front() + units::turn);  // where most devices begin anew
  std::vector<double> spots;
  const std::size_t every = 1 + within.size() / kMost;
  for (std::size_t from = 1; from < within.size(); from += every) {
    const auto gap = [&](std::size_t i) { return within[i] - within[i - 1]; };
    std::size_t widest = from;
    for (std::size_t i = from + 1; i < std::min(from + every, within.size()); ++i) {
      if (gap(i) > gap(widest)) widest = i;
    }
    if (gap(widest) > units::urad) spots.push_back(0.5 * (within[widest] + within[widest - 1]));
  }
  return spots;
}

/// The same but for little as a drift: a few steps in one sense, as far from each other.
bool IsLikeDrift(const Eigen::VectorXd& course) {
  constexpr double kLike = 0.95;  // share that goes with the number of the reading
  const Eigen::VectorXd steps = course.array() - course.mean();
  Eigen::VectorXd number = Eigen::VectorXd::LinSpaced(course.size(), 0.0, 1.0);
  number.array() -= number.mean();
  return std::pow(steps.dot(number), 2) > kLike * steps.squaredNorm() * number.squaredNorm();
}

/// Where something happens more than once: a single step has a name. A turn that is put right is there once where
/// one turn is gone.
std::vector<double> PassedAgain(Passing passing, const Eigen::VectorXd& device_rad, std::vector<double> spots_rad) {
  const bool catches_up = passing == Passing::kCatchesUp;
  std::erase_if(spots_rad, [&](double spot_rad) {
    const Eigen::VectorXd course = CourseOf(catches_up ? Passing::kComesBack : passing, device_rad, spot_rad);
    const Eigen::Index later = course.size() - 1;
    return (course.tail(later).array() != course.head(later).array()).count() < (catches_up ? 1 : 2) ||
           (!catches_up && IsLikeDrift(course));
  });
  return spots_rad;
}

}  // namespace

std::vector<Family> LostCountFamilies(const SignalContext& context, const unknown::Design& design) {
  const Eigen::VectorXd device_rad = context.device_rad;
  unknown::Collector collect(std::make_shared<const unknown::Design>(design));
  constexpr double kNearly = 0.99;  // of a turn, in a table of one that says where its error jumps
  constexpr Eigen::Index kTable = 256;
  const double least_rad = device_rad.size() < kTable ? units::turn : kNearly * units::turn;
  const bool has_turn = device_rad.maxCoeff() - device_rad.minCoeff() > least_rad;
  for (const Passing passing :
       {Passing::kLostForwards, Passing::kLostBackwards, Passing::kComesBack, Passing::kCatchesUp}) {
    if (passing == Passing::kCatchesUp && !has_turn)
      continue;  // of less than a turn nobody knows whether it is whole
    const std::vector<double> spots_rad = PassedAgain(passing, device_rad, Spots_rad(device_rad));
    const auto spot_rad = [spots_rad](int g) { return spots_rad[static_cast<std::size_t>(g)]; };
    collect.Add(
        "lost counts", static_cast<int>(std::ssize(spots_rad)),
        [=](int g) { return Eigen::MatrixXd(CourseOf(passing, device_rad, spot_rad(g))); },
        [=, words = WordsOf(passing)](int g) {
          return fmt::format(fmt::runtime(words), spot_rad(g) / units::deg);
        });
    if (passing == Passing::kCatchesUp) continue;
    collect.Are([=, reading = context.reading](const Eigen::VectorXd&, int g) {
      return StepsOf(CourseOf(passing, device_rad, spot_rad(g)), reading);
    });
  }
  return collect.Take();
}

}  // namespace twinbench::diagnose::encoder
