#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/diagnose/engine/bundle.h"
#include "twin/diagnose/engine/family.h"
#include "twin/diagnose/engine/known_products.h"
#include "twin/diagnose/engine/linear_run.h"
#include "twin/diagnose/engine/noise_model.h"
#include "twin/diagnose/engine/projector.h"

namespace twinbench::diagnose {

/// Causes that are already in the model, as a further projection: W2 = W - B B' with B = W S R^-1, R'R = S'WS.
class Deflation {
 public:
  Deflation() = default;
  /// @param columns  Whitened signatures of the accepted causes, rows x any; dependent ones are dropped.
  Deflation(const Projector& projector, const Eigen::MatrixXd& columns);

  const Eigen::MatrixXd& Basis() const { return basis_; }  // rows x independent columns: ProjectedColumns() * Transform()
  const Eigen::MatrixXd& ProjectedColumns() const { return projected_; }
  const Eigen::MatrixXd& Transform() const { return transform_; }
  /// The same of nothing: no columns, but so many rows.
  Eigen::MatrixXd BasisOf(Eigen::Index rows) const { return Rank() > 0 ? basis_ : Eigen::MatrixXd(rows, 0); }
  /// Takes the causes out of data that were projected with W.
  Eigen::MatrixXd Apply(const Eigen::MatrixXd& projected) const;
  /// Of them, what Apply takes out along the basis: independent columns x any.
  Eigen::MatrixXd Along(const Eigen::MatrixXd& projected) const { return dual_.transpose() * projected; }
  /// Coefficients of the causes in projected data, and their covariance for unit noise.
  Eigen::MatrixXd Amplitudes(const Eigen::MatrixXd& projected) const { return solve_ * projected; }
  int Rank() const { return static_cast<int>(basis_.cols()); }

 private:
  Eigen::MatrixXd projected_, transform_, basis_, dual_, solve_, covariance_;
};

/// Data that the free unknowns have had their share of.
struct Projected {
  Eigen::MatrixXd rows;    // W y, rows x runs
  Eigen::VectorXd power;   // y' W y, one a run
  Eigen::MatrixXd before;  // the same before causes were taken out; empty if there were none
  Eigen::MatrixXd taken;   // what they took, along the deflation's basis
};
Projected Project(const Projector& projector, const Deflation& deflation, const Eigen::MatrixXd& white);

/// How badly the model with all its free unknowns, and no cause, fits: y' W y with the stated deviations.
struct Misfit {
  double power = 0.0;
  double degrees_of_freedom = 1.0;
};
Misfit FreeMisfit(const LinearRun& run);

/// What the scan says of each family (rows) in each run (columns).
struct Evidence {
  Eigen::MatrixXd log_bayes;   // log Bayes factor against no effect, averaged over grid and prior scale
  Eigen::MatrixXi grid_point;  // best one
  Eigen::MatrixXd explained;   // its share of y'Wy, free amplitudes
};

/// Trust in the stated noise figure, in degrees of freedom that stand beside those of the data.
double PseudoDegrees(const LinearRun& run);

/// Scores all families on the same design.
///
/// At each grid point, with prior-scaled and projected signatures of singular values d and coefficients c,
///     log BF = -1/2 sum log(1 + d^2) - (nu0 + m)/2 log[(nu0 + y'Wy - sum c^2 d^2 / (1 + d^2)) / (nu0 + y'Wy)],
/// which leaves the noise scale free within nu0 pseudo degrees of freedom of what is stated. The mean over grid
/// points and prior scales is the look-elsewhere correction (Bayer & Seljak 2020).
class Scanner {
 public:
  /// Keeps references: run, projector and families must outlive the scanner; the noise model is copied, for an
  /// analysis that has both may be moved.
  Scanner(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
          const std::vector<Family>& families, int threads = 1);

  Evidence Scan(const Projected& data, const Deflation& deflation) const;

  const std::vector<Family>& Families() const { return families_; }

  /// What a family explains of one run at grid points from `first` to `last`, amplitudes free.
  struct Fit {
    Eigen::VectorXd amplitudes;
    double power = 0.0;
  };
  std::vector<Fit> FitEach(int family, int first, int last, const Projected& data,
                           const Deflation& deflation) const;

  /// Squared length of a family's projected signature per unit of its first amplitude [1 / SI^2]: the largest over
  /// the grid.
  double Information(int family) const;
  /// The grid point where it is that large.
  int MostTelling(int family) const;
  /// The same at one grid point.
  double Information(int family, int grid_point) const;

 private:
  const Bundle& BundleOf(int family) const;
  /// S'F'Y of one bundle.
  struct Products {
    const Unwhitened* runs = nullptr;  // of which they are made by chunks; none: they are all there
    RunsByRow data, removed;
  };
  std::vector<Products> ProductsOf(const Projected& data, const Deflation& deflation, const Unwhitened& runs) const;
  void ScanBundle(const Bundle& bundle, const Projected& data, const Deflation& deflation, Products products,
                  Evidence& sums) const;

  const LinearRun& run_;
  const NoiseModel noise_;
  const Projector& projector_;
  const std::vector<Family>& families_;
  const int threads_;
  std::vector<Bundle> bundles_;
  mutable KnownProducts known_;  // no two scans at a time
};

}  // namespace twinbench::diagnose
