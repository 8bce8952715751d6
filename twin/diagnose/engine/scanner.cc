#include "twin/diagnose/engine/scanner.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "twin/core/linear_algebra.h"
#include "twin/core/side_by_side.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

constexpr Eigen::Index kMostKeptValues = 40'000'000;  // of signatures: 320 MB
constexpr double kAbsorbed = 1e-10;  // share of a signature's power below which only priors and rounding are left

Eigen::VectorXd PriorSds(const Family& family) {
  Eigen::VectorXd sd(std::ssize(family.amplitudes));
  std::transform(family.amplitudes.begin(), family.amplitudes.end(), sd.begin(),
                 [](const Amplitude& a) { return a.prior_sd; });
  return sd;
}

/// A prior that allows one sign only doubles the evidence where the estimate has it and removes most where it has
/// not: log 2 Phi(t), t the posterior mean over its deviation.
void AddOneSided(const Family& family, const RunsByRow& products, double d2, double prior_scale,
                 Eigen::ArrayXd& log_bayes) {
  const Amplitude& a = family.amplitudes.front();
  if (family.amplitudes.size() != 1 || (a.lower < 0.0 && a.upper > 0.0)) return;
  const double side = a.lower >= 0.0 ? 1.0 : -1.0;
  const double per_product = side * prior_scale / std::sqrt(1.0 + prior_scale * prior_scale * d2);
  for (Eigen::Index k = 0; k < log_bayes.size(); ++k) {
    const double t = per_product * products(0, k);
    log_bayes[k] += std::log(std::max(std::erfc(-t / std::sqrt(2.0)), 1e-300));
  }
}

/// Squared singular values of prior-scaled signatures and the squared coefficients of the data along them.
struct Spectrum {
  Eigen::ArrayXd d2;   // size p
  RunsByRow c2;        // p x runs
};

template <class Values, class Vectors>
Spectrum Along(const Values& values, const Vectors& vectors, const RunsByRow& products, double raw) {
  Spectrum s;
  s.d2 = values.array().max(0.0);
  const double least = std::max(1e-10 * s.d2.maxCoeff(), kAbsorbed * raw);
  s.c2 = vectors.transpose().lazyProduct(products);
  s.c2 = s.c2.array().square();
  for (Eigen::Index i = 0; i < s.d2.size(); ++i) {
    if (s.d2[i] > least) {
      s.c2.row(i) /= s.d2[i];
    } else {
      s.d2[i] = 0.0;
      s.c2.row(i).setZero();
    }
  }
  return s;
}

/// @param gram      S'WS of the member, prior-scaled.
/// @param products  S'Wy, prior-scaled.
/// @param raw       Trace of S'S: less than a 1e-10 of it is no signal any more.
Spectrum SpectrumOf(const Eigen::MatrixXd& gram, const RunsByRow& products, double raw) {
  // Most signatures are one column or a wave, and there are thousands of them.
  if (gram.rows() == 1) return Along(gram.diagonal(), Eigen::Matrix<double, 1, 1>(1.0), products, raw);
  if (gram.rows() == 2) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(gram);
    return Along(eigen.eigenvalues(), eigen.eigenvectors(), products, raw);
  }
  const auto [values, vectors] = EigenOfSymmetric(gram);
  return Along(values, vectors, products, raw);
}

}  // namespace

double PseudoDegrees(const LinearRun& run) {
  return run.sigma_stated ? tuning::kPseudoDegrees : tuning::kPseudoEstimated;
}

