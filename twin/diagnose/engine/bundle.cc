#include "twin/diagnose/engine/bundle.h"

#include <algorithm>
#include <utility>

namespace twinbench::diagnose {
namespace {

/// Columns of a chunk, and values: of long runs there are fewer columns.
constexpr int kChunkColumns = 128, kChunkValues = 1'000'000;

int StepOf(const LinearRun& run, int columns) {
  const int most = std::clamp(kChunkValues / std::max(1, run.Rows()), 1, kChunkColumns);
  return std::max(1, most / std::max(1, columns));
}

/// A'A of few columns, too few for a matrix product by blocks to pay.
Eigen::MatrixXd SmallGram(const Eigen::MatrixXd& A) {
  constexpr Eigen::Index kFew = 8;
  if (A.cols() > kFew) return A.transpose() * A;
  return A.transpose().lazyProduct(A);
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

void Bundle::WriteOut(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                      Eigen::Index& kept_left) {
  for (int chunk = 0; chunk * step_ < grid_; ++chunk) {
    Eigen::MatrixXd made = Make(chunk);
    const Eigen::MatrixXd S = Whitened(run, noise, made);
    const Eigen::MatrixXd H = projector.Absorbed(S);
    for (Eigen::Index k = 0; k < S.cols() / columns_; ++k) {
      const std::vector<Eigen::Index> of_point = ColumnsOf(k, S.cols());
      const Eigen::MatrixXd s = S(Eigen::all, of_point), h = H(Eigen::all, of_point);
      raw_.push_back(SmallGram(s));
      gram_.push_back(raw_.back() - SmallGram(h));
    }
    if (std::ssize(kept_) < chunk || made.size() > kept_left) continue;
    kept_left -= made.size();
    kept_.push_back(std::move(made));
  }
}

Eigen::MatrixXd Bundle::Make(int chunk) const {
  const auto one = [this](int g) { return family_.base ? family_.base->series(g) : family_.columns(g); };
  const int first = chunk * step_, last = std::min(first + step_, grid_);
  Eigen::MatrixXd all = one(first);
  const Eigen::Index width = all.cols();
  all.conservativeResize(Eigen::NoChange, width * (last - first));
  for (int g = first + 1; g < last; ++g) all.middleCols(width * (g - first), width) = one(g);
  return all;
}

std::vector<Eigen::Index> Bundle::ColumnsOf(Eigen::Index k, Eigen::Index all) const {
  const Eigen::Index channels = family_.base ? family_.base->channels : 1, series = columns_ / channels;
  std::vector<Eigen::Index> columns;
  for (Eigen::Index c = 0; c < channels; ++c) {
    for (Eigen::Index j = 0; j < series; ++j) columns.push_back(c * (all / channels) + k * series + j);
  }
  return columns;
}

Eigen::MatrixXd Bundle::Whitened(const LinearRun& run, const NoiseModel& noise, const Eigen::MatrixXd& made) const {
  return noise.Whiten(run, family_.base ? OnEachChannel(made, family_.base->channels) : made);
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
