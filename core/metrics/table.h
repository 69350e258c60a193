// The published metrics by name. A decimation visits one AnyMetric once; inside the engine the
// metric's type is known.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "core/base/result.h"
#include "core/metrics/melod.h"

namespace pmesh {

using AnyMetric = std::variant<Melod>;

struct MetricRow {
  std::string_view name;     ///< As on the command line and in the PM header.
  std::string_view summary;  ///< One line for the help text.
  /// Makes the metric from "name=value,name=value"; what is not named keeps its default.
  Result<AnyMetric> (*make)(std::string_view parameters);
};

/// All metrics, the default first.
std::span<const MetricRow> metric_table();

/// The metric of that name; an error of usage if the name, or a parameter, is not known.
Result<AnyMetric> make_metric(std::string_view name, std::string_view parameters = {});

std::string_view metric_name(const AnyMetric& metric);

/// All parameters in the form that make_metric takes, e.g. "lambda=10".
std::string metric_parameters(const AnyMetric& metric);

}  // namespace pmesh