Scanner::Scanner(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                 const std::vector<Family>& families, int threads)
    : run_(run), noise_(noise), projector_(projector), families_(families), threads_(threads), known_(run_, noise_, bundles_, threads) {
  std::vector<const Base*> bases;
  std::vector<std::vector<int>> sharing;
  for (int k = 0; k < std::ssize(families_); ++k) {
    const Base* const base = families_[static_cast<std::size_t>(k)].base.get();
    const auto known = base ? std::find(bases.begin(), bases.end(), base) : bases.end();
    if (known != bases.end()) {
      sharing[static_cast<std::size_t>(known - bases.begin())].push_back(k);
      continue;
    }
    bases.push_back(base);
    sharing.push_back({k});
  }
  Eigen::Index kept_left = kMostKeptValues;
  for (std::vector<int>& members : sharing) {
    bundles_.emplace_back(run, noise, projector, families, std::move(members), kept_left);
  }
}

/// One run is scanned again and again beside the same few causes; of many there is a first time only, and what they
/// have in common with all signatures fills the memory.
std::vector<Scanner::Products> Scanner::ProductsOf(const Projected& data, const Deflation& deflation,
                                                   const Unwhitened& runs) const {
  const bool is_one = data.rows.cols() == 1, has_causes = deflation.Rank() > 0;
  const Eigen::MatrixXd& before = has_causes ? data.before : data.rows;
  const std::vector<RunsByRow> of_data = is_one ? known_.Of(before) : std::vector<RunsByRow>(bundles_.size());
  const std::vector<RunsByRow> of_causes = known_.Of(has_causes ? deflation.ProjectedColumns() : Eigen::MatrixXd());
  std::vector<Products> products(bundles_.size());
  for (std::size_t b = 0; b < bundles_.size(); ++b) {
    if (has_causes) products[b].removed.noalias() = of_causes[b] * deflation.Transform();
    products[b].data = of_data[b];
    if (is_one && has_causes) products[b].data.noalias() -= products[b].removed * data.taken;
    if (!is_one) products[b].runs = &runs;
  }
  return products;
}

void Scanner::ScanBundle(const Bundle& bundle, const Projected& data, const Deflation& deflation, Products all,
                         Evidence& out) const {
  const Eigen::Index runs = data.rows.cols();
  const double nu = PseudoDegrees(run_);
  const double half = 0.5 * (nu + projector_.DegreesOfFreedom() - deflation.Rank());
  const Eigen::ArrayXd power = nu + data.power.array();
  const std::vector<int>& members = bundle.Members();
  std::vector<LogMean> mean(members.size(), LogMean(runs));
  std::vector<Eigen::ArrayXd> top(members.size(), Eigen::ArrayXd::Constant(runs, -1.0));
  std::vector<Eigen::MatrixXd> scaled;  // from the bundle's columns to the member's, prior-scaled
  for (const int member : members) {
    const Family& family = families_[static_cast<std::size_t>(member)];
    const Eigen::MatrixXd sd = PriorSds(family).asDiagonal();
    scaled.push_back(family.base ? Eigen::MatrixXd(family.map * sd) : sd);
  }
  Eigen::MatrixXd gram;  // of the grid point
  Eigen::ArrayXd log_bayes(runs);
  for (int g = 0; g < bundle.Grid(); ++g) {
    if (all.runs && g % bundle.Step() == 0) all.data = bundle.Products(g / bundle.Step(), *all.runs);
    const auto products = all.data.middleRows((all.runs ? g % bundle.Step() : g) * bundle.Columns(), bundle.Columns());
    gram = bundle.Gram(g);
    if (deflation.Rank() > 0) {
      const auto r = all.removed.middleRows(g * bundle.Columns(), bundle.Columns());
      gram.noalias() -= r * r.transpose();
    }
    for (std::size_t m = 0; m < members.size(); ++m) {
      const Family& family = families_[static_cast<std::size_t>(members[m])];
      const Eigen::MatrixXd& own = scaled[m];
      const RunsByRow product = own.transpose().lazyProduct(products);
      const double raw = (own.transpose() * bundle.Raw(g) * own).trace();
      const Spectrum s = SpectrumOf(own.transpose() * gram * own, product, raw);
      const auto row = static_cast<Eigen::Index>(members[m]);
      for (Eigen::Index k = 0; k < runs; ++k) {
        const double explained = s.c2.col(k).sum();
        if (explained <= top[m][k]) continue;
        top[m][k] = explained;
        out.grid_point(row, k) = g;
        out.explained(row, k) = explained;
      }
      for (const double f : tuning::kPriorScales) {
        const Eigen::ArrayXd d2 = f * f * s.d2;
        const double occam = 0.5 * (1.0 + d2).log().sum();
        LogBayesOf(d2 / (1.0 + d2), s.c2, power, occam, half, log_bayes);
        AddOneSided(family, product, s.d2[0], f, log_bayes);
        mean[m].Add(log_bayes);
      }
    }
  }
  for (std::size_t m = 0; m < members.size(); ++m) {
    out.log_bayes.row(members[m]) = mean[m].Value().transpose();
  }
}

