#include "twin/diagnose/engine/repeats.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "twin/core/units.h"

namespace twinbench::diagnose {
namespace {

using Places = std::vector<int>;

int CountOf(const Places& place) {
  return place.empty() ? 0 : 1 + *std::ranges::max_element(place);
}

/// Readings that follow each other at one place are one visit.
int VisitsIn(const Places& place) {
  int visits = 1;
  for (std::size_t i = 1; i < place.size(); ++i) visits += place[i] != place[i - 1] ? 1 : 0;
  return visits;
}

/// In the order of their keys.
template <class Key>
Places Numbered(const std::vector<Key>& keys) {
  std::map<Key, int> number;
  for (const Key& key : keys) number.try_emplace(key, 0);
  int next = 0;
  for (auto& [key, n] : number) n = next++;
  Places place;
  for (const Key& key : keys) place.push_back(number.at(key));
  return place;
}

/// Readings nearer than that on the circle are at one target.
Places Targets(const Eigen::VectorXd& angle_rad, const std::vector<int>& setup, double same_rad) {
  std::vector<std::pair<double, std::size_t>> on_circle;
  for (Eigen::Index i = 0; i < angle_rad.size(); ++i) {
    const double turned = angle_rad[i] + 0.5 * same_rad;  // 360 deg is 0 deg
    on_circle.emplace_back(turned - units::turn * std::floor(turned / units::turn), static_cast<std::size_t>(i));
  }
  std::ranges::sort(on_circle);
  std::vector<std::pair<int, int>> keys(on_circle.size());
  int target = 0;
  for (std::size_t k = 0; k < on_circle.size(); ++k) {
    if (k > 0 && on_circle[k].first - on_circle[k - 1].first > same_rad) ++target;
    keys[on_circle[k].second] = {setup[on_circle[k].second], target};
  }
  return Numbered(keys);
}

Places BinnedPlaces(const Eigen::VectorXd& angle_rad, const std::vector<int>& setup, double width_rad) {
  std::vector<std::pair<int, int>> keys;
  const int count = std::max(1, static_cast<int>(std::lround(units::turn / width_rad)));
  for (Eigen::Index i = 0; i < angle_rad.size(); ++i) {
    const double share = angle_rad[i] / units::turn;
    keys.emplace_back(setup[static_cast<std::size_t>(i)],
                      std::min(count - 1, static_cast<int>((share - std::floor(share)) * count)));
  }
  return Numbered(keys);
}

}  // namespace

std::vector<int> PlacesOf(const Eigen::VectorXd& angle_rad, const std::vector<int>& setup) {
  constexpr double kSame_rad = 1e-5 * units::turn, kVisitedAgain = 1.5;
  constexpr double kInBin = 8.0;
  constexpr int kMostBins = 720;
  const auto readings = static_cast<double>(angle_rad.size());
  if (readings < kInBin) return {};
  Places place = Targets(angle_rad, setup, kSame_rad);
  if (CountOf(place) * kVisitedAgain > readings) {
    const double range_rad = std::min(units::turn, angle_rad.maxCoeff() - angle_rad.minCoeff());
    place = BinnedPlaces(angle_rad, setup, range_rad / std::clamp(readings / kInBin, 1.0, static_cast<double>(kMostBins)));
  }
  return VisitsIn(place) < kVisitedAgain * CountOf(place) ? Places{} : place;
}

double PowerNotRepeating(const std::vector<int>& place, const Eigen::VectorXd& rows) {
  const int places = CountOf(place);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(places), count = sum;
  for (Eigen::Index k = 0; k < rows.size(); ++k) {
    sum[place[static_cast<std::size_t>(k)]] += rows[k];
    count[place[static_cast<std::size_t>(k)]] += 1.0;
  }
  const double within = rows.squaredNorm() - (sum.array().square() / count.array()).sum();
  const double visits = VisitsIn(place);
  return within * visits / std::max(1.0, visits - places);
}

}  // namespace twinbench::diagnose
