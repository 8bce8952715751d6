#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "twin/diagnose/engine/candidates.h"
#include "twin/diagnose/engine/wave_series.h"
#include "twin/diagnose/unknown/design.h"

/// How generic families are made; only the files that make them need it.
namespace twinbench::diagnose::unknown {

using Words = std::function<std::string(int grid_point)>;
using WordsOfShape = std::function<std::string(const Eigen::VectorXd& shape)>;

class Collector {
 public:
  explicit Collector(const std::shared_ptr<const Design>& design) : design_(design) {}

  const Design& design() const { return *design_; }
  const std::shared_ptr<const Design>& shared() const { return design_; }

  /// The same series on every place.
  void Add(const std::string& sort, int grid, const Series& series, const Words& words);
  /// The same without a grid; nothing if it is zero.
  void Add(const std::string& sort, const Eigen::MatrixXd& series, const std::string& words);
  /// A grid over one continuous shape.
  void AddOver(const std::string& sort, const Shape& shape, const SeriesAt& at, const Words& words);
  /// Combinations of what named families are made of, too.
  /// @param shape  Of the base's grid, with `at`; or null.
  void AddShared(const std::string& sort, const std::shared_ptr<const Base>& base, const Words& words,
                 const Shape* shape = nullptr, const SeriesAt& at = {});
  /// Cosine and sine of many orders or frequencies.
  /// @param shape  Of their grid, with `at`; or null.
  void AddWaves(const std::string& sort, const WaveSeries& waves, const Words& words, const Shape* shape = nullptr,
                const SeriesAt& at = {});
  /// The same, told by the shape between the grid points.
  void AddWaves(const std::string& sort, const WaveSeries& waves, const WordsOfShape& words, const Shape& shape,
                const SeriesAt& at);
  /// Waves of the whole orders up to `last` of an angle, times a factor of each sample. @param words  "{}" is the
  /// order.
  void AddModulated(const std::string& sort, const Angle& angle, int last, const Eigen::VectorXd& factor,
                    const std::string& words);
  /// Columns that differ from channel to channel (rows x k) in one place of their own.
  void AddRows(const std::string& sort, const std::string& where, int grid, const Series& rows, const Words& words);
  void AddRows(const std::string& sort, const std::string& where, const Eigen::MatrixXd& rows,
               const std::string& words);

  /// What the families added last are as signals of a twin.
  using Products = std::function<std::vector<Product>(const Eigen::VectorXd& shape, int grid_point)>;
  void Are(const Products& products);
  /// One value at a time, whatever the bench does.
  void GoByTime();
  /// The same, and nearly any values.
  void TakeAnyCourse();
  /// Whole orders of an angle, whose size follows what `factor` says.
  void AreHarmonics(const Angle& angle, const EffectSettings& factor);

  std::vector<Family> Take() { return std::move(families_); }

 private:
  std::shared_ptr<const Base> BaseOf(int grid, const Series& series) const;
  /// @param channel  Whose unit its size is told in; -1: of several.
  using AnyWords = std::function<std::string(int grid_point, const Eigen::VectorXd& shape)>;
  Family& New(const std::string& sort, const std::string& where, const std::string& on, int channel,
              const AnyWords& words);
  void AddOnPlaces(const std::string& sort, const std::shared_ptr<const Base>& base, const AnyWords& words, const Shape* shape,
                   const SeriesAt& at);

  std::shared_ptr<const Design> design_;
  std::vector<Family> families_;
  std::size_t last_ = 0;  // first of those added last
};

/// A signal without size. @param by  What it goes by, if anything.
EffectSettings SignalOf(const std::string& kind, const std::string& by = "",
                        const std::map<std::string, double>& parameters = {});

/// Its size follows (quantity - about) / per.
EffectSettings Following(EffectSettings signal, const std::string& times, double about = 0.0, double per = 1.0);

/// The signal alone: a wave of two columns, or one column.
std::vector<Product> WaveOf(const EffectSettings& signal);
std::vector<Product> ColumnOf(const EffectSettings& signal, double scale = 1.0);

/// Samples x k as rows of one channel.
Eigen::MatrixXd OnChannel(const Design& design, const Eigen::MatrixXd& samples, int channel);

// One lock each.
void AddByAngle(Collector& collect);
void AddByDirection(Collector& collect);
void AddBySpeed(Collector& collect);
void AddByLabel(Collector& collect);
void AddInTime(Collector& collect);
void AddByReading(Collector& collect);

}  // namespace twinbench::diagnose::unknown
