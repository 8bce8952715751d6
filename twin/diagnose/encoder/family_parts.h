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

/// @param covered  Named effects in the catalogue, whose shapes are not to come twice.
std::vector<Family> UnknownFamilies(const Context& context, const std::vector<std::string>& covered);

/// Whole orders from `first` to `last`.
std::vector<double> WholeOrders(int first, int last);

/// Length of the run in angle, in turns, and in time; never zero.
double Turns(const SignalContext& context);
double Duration_s(const SignalContext& context);

/// True if time and angle went together all the time, as in a single pass: then neither can be told from the other.
bool TimeFollowsAngle(const SignalContext& context);

/// Each row of `columns` times the entry of `factor`.
Eigen::MatrixXd Times(const Eigen::MatrixXd& columns, const Eigen::VectorXd& factor);

}  // namespace twinbench::diagnose::encoder
