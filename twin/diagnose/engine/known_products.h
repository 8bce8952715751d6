#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <list>
#include <vector>

#include "twin/diagnose/engine/bundle.h"

namespace twinbench::diagnose {

/// Products of all signatures with columns that come again: a search scans beside the same few terms in every order.
class KnownProducts {
 public:
  /// Keeps references.
  KnownProducts(const LinearRun& run, const NoiseModel& noise, const std::vector<Bundle>& bundles, int threads = 1)
      : run_(run), noise_(noise), bundles_(bundles), threads_(threads) {}

  /// S'F'Y of every bundle with F the whitening: all its grid points one after the other x columns of Y.
  /// @param white  Y, whitened: rows x any.
  std::vector<RunsByRow> Of(const Eigen::MatrixXd& white);

 private:
  struct Known {
    std::size_t digest;                        // of the column
    std::vector<Eigen::VectorXd> of_bundle;
  };
  void Add(const Eigen::MatrixXd& white, const std::vector<std::size_t>& digests);
  /// Makes it the latest.
  const Known* Find(std::size_t digest);

  const LinearRun& run_;
  const NoiseModel& noise_;
  const std::vector<Bundle>& bundles_;
  const int threads_;
  std::list<Known> known_;  // the latest first
};

}  // namespace twinbench::diagnose
