#pragma once

#include <functional>
#include <string>
#include <vector>

#include "twin/uncertainty/contribution.h"

namespace twinbench::uncertainty {

/// A number of merit of one run: "stability.standard_deviation.dy_um".
struct Figure {
  std::string name;
  double value = 0.0;
};

/// Carries a scenario out on its twin and evaluates it.
using RunFigures = std::function<std::vector<Figure>(const Scenario&)>;

/// What one contribution does, figure by figure.
struct Share {
  std::string contribution;
  std::vector<double> alone;    // with everything else silent but what stays; empty of what stays itself
  std::vector<double> without;  // with everything but it
};

struct OneAtATime {
  std::vector<Figure> total;  // as the scenario says
  std::vector<double> none;   // with everything silent but what stays: the floor
  std::vector<Share> shares;

  /// Root of the sum of the squares of `none` and of what each adds alone beyond it. Meant for standard deviations
  /// of things that do not know of each other; ranges do not add up so.
  double InQuadrature(std::size_t figure) const;
};

/// Runs the scenario, once with every contribution silent that does not stay, and twice for each of them. A
/// contribution that the scenario does not have (silence changes no figure) is left out.
OneAtATime RunOneAtATime(const Scenario& scenario, const std::vector<Contribution>& contributions,
                         const RunFigures& run);

}  // namespace twinbench::uncertainty
