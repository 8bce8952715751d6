#include "twin/diagnose/hob/collector.h"

#include <fmt/format.h>

#include <cmath>

#include "twin/core/units.h"

namespace twinbench::diagnose::hob {
namespace {

std::vector<Seen> Places(const SignalContext& c) {
  if (c.channels == 1) return {Seen::kByEncoders};
  return {Seen::kByBoth, Seen::kByEncoders, Seen::kByInterferometer};
}

std::string NameOf(Seen seen) {
  if (seen == Seen::kByEncoders) return kTransmission;
  if (seen == Seen::kByInterferometer) return kInterferometer;
  return fmt::format("{}, {}", kTransmission, kInterferometer);
}

}  // namespace

Family Collector::Make(const Sort& sort, const SharedBase& base, Seen seen, const Words& words) const {
  Family family;
  family.kind = Kind::kUnknown;
  family.effect = family.group = sort.name;
  family.where = NameOf(seen);
  family.prior_weight = sort.weight;
  const auto columns = static_cast<std::size_t>(base->series(0).cols());
  family.amplitudes.assign(columns, {"amplitude", "arcsec", units::arcsec, kPriorToBeSet});
  Use(common_.context, {base, seen}, family);
  family.describe = [words, where = family.where](int g, const Eigen::VectorXd& x) {
    return fmt::format("{}, on {}, amplitude {:.2g} arcsec", words(g), where, x.norm() / units::arcsec);
  };
  return family;
}

void Collector::Add(const Sort& sort, const SharedBase& base, const Words& words) {
  for (const Seen seen : Places(context())) families_.push_back(Make(sort, base, seen, words));
}

void Collector::Add(const Sort& sort, const Eigen::MatrixXd& series, const std::string& words) {
  Add(sort, BaseOf(common_.context, 1, [series](int) { return series; }), [words](int) { return words; });
}

void Collector::AddOver(const Sort& sort, const Shape& shape, const SharedBase& base, const SeriesAt& at,
                        const Words& words) {
  for (const Seen seen : Places(context())) {
    Family family = Make(sort, base, seen, words);
    family.shapes = {shape};
    family.at = RowsAt(common_.context, at, seen);
    families_.push_back(std::move(family));
  }
}

void Collector::AddModulated(const Sort& sort, int last, const Eigen::VectorXd& factor, const std::string& words) {
  const SharedBase orders = OrdersOf(common_.context, context().table_rad, 1, last, factor);
  Add(sort, orders, [words](int g) { return fmt::format(fmt::runtime(words), g + 1); });
}

Eigen::VectorXd Unit(const Eigen::VectorXd& signal) {
  const double rms = std::sqrt(signal.squaredNorm() / static_cast<double>(signal.size()));
  return rms > 0.0 ? Eigen::VectorXd(signal / rms) : signal;
}

}  // namespace twinbench::diagnose::hob
