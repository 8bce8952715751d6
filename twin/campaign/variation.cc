#include "twin/campaign/variation.h"

#include <cmath>

#include "twin/core/distributions.h"

namespace twinbench::campaign {
namespace {

struct QuantileAt {
  double p;

  double operator()(const Normal& d) const { return d.mean + d.sd * NormalExceededWith(1.0 - p); }
  double operator()(const Uniform& d) const { return d.lower + p * (d.upper - d.lower); }
  double operator()(const Triangular& d) const {
    const double width = d.upper - d.lower, left = d.mode - d.lower, right = d.upper - d.mode;
    return p * width < left ? d.lower + std::sqrt(p * width * left)
                            : d.upper - std::sqrt((1.0 - p) * width * right);
  }
  double operator()(const LogUniform& d) const { return d.lower * std::pow(d.upper / d.lower, p); }
};

}  // namespace

double Quantile(const Distribution& distribution, double p) {
  return std::visit(QuantileAt{p}, distribution);
}

}  // namespace twinbench::campaign