const Bundle& Scanner::BundleOf(int family) const {
  const auto has = [family](const Bundle& b) { return std::ranges::count(b.Members(), family) > 0; };
  return *std::ranges::find_if(bundles_, has);
}

std::vector<Scanner::Fit> Scanner::FitEach(int family, int first, int last, const Projected& data,
                                           const Deflation& deflation) const {
  const Family& f = families_[static_cast<std::size_t>(family)];
  const Bundle& bundle = BundleOf(family);
  const Unwhitened rows(run_, noise_, data.rows.col(0)), removed_rows(run_, noise_, deflation.BasisOf(run_.Rows()));
  RunsByRow products, removed;
  std::vector<Fit> fits;
  for (int g = first; g <= last; ++g) {
    if (g == first || g % bundle.Step() == 0) {
      products = bundle.Products(g / bundle.Step(), rows);
      removed = bundle.Products(g / bundle.Step(), removed_rows);
    }
    const Eigen::Index at = (g % bundle.Step()) * bundle.Columns();
    const auto r = removed.middleRows(at, bundle.Columns());
    Eigen::MatrixXd gram = bundle.Gram(g) - r * r.transpose();
    Eigen::VectorXd product = products.middleRows(at, bundle.Columns());
    if (f.base) {
      gram = f.map.transpose() * gram * f.map;
      product = f.map.transpose() * product;
    }
    const Eigen::VectorXd amplitudes = SolveShortest(gram, product);
    fits.push_back({amplitudes, product.dot(amplitudes)});
  }
  return fits;
}

double Scanner::Information(int family, int grid_point) const {
  const Eigen::MatrixXd& gram = BundleOf(family).Gram(grid_point);
  const Family& f = families_[static_cast<std::size_t>(family)];
  return f.base ? f.map.col(0).dot(gram * f.map.col(0)) : gram(0, 0);
}

double Scanner::Information(int family) const {
  return std::max(0.0, Information(family, MostTelling(family)));
}

int Scanner::MostTelling(int family) const {
  int best = 0;
  for (int g = 1; g < BundleOf(family).Grid(); ++g) {
    if (Information(family, g) > Information(family, best)) best = g;
  }
  return best;
}

Evidence Scanner::Scan(const Projected& data, const Deflation& deflation) const {
  Evidence out;
  out.log_bayes.resize(std::ssize(families_), data.rows.cols());
  out.explained.setZero(std::ssize(families_), data.rows.cols());
  out.grid_point.setZero(std::ssize(families_), data.rows.cols());
  const bool is_one = data.rows.cols() == 1;  // then all its products are known
  const Unwhitened runs(run_, noise_, is_one ? Eigen::MatrixXd(run_.Rows(), 0) : data.rows);
  std::vector<Products> products = ProductsOf(data, deflation, runs);
  SideBySide(static_cast<int>(std::ssize(bundles_)), threads_, [&](int b) {
    const auto at = static_cast<std::size_t>(b);
    ScanBundle(bundles_[at], data, deflation, std::move(products[at]), out);
  });
  return out;
}

}  // namespace twinbench::diagnose
