// The metrics by name, with their parameters. A decimation visits one AnyMetric once; inside the
// engine the metric's type is known.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "core/base/result.h"
#include "core/metrics/blended_qem.h"
#include "core/metrics/feature_sensitive.h"
#include "core/metrics/melod.h"
#include "core/metrics/memoryless.h"
#include "core/metrics/qem.h"
#include "core/metrics/triangle_collapse.h"

namespace pmesh {

/// The default first.
using AnyMetric = std::variant<BlendedQem, Melod, QemSubset, QemSolved, Memoryless,
                               FeatureSensitive, TriangleCollapse>;

enum class ParameterKind : std::uint8_t { number, choice, flag };

/// A parameter of one or more metrics.
struct MetricParameter {
  std::string_view name;  ///< As on the command line ("--name") and in parameter text.
  ParameterKind kind;
  std::string_view values;  ///< Of a choice: "subset|solved".
  std::string_view help;
};

struct MetricRow {
  std::string_view name;                         ///< As on the command line and in the PM header.
  std::string_view summary;                      ///< One line for the help text.
  std::span<const std::string_view> parameters;  ///< Names of those that it takes.
};

/// All metrics, the default first.
std::span<const MetricRow> metric_table();
/// All parameters, each once.
std::span<const MetricParameter> parameter_table();

/// The metric of that name, its parameters as "name=value,name=value" (a flag: "name"); what is not
/// named keeps its default. An error of usage if the name, or a parameter, is not known to it.
Result<AnyMetric> make_metric(std::string_view name, std::string_view parameters = {});

std::string_view metric_name(const AnyMetric& metric);

/// All parameters in the form that make_metric takes, e.g. "lambda=10".
std::string metric_parameters(const AnyMetric& metric);

}  // namespace pmesh
