#include "twin/diagnose/unknown/at_points.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "twin/core/units.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::unknown {
namespace {

/// P1 and P2 over the range that the coordinate has: readings x 2.
Eigen::MatrixXd Legendre(const Along& along) {
  const double low = along.value.minCoeff(), high = along.value.maxCoeff();
  if (!(high > low)) return Eigen::MatrixXd::Zero(along.value.size(), 2);
  const Eigen::ArrayXd t = (2.0 * along.value.array() - low - high) / (high - low);
  Eigen::MatrixXd both(t.size(), 2);
  both << t, 1.5 * t.square() - 0.5;
  return both;
}

/// Each column of one times each of the other.
Eigen::MatrixXd Together(const Eigen::MatrixXd& one, const Eigen::MatrixXd& other) {
  Eigen::MatrixXd products(one.rows(), one.cols() * other.cols());
  for (Eigen::Index k = 0; k < products.cols(); ++k)
    products.col(k) = one.col(k / other.cols()).cwiseProduct(other.col(k % other.cols()));
  return products;
}

Family FamilyAt(const AtPoint& point, const std::string& sort, Eigen::Index amplitudes) {
  Family family;
  family.kind = Kind::kUnknown;
  family.effect = family.group = sort;
  family.where = point.name;
  family.amplitudes.assign(static_cast<std::size_t>(amplitudes),
                           {"amplitude", point.unit, point.to_SI, point.plausible});
  return family;
}

std::string SizeInWords(const AtPoint& point, const Eigen::VectorXd& amplitudes) {
  return fmt::format("amplitude {:.2g} {}", amplitudes.norm() / point.to_SI, point.unit);
}

/// In even steps of 1 / period, so close that a wave between two of them keeps nearly all of its size.
std::vector<double> Periods(const Eigen::VectorXd& along, double shortest, double longest) {
  const double range = along.maxCoeff() - along.minCoeff(), first = 1.0 / longest, last = 1.0 / shortest;
  const int count = 2 + static_cast<int>(std::ceil(2.0 * (last - first) * range));
  std::vector<double> periods;
  for (int k = count - 1; k >= 0; --k) periods.push_back(1.0 / (first + (last - first) * k / (count - 1)));
  return periods;
}

}  // namespace

Eigen::MatrixXd ShownOf(const Eigen::MatrixXd& slope, const Eigen::MatrixXd& courses) {
  Eigen::MatrixXd shown(slope.size(), courses.cols());
  for (Eigen::Index k = 0; k < courses.cols(); ++k)
    shown.col(k) = (courses.col(k).asDiagonal() * slope).transpose().reshaped();
  return shown;
}

std::vector<Family> Interactions(const std::vector<AtPoint>& points, const std::vector<Along>& coordinates) {
  std::vector<Eigen::MatrixXd> courses;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    for (std::size_t j = 0; j < k; ++j) {
      courses.push_back(Together(Legendre(coordinates[j]), Legendre(coordinates[k])));
      names.push_back(coordinates[j].name + " and " + coordinates[k].name);
    }
  }
  std::vector<Family> families;
  if (courses.empty()) return families;
  for (const AtPoint& point : points) {
    Family& family = families.emplace_back(FamilyAt(point, "interaction of coordinates", courses.front().cols()));
    family.grid = static_cast<int>(std::ssize(courses));
    family.columns = [slope = point.slope, courses](int pair) {
      return ShownOf(slope, courses[static_cast<std::size_t>(pair)]);
    };
    family.describe = [point, names](int pair, const Eigen::VectorXd& x, const Eigen::VectorXd&) {
      return fmt::format("at {}, function of {} together, {}", point.name,
                         names[static_cast<std::size_t>(pair)], SizeInWords(point, x));
    };
  }
  return families;
}

Family Fringes(const AtPoint& point, const Along& along, double shortest, double longest) {
  Family family = FamilyAt(point, along.name + " fringes", 2);
  const std::vector<double> periods = Periods(along.value, shortest, longest);
  family.shapes = {{"period", along.unit, along.to_SI, shortest, longest, periods}};
  family.grid = static_cast<int>(std::ssize(periods));
  family.at = [slope = point.slope, value = along.value](const Eigen::VectorXd& period) {
    return ShownOf(slope, model::Wave(units::turn / period[0] * value));
  };
  family.columns = [at = family.at, periods](int g) {
    return at(Eigen::VectorXd::Constant(1, periods[static_cast<std::size_t>(g)]));
  };
  family.describe = [point, name = along.name, unit = along.unit, to_SI = along.to_SI](
                        int, const Eigen::VectorXd& x, const Eigen::VectorXd& period) {
    return fmt::format("at {0}, periodic in {1}, period {2:.3g} {3}, synchronous with {1}, {4}", point.name, name,
                       period[0] / to_SI, unit, SizeInWords(point, x));
  };
  return family;
}

}  // namespace twinbench::diagnose::unknown
