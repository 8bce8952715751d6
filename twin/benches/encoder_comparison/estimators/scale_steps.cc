#include "twin/benches/encoder_comparison/estimators/scale_steps.h"

#include <algorithm>
#include <cmath>

#include "twin/core/rounding.h"
#include "twin/core/units.h"

namespace twinbench::separate::encoder {
namespace {

constexpr double kBothWays = 0.5;     // of it, what both directions have in common

void AddVisits(const FittedGroup& fitted, double step_rad, Visits& visits) {
  std::vector<std::pair<double, double>> at;
  for (std::size_t p = 0; p < fitted.th_rad.size(); ++p) {
    for (Eigen::Index i = 0; i < fitted.th_rad[p].size(); ++i)
      at.emplace_back(fitted.th_rad[p][i], fitted.fit.rest_rad[p][i]);
  }
  visits.Add(std::move(at), step_rad);
}

/// @param by_steps  Without these orders.
std::vector<bool> OwnOrders(const FittedGroup& fitted, double step_rad, double noise_rad2, const GroupRounding& by_steps) {
  std::vector<bool> own;
  for (std::size_t k = 0; k < fitted.fit.cofactor.size(); ++k) {
    const double size = std::abs(fitted.fit.value[static_cast<Eigen::Index>(k)]);
    const double by_chance = by_steps.waves.empty() ? INFINITY : by_steps.waves[k].squaredNorm() + noise_rad2 * fitted.fit.cofactor[k].trace();
    own.push_back(IsOwnOrder(size, step_rad, by_chance));
  }
  return own;
}

/// What the device would show there without steps, apart from a constant.
Eigen::VectorXd Shown_rad(const FittedGroup& fitted, const std::vector<bool>& own) {
  Eigen::VectorXd all(fitted.group->Readings());
  Eigen::Index at = 0;
  for (std::size_t p = 0; p < fitted.th_rad.size(); ++p) {
    // The curve is what the device shows more than the reference, with both their errors in it.
    const Eigen::VectorXd& reference_rad = fitted.group->passes[p].reference_rad;
    const double mounting_rad = (fitted.th_rad[p] - reference_rad).mean();
    for (Eigen::Index i = 0; i < reference_rad.size(); ++i) {
      const double th = fitted.th_rad[p][i];
      all[at] = reference_rad[i] + mounting_rad;
      for (int k = 0; k < fitted.fit.Highest(); ++k) {
        if (own[static_cast<std::size_t>(k)])
          all[at] += (fitted.fit.value[k] * std::polar(1.0, (k + 1) * th)).real();
      }
      ++at;
    }
  }
  return all;
}

/// Of waves over the readings, the mean and the orders as sums over even readings give them.
GroupRounding OfWaves(const FittedGroup& fitted, const Eigen::MatrixXd& waves, int highest) {
  Eigen::VectorXcd turn(waves.rows());
  Eigen::Index at = 0;
  for (const Eigen::VectorXd& pass : fitted.th_rad) {
    for (const double th : pass) turn[at++] = std::polar(1.0, -th);
  }
  const auto count = static_cast<double>(waves.rows());
  GroupRounding rounding{{}, {}, (waves.colwise().sum() / count).squaredNorm()};
  Eigen::VectorXcd power = turn;
  for (int k = 0; k < highest; ++k, power = power.cwiseProduct(turn).eval()) {
    const Eigen::RowVectorXcd sums = 2.0 / count * (power.transpose() * waves);
    Eigen::Matrix<double, 2, Eigen::Dynamic> parts(2, waves.cols());
    parts << sums.real(), sums.imag();
    rounding.waves.emplace_back(parts);
    rounding.smeared.emplace_back(Eigen::Matrix2d::Zero());
  }
  return rounding;
}

void AddSmeared(const FittedGroup& fitted, double of_one_rad2, GroupRounding& rounding) {
  for (std::size_t k = 0; k < rounding.smeared.size(); ++k)
    rounding.smeared[k] = kSmearedPart * of_one_rad2 * fitted.fit.cofactor[k];
  rounding.mean_rad2 += kSmearedPart * of_one_rad2 / fitted.group->Readings();
}

double PlacesOf(const std::vector<const FittedGroup*>& groups, double step_rad) {
  std::vector<std::pair<double, double>> at;
  for (const FittedGroup* fitted : groups) {
    for (const Eigen::VectorXd& pass : fitted->th_rad) {
      for (const double th : pass) at.emplace_back(th, 0.0);
    }
  }
  Visits visits;
  visits.Add(std::move(at), step_rad);
  return visits.places;
}

/// Two groups together have more places than one, unless they were read at the same.
Eigen::MatrixXd SamePlaces(const std::vector<FittedGroup>& groups, double step_rad) {
  constexpr double kNoMore = 1.25;
  const auto count = std::ssize(groups);
  Eigen::MatrixXd same = Eigen::MatrixXd::Identity(count, count);
  for (std::size_t a = 0; a < groups.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const double one = PlacesOf({&groups[a]}, step_rad), both = PlacesOf({&groups[a], &groups[b]}, step_rad);
      const auto i = static_cast<Eigen::Index>(a), j = static_cast<Eigen::Index>(b);
      same(i, j) = same(j, i) = both < kNoMore * one ? 1.0 : 0.0;
    }
  }
  return same;
}

}  // namespace

