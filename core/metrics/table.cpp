#include "core/metrics/table.h"

#include <array>
#include <charconv>
#include <cmath>

namespace pmesh {
namespace {

using std::string;
using std::string_view;

Error usage(string message) { return {ErrorCode::usage, std::move(message)}; }

// Calls set(name, value) for each of "name=value,name=value"; set says whether it knows the name.
template <class Set>
Status parse_parameters(string_view text, Set set) {
  while (!text.empty()) {
    const string_view item = text.substr(0, text.find(','));
    text.remove_prefix(std::min(text.size(), item.size() + 1));
    const std::size_t equals = item.find('=');
    const string_view name = item.substr(0, equals);
    const string_view digits = equals == string_view::npos ? "" : item.substr(equals + 1);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.begin(), digits.end(), value);
    if (error != std::errc() || end != digits.end() || !std::isfinite(value)) {
      return usage("metric parameter '" + string(item) + "': expected name=number");
    }
    if (!set(name, value)) return usage("unknown metric parameter '" + string(name) + "'");
  }
  return {};
}

Result<AnyMetric> make_melod(string_view parameters) {
  double lambda = Melod::kDefaultLambda;
  const Status parsed = parse_parameters(parameters, [&](string_view name, double value) {
    if (name == "lambda") lambda = value;
    return name == "lambda";
  });
  if (!parsed) return parsed.error();
  if (lambda < 0) return usage("metric parameter 'lambda' must not be negative");
  return AnyMetric(Melod(lambda));
}

string parameters_of(const Melod& melod) {
  std::array<char, 32> digits{};
  const auto result = std::to_chars(digits.begin(), digits.end(), melod.lambda());
  return "lambda=" + string(digits.begin(), result.ptr);
}

// In the order of AnyMetric's alternatives.
constexpr std::array<MetricRow, std::variant_size_v<AnyMetric>> kTable = {{
    {"melod", "visual importance and face rotation (Hussain, Okada, Niijima 2004)", make_melod},
}};

}  // namespace

std::span<const MetricRow> metric_table() { return kTable; }

Result<AnyMetric> make_metric(string_view name, string_view parameters) {
  string known;
  for (const MetricRow& row : kTable) {
    if (row.name == name) return row.make(parameters);
    known += (known.empty() ? "" : ", ") + string(row.name);
  }
  return usage("unknown metric '" + string(name) + "' (known: " + known + ")");
}

string_view metric_name(const AnyMetric& metric) { return kTable[metric.index()].name; }

string metric_parameters(const AnyMetric& metric) {
  return std::visit([](const auto& m) { return parameters_of(m); }, metric);
}

}  // namespace pmesh
