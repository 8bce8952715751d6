#include "twin/diagnose/engine/bundle.h"

#include <algorithm>
#include <utility>

namespace twinbench::diagnose {
namespace {

/// Columns of a chunk, and values: of long runs there are fewer columns.
constexpr int kChunkColumns = 128, kChunkValues = 200'000;

int StepOf(const LinearRun& run, int columns) {
  const int most = std::clamp(kChunkValues / std::max(1, run.Rows()), 1, kChunkColumns);
  return std::max(1, most / std::max(1, columns));
}

/// Adds A'A of each grid point's `width` columns to its block of `grams`, where they begin at `offset`.
void AddGrams(const RunsByRow& A, Eigen::Index width, Eigen::Index offset, std::vector<Eigen::MatrixXd>& grams) {
  constexpr Eigen::Index kFew = 8;  // above it a matrix product by blocks pays
  for (std::size_t g = 0; width > kFew && g < grams.size(); ++g) {
    const auto own = A.middleCols(static_cast<Eigen::Index>(g) * width, width);
    grams[g].block(offset, offset, width, width).noalias() += own.transpose() * own;
  }
  if (width > kFew) return;
  for (Eigen::Index apart = 0; apart < width; ++apart) {
    Eigen::RowVectorXd products = Eigen::RowVectorXd::Zero(A.cols() - apart);
    for (Eigen::Index row = 0; row < A.rows(); ++row)
      products.array() += A.row(row).head(products.size()).array() * A.row(row).tail(products.size()).array();
    for (std::size_t g = 0; g < grams.size(); ++g) {
      for (Eigen::Index i = offset, j = i + apart; j < offset + width; ++i, ++j) {
        const double more = products[static_cast<Eigen::Index>(g) * width + i - offset];
        grams[g](i, j) += more;
        if (apart > 0) grams[g](j, i) += more;
      }
    }
  }
}

}  // namespace

Unwhitened::Unwhitened(const LinearRun& run, const NoiseModel& noise, const Eigen::MatrixXd& white)
    : rows_(noise.WhitenTransposed(run, white)), by_row_(rows_) {
  const Eigen::Index readings = run.schedule.Readings(), channels = run.Channels();
  if (channels == 1) return;
  const bool is_empty = rows_.size() == 0;
  using Stride = Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>;
  for (Eigen::Index c = 0; c < channels; ++c) {
    channel_.emplace_back(Eigen::Map<const Eigen::MatrixXd, 0, Stride>(
        is_empty ? nullptr : rows_.data() + c, readings, rows_.cols(), Stride(rows_.rows(), channels)));
  }
}

Bundle::Bundle(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
               const std::vector<Family>& families, std::vector<int> members, Eigen::Index& kept_left)
    : family_(families[static_cast<std::size_t>(members.front())]), members_(std::move(members)) {
  grid_ = family_.base ? family_.base->grid : family_.grid;
  columns_ = static_cast<int>(family_.base ? family_.map.rows() : std::ssize(family_.amplitudes));
  if (family_.base && family_.base->sums) {
    sums_ = family_.base->sums();
    step_ = grid_;
    SumUp(run, noise, projector);
  } else {
    step_ = StepOf(run, columns_);
    WriteOut(run, noise, projector, kept_left);
  }
}

/// S'WS = S'F'FS - H'H with H of J'FS = (F'J)'S, F the whitening.
void Bundle::SumUp(const LinearRun& run, const NoiseModel& noise, const Projector& projector) {
  const Unwhitened unknowns(run, noise, projector.Jacobian());
  raw_ = sums_->Squares(noise.Precision(run));
  const Eigen::MatrixXd H = projector.AbsorbedOf(sums_->Products(unknowns.Rows()).transpose());
  for (int g = 0; g < grid_; ++g) {
    const auto h = H.middleCols(g * columns_, columns_);
    gram_.push_back(raw_[static_cast<std::size_t>(g)] - h.transpose() * h);
  }
}

/// Channel by channel: what shows on one of them is not written out as zeros on the others.
void Bundle::WriteOut(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                      Eigen::Index& kept_left) {
  const Eigen::Index channels = family_.base ? family_.base->channels : 1, width = columns_ / channels;
  for (int chunk = 0; chunk * step_ < grid_; ++chunk) {
    Eigen::MatrixXd made = Make(chunk);
    const Eigen::Index points = made.cols() / width;
    std::vector<Eigen::MatrixXd> raw(static_cast<std::size_t>(points), Eigen::MatrixXd::Zero(columns_, columns_));
    std::vector<Eigen::MatrixXd> absorbed = raw;
    RunsByRow gathered(projector.Jacobian().cols(), points * columns_);  // a grid point's channels side by side
    for (Eigen::Index c = 0; c < channels; ++c) {
      const RunsByRow white = noise.Whiten(run, made, {c, channels});
      AddGrams(white, width, c * width, raw);
      const RunsByRow of_channel = projector.Gathered(white, {c, channels});
      for (Eigen::Index k = 0; k < points; ++k)
        gathered.middleCols(k * columns_ + c * width, width) = of_channel.middleCols(k * width, width);
    }
    AddGrams(projector.AbsorbedOf(std::move(gathered)), columns_, 0, absorbed);
    for (std::size_t k = 0; k < raw.size(); ++k) {
      gram_.push_back(raw[k] - absorbed[k]);
      raw_.push_back(std::move(raw[k]));
    }
    if (std::ssize(kept_) < chunk || made.size() > kept_left) continue;
    kept_left -= made.size();
    kept_.push_back(std::move(made));
  }
}

Eigen::MatrixXd Bundle::Make(int chunk) const {
  const int first = chunk * step_, last = std::min(first + step_, grid_);
  Eigen::MatrixXd all;
  for (int g = first; g < last; ++g) {
    const Eigen::MatrixXd one = family_.base ? family_.base->series(g) : family_.columns(g);
    if (g == first) all.resize(one.rows(), one.cols() * (last - first));
    all.middleCols(one.cols() * (g - first), one.cols()) = one;
  }
  return all;
}

RunsByRow Bundle::Products(int chunk, const Unwhitened& Y) const {
  if (sums_) return sums_->Products(Y.Rows());
  const bool is_kept = chunk < std::ssize(kept_);
  const Eigen::MatrixXd again = is_kept ? Eigen::MatrixXd() : Make(chunk);
  const Eigen::MatrixXd& made = is_kept ? kept_[static_cast<std::size_t>(chunk)] : again;
  if (!family_.base) return TransposedProduct(made, Y.ByRow());
  const int channels = family_.base->channels;
  const Eigen::Index series = columns_ / channels;
  RunsByRow products(made.cols() * channels, Y.Rows().cols());
  for (int c = 0; c < channels; ++c) {
    const RunsByRow of_channel = TransposedProduct(made, Y.Channel(c));
    for (Eigen::Index at = 0; at < made.cols(); at += series) {
      products.middleRows(at * channels + c * series, series) = of_channel.middleRows(at, series);
    }
  }
  return products;
}

}  // namespace twinbench::diagnose