Eigen::Matrix2d Rounding::StepsBetween(std::size_t a, std::size_t b, int order) const {
  if (None()) return Eigen::Matrix2d::Zero();
  const auto k = static_cast<std::size_t>(order - 1);
  const double same = same_places(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
  const Eigen::Matrix2d together = groups[a].waves[k] * groups[b].waves[k].transpose() +
                                   0.5 * same * (groups[a].smeared[k] + groups[b].smeared[k]);
  return (direction[a] == direction[b] ? 1.0 : kBothWays) * together;
}

Eigen::Matrix2d Rounding::FoldedBetween(std::size_t a, std::size_t b, int order) const {
  if (folded.empty()) return Eigen::Matrix2d::Zero();
  const auto k = static_cast<std::size_t>(order - 1);
  return folded[a].waves[k] * folded[b].waves[k].transpose();
}

void Rounding::AddFolded(const std::vector<FittedGroup>& fitted, const Unresolved& unresolved) {
  if (unresolved.Waves(Eigen::VectorXd(0)).cols() == 0) return;
  for (const FittedGroup& group : fitted) {
    Eigen::VectorXd th_rad(group.group->Readings());
    Eigen::Index at = 0;
    for (const Eigen::VectorXd& pass : group.th_rad) {
      th_rad.segment(at, pass.size()) = pass;
      at += pass.size();
    }
    folded.push_back(OfWaves(group, unresolved.Waves(th_rad), group.fit.Highest()));
  }
}

ScaleSteps WithOwnStep(ScaleSteps stated, const std::vector<Reading>& readings) {
  std::vector<double> shown_rad;
  for (const Reading& reading : readings) {
    if (std::isfinite(reading.measured_rad)) shown_rad.push_back(reading.measured_rad);
  }
  if (shown_rad.empty()) return stated;
  const double own_rad = CommonStep(Eigen::Map<const Eigen::VectorXd>(shown_rad.data(), std::ssize(shown_rad)));
  stated.step_rad = std::max(stated.step_rad, stated.at_once * own_rad);
  return stated;
}

void Visits::Add(std::vector<std::pair<double, double>> at, double step_rad) {
  for (auto& [place_rad, rest_rad] : at) place_rad -= units::turn * std::floor(place_rad / units::turn);
  std::ranges::sort(at);
  for (std::size_t first = 0, end = 0; first < at.size(); first = end) {
    double sum = 0.0, squares = 0.0;
    for (end = first; end < at.size() && at[end].first - at[first].first < 0.5 * step_rad; ++end) {
      sum += at[end].second;
      squares += at[end].second * at[end].second;
    }
    const auto count = static_cast<double>(end - first);
    squares_rad2 += std::max(0.0, squares - sum * sum / count);
    dof += count - 1.0;
    readings += count;
    places += 1.0;
  }
}

Rounding RoundingIn(const std::vector<FittedGroup>& groups, const OrderNoise& noise, int highest, const ScaleSteps& steps) {
  Rounding rounding;
  rounding.groups.resize(groups.size());
  if (!(steps.step_rad > 0.0)) return rounding;
  Visits visits;
  for (const FittedGroup& fitted : groups) AddVisits(fitted, steps.step_rad, visits);
  const double one2 = steps.step_rad * steps.step_rad / 12.0;
  const double of_one_rad = std::sqrt(steps.at_once) * visits.Scatter_rad();
  const double noise_rad = visits.dof > 0.0 ? NoiseBehindRounding(steps.step_rad, of_one_rad)
                                            : std::sqrt(std::max(0.0, steps.at_once * noise.white_rad2 - one2));
  rounding.visits = visits.OfEach();
  rounding.place_rad2 = RoundingOf(steps.step_rad, noise_rad, INFINITY).repeated;
  rounding.same_places = SamePlaces(groups, steps.step_rad);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (int round = 0; round < 2; ++round) {
      const std::vector<bool> own = OwnOrders(groups[g], steps.step_rad, noise.white_rad2, rounding.groups[g]);
      rounding.groups[g] = OfWaves(groups[g], RoundingWaves(Shown_rad(groups[g], own), steps.step_rad, noise_rad), highest);
    }
    rounding.direction.push_back(groups[g].group->direction);
    if (noise.between_laps) AddSmeared(groups[g], rounding.visits * rounding.place_rad2, rounding.groups[g]);
  }
  return rounding;
}

}  // namespace twinbench::separate::encoder
