#pragma once

#include <memory>
#include <string>
#include <vector>

#include "twin/diagnose/encoder/families.h"
#include "twin/diagnose/engine/catalogue_parts.h"

/// What the makers of families have in common; only families.cc, named_families.cc and unknown_families.cc need it.
namespace twinbench::diagnose::encoder {

using Context = std::shared_ptr<const SignalContext>;
using Columns = std::function<Eigen::MatrixXd(int grid_point)>;
using ColumnsAt = std::function<Eigen::MatrixXd(const Eigen::VectorXd& shape)>;
using Parameters = std::function<std::vector<ParameterEstimate>(
    const Eigen::VectorXd& shape, const Eigen::VectorXd& amplitudes, const Eigen::MatrixXd& cov)>;

/// Prior size of an amplitude that Families sets from the plausible trace.
inline constexpr double kPriorToBeSet = -1.0;

/// @param plausible_rad  Size of a trace in the readings that is worth a candidate.
std::vector<Family> NamedFamilies(const Context& context, double plausible_rad);

/// Structure without a name.
std::vector<Family> UnknownFamilies(const EncoderRun& encoder, double plausible_rad);

/// Whole orders from `first` to `last`.
std::vector<double> WholeOrders(int first, int last);

}  // namespace twinbench::diagnose::encoder
