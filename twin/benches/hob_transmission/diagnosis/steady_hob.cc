#include "twin/benches/hob_transmission/diagnosis/steady_hob.h"

#include <Eigen/Core>
#include <map>
#include <set>

#include "twin/benches/hob_transmission/settings.h"
#include "twin/core/linear_algebra.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::hob {
namespace {

/// Samples of one set-up, and a number for each of its passes.
struct Mounting {
  std::vector<Eigen::Index> samples;
  std::map<int, Eigen::Index> pass;
};

std::map<int, Mounting> MountingsOf(const Schedule& s) {
  std::map<int, Mounting> mountings;
  for (std::size_t i = 0; i < s.setup.size(); ++i) {
    Mounting& m = mountings[s.setup[i]];
    m.samples.push_back(static_cast<Eigen::Index>(i));
    m.pass.try_emplace(s.pass[i], std::ssize(m.pass));
  }
  return mountings;
}

std::set<double> Orders(const TransmissionSettings& train) {
  std::set<double> orders = {train.HobOrder(), static_cast<double>(train.gear_teeth), train.WormOrder()};
  for (int k = 1; k <= kLowOrders; ++k) orders.insert(k);
  return orders;
}

Eigen::MatrixXd Basis(const SignalContext& c, const Mounting& mounting) {
  const std::set<double> orders = Orders(c.train);
  const Eigen::VectorXd table_rad = c.table_rad(mounting.samples), time_s = c.schedule.time_s(mounting.samples);
  Eigen::MatrixXd basis =
      Eigen::MatrixXd::Zero(table_rad.size(), 2 * std::ssize(orders) + std::ssize(mounting.pass) + 1);
  Eigen::Index at = 0;
  for (const double order : orders) basis.middleCols(2 * at++, 2) = model::Wave(order * table_rad);
  for (Eigen::Index i = 0; i < basis.rows(); ++i) {
    const int pass = c.schedule.pass[static_cast<std::size_t>(mounting.samples[static_cast<std::size_t>(i)])];
    basis(i, 2 * at + mounting.pass.at(pass)) = 1.0;
  }
  const double length_s = std::max(time_s.maxCoeff() - time_s.minCoeff(), 1e-6);
  basis.rightCols(1) = (time_s.array() - time_s.mean()) / length_s;
  return basis;
}

}  // namespace

Eigen::VectorXd SteadyHob_rad(const SignalContext& c) {
  const double ratio = c.train.Ratio();
  const Eigen::VectorXd m_rad = c.table_rad - ratio * c.hob_rad;
  Eigen::VectorXd steady_rad = c.hob_rad;
  for (const auto& [setup, mounting] : MountingsOf(c.schedule)) {
    const Eigen::MatrixXd basis = Basis(c, mounting);
    const Eigen::VectorXd own_rad = m_rad(mounting.samples);
    const Eigen::MatrixXd normal = basis.transpose() * basis;
    const Eigen::VectorXd centred_rad = own_rad.array() - own_rad.mean();
    const Eigen::VectorXd x = SolveShortest(normal, Eigen::VectorXd(basis.transpose() * centred_rad));
    const Eigen::VectorXd fit_rad = (basis * x).array() + own_rad.mean();
    steady_rad(mounting.samples) = (c.table_rad(mounting.samples) - fit_rad) / ratio;
  }
  return steady_rad;
}

}  // namespace twinbench::diagnose::hob
