#include "twin/diagnose/engine/known_products.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <string_view>

#include "twin/core/side_by_side.h"

namespace twinbench::diagnose {
namespace {

std::size_t DigestOf(const Eigen::MatrixXd& columns, Eigen::Index k) {
  const auto bytes = static_cast<std::size_t>(columns.rows()) * sizeof(double);
  return std::hash<std::string_view>()({reinterpret_cast<const char*>(columns.col(k).data()), bytes});
}

/// Of all chunks, one behind the other.
RunsByRow AllProducts(const Bundle& bundle, const Unwhitened& rows) {
  RunsByRow all(bundle.Grid() * bundle.Columns(), rows.Rows().cols());
  Eigen::Index done = 0;
  for (int chunk = 0; done < all.rows(); ++chunk) {
    const RunsByRow of_chunk = bundle.Products(chunk, rows);
    all.middleRows(done, of_chunk.rows()) = of_chunk;
    done += of_chunk.rows();
  }
  return all;
}

}  // namespace

const KnownProducts::Known* KnownProducts::Find(std::size_t digest) {
  const auto found = std::ranges::find(known_, digest, &Known::digest);
  if (found == known_.end()) return nullptr;
  known_.splice(known_.begin(), known_, found);
  return &known_.front();
}

void KnownProducts::Add(const Eigen::MatrixXd& white, const std::vector<std::size_t>& digests) {
  const Unwhitened rows(run_, noise_, white);
  std::vector<RunsByRow> products(bundles_.size());
  SideBySide(static_cast<int>(std::ssize(bundles_)), threads_, [&](int b) {
    const auto at = static_cast<std::size_t>(b);
    products[at] = AllProducts(bundles_[at], rows);
  });
  for (std::size_t k = 0; k < digests.size(); ++k) {
    Known known{digests[k], {}};
    for (const RunsByRow& of_bundle : products) known.of_bundle.emplace_back(of_bundle.col(static_cast<Eigen::Index>(k)));
    known_.push_front(std::move(known));
  }
}

std::vector<RunsByRow> KnownProducts::Of(const Eigen::MatrixXd& white) {
  constexpr Eigen::Index kMostValues = 12'000'000;  // 96 MB
  std::vector<std::size_t> digests, fresh_digests;
  std::vector<Eigen::Index> fresh;
  for (Eigen::Index k = 0; k < white.cols(); ++k) {
    digests.push_back(DigestOf(white, k));
    if (Find(digests.back()) || std::ranges::count(fresh_digests, digests.back()) > 0) continue;
    fresh.push_back(k);
    fresh_digests.push_back(digests.back());
  }
  if (!fresh.empty()) Add(Eigen::MatrixXd(white(Eigen::all, fresh)), fresh_digests);
  std::vector<RunsByRow> all;
  Eigen::Index signatures = 1;
  for (const Bundle& bundle : bundles_) {
    all.emplace_back(bundle.Grid() * bundle.Columns(), white.cols());
    signatures += all.back().rows();
  }
  for (std::size_t k = 0; k < digests.size(); ++k) {
    const Known* const known = Find(digests[k]);
    for (std::size_t b = 0; b < all.size(); ++b) all[b].col(static_cast<Eigen::Index>(k)) = known->of_bundle[b];
  }
  while (known_.size() > digests.size() && std::ssize(known_) > kMostValues / signatures) known_.pop_back();
  return all;
}

}  // namespace twinbench::diagnose
