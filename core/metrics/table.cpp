#include "core/metrics/table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

namespace pmesh {
namespace {

using std::string;
using std::string_view;

Error usage(string message) { return {ErrorCode::usage, std::move(message)}; }

constexpr std::array<MetricParameter, 6> kParameters = {{
    {"memory", ParameterKind::number, "",
     "blended-qem: weight of the input's planes beside those of the moment, 0 or more (default "
     "0.3)"},
    {"lambda", ParameterKind::number, "", "melod: weight of borders, 0 or more (default 10)"},
    {"placement", ParameterKind::choice, "subset|solved",
     "qem: a merged vertex stays at an end of its edge (subset, the default), or goes where the "
     "cost "
     "is least (solved)"},
    {"weight", ParameterKind::number, "",
     "feature-sensitive: what a unit normal is long beside the mesh's longest side, 0 or more "
     "(default 0.03)"},
    {"blow-up", ParameterKind::flag, "",
     "feature-sensitive: makes creases and corners dearer to simplify"},
    {"planarity", ParameterKind::number, "",
     "triangle: least angle between a triangle and those around it, in degrees (default 165)"},
}};

constexpr std::array<string_view, 1> kBlendedParameters = {"memory"};
constexpr std::array<string_view, 1> kMelodParameters = {"lambda"};
constexpr std::array<string_view, 1> kQemParameters = {"placement"};
constexpr std::array<string_view, 2> kFeatureParameters = {"weight", "blow-up"};
constexpr std::array<string_view, 1> kTriangleParameters = {"planarity"};

constexpr std::array<MetricRow, 6> kTable = {{
    {"blended-qem", "quadrics of the moment's faces and, less, of the input's; vertices stay put",
     kBlendedParameters},
    {"melod", "visual importance and face rotation (Hussain, Okada, Niijima 2004)",
     kMelodParameters},
    {"qem", "quadric error metric (Garland, Heckbert 1997)", kQemParameters},
    {"memoryless", "swept volume, volume preserved (Lindstrom, Turk 1998)", {}},
    {"feature-sensitive", "quadrics of positions and normals (Wei, Lou 2010)", kFeatureParameters},
    {"triangle", "triangles to their centroid (Ali, Rahmat, Khalid, Ng 2011)", kTriangleParameters},
}};

// Parameters by name, as text.
class ParameterText {
 public:
  // Fails if an item is malformed or not one of `row`'s.
  static Result<ParameterText> parse(string_view text, const MetricRow& row) {
    ParameterText parsed;
    while (!text.empty()) {
      const string_view item = text.substr(0, text.find(','));
      text.remove_prefix(std::min(text.size(), item.size() + 1));
      const std::size_t equals = item.find('=');
      const string_view name = item.substr(0, equals);
      if (std::find(row.parameters.begin(), row.parameters.end(), name) == row.parameters.end()) {
        return usage("metric " + string(row.name) + " has no parameter '" + string(name) + "'");
      }
      parsed.items_.push_back(
          {name, equals == string_view::npos ? string_view() : item.substr(equals + 1)});
    }
    return parsed;
  }

  Result<bool> flag(string_view name) const {
    const std::optional<string_view> text = find(name);
    if (text && !text->empty()) {
      return usage("metric parameter '" + string(name) + "' takes no value");
    }
    return text.has_value();
  }

  // The number of that name, `fallback` if it is not given.
  Result<double> number(string_view name, double fallback, double least, double most) const {
    const std::optional<string_view> text = find(name);
    if (!text) return fallback;
    double value = 0;
    const auto [end, error] = std::from_chars(text->begin(), text->end(), value);
    if (error != std::errc() || end != text->end() || !(value >= least && value <= most)) {
      return usage("metric parameter '" + string(name) + "': expected a number from " +
                   shortest(least) + " to " + shortest(most));
    }
    return value;
  }

  // Which of the two values is given; `fallback` if none is.
  Result<bool> is_first(string_view name, string_view first, string_view second,
                        bool fallback) const {
    const std::optional<string_view> text = find(name);
    if (!text) return fallback;
    if (*text != first && *text != second) {
      return usage("metric parameter '" + string(name) + "': expected " + string(first) + " or " +
                   string(second));
    }
    return *text == first;
  }

  static string shortest(double value) {
    std::array<char, 32> digits{};
    const auto result = std::to_chars(digits.begin(), digits.end(), value);
    return {digits.begin(), result.ptr};
  }

 private:
  struct Item {
    string_view name, value;
  };

  std::optional<string_view> find(string_view name) const {
    for (const Item& item : items_) {
      if (item.name == name) return item.value;
    }
    return std::nullopt;
  }

  std::vector<Item> items_;
};

Result<AnyMetric> make_blended_qem(const ParameterText& text) {
  const Result<double> memory = text.number("memory", BlendedQem::kDefaultMemory, 0, 1e6);
  if (!memory) return memory.error();
  return AnyMetric(BlendedQem(*memory));
}

Result<AnyMetric> make_melod(const ParameterText& text) {
  const Result<double> lambda = text.number("lambda", Melod::kDefaultLambda, 0, 1e6);
  if (!lambda) return lambda.error();
  return AnyMetric(Melod(*lambda));
}

Result<AnyMetric> make_qem(const ParameterText& text) {
  const Result<bool> subset = text.is_first("placement", "subset", "solved", true);
  if (!subset) return subset.error();
  return *subset ? AnyMetric(QemSubset()) : AnyMetric(QemSolved());
}

Result<AnyMetric> make_feature_sensitive(const ParameterText& text) {
  const Result<double> weight = text.number("weight", FeatureSensitive::kDefaultWeight, 0, 1e3);
  if (!weight) return weight.error();
  const Result<bool> blow_up = text.flag("blow-up");
  if (!blow_up) return blow_up.error();
  return AnyMetric(FeatureSensitive(*weight, *blow_up));
}

Result<AnyMetric> make_triangle(const ParameterText& text) {
  const Result<double> planarity =
      text.number("planarity", TriangleCollapse::kDefaultPlanarity, 0, 180);
  if (!planarity) return planarity.error();
  return AnyMetric(TriangleCollapse(*planarity));
}

Result<AnyMetric> make_memoryless(const ParameterText& /*text*/) { return AnyMetric(Memoryless()); }

// In the order of kTable.
constexpr std::array<Result<AnyMetric> (*)(const ParameterText&), kTable.size()> kMakers = {
    make_blended_qem, make_melod, make_qem, make_memoryless, make_feature_sensitive, make_triangle};

string parameters_of(const Melod& melod) {
  return "lambda=" + ParameterText::shortest(melod.lambda());
}
string parameters_of(const QemSubset&) { return "placement=subset"; }
string parameters_of(const QemSolved&) { return "placement=solved"; }
string parameters_of(const FeatureSensitive& metric) {
  return "weight=" + ParameterText::shortest(metric.weight()) +
         (metric.blow_up() ? ",blow-up" : "");
}
string parameters_of(const TriangleCollapse& triangle) {
  return "planarity=" + ParameterText::shortest(triangle.planarity());
}
string parameters_of(const Memoryless&) { return ""; }
string parameters_of(const BlendedQem& blended) {
  return "memory=" + ParameterText::shortest(blended.memory());
}

}  // namespace

std::span<const MetricRow> metric_table() { return kTable; }
std::span<const MetricParameter> parameter_table() { return kParameters; }

Result<AnyMetric> make_metric(string_view name, string_view parameters) {
  string known;
  for (const MetricRow& row : kTable) {
    known += (known.empty() ? "" : ", ") + string(row.name);
    if (row.name != name) continue;
    const Result<ParameterText> text = ParameterText::parse(parameters, row);
    if (!text) return text.error();
    return kMakers[static_cast<std::size_t>(&row - kTable.data())](*text);
  }
  return usage("unknown metric '" + string(name) + "' (known: " + known + ")");
}

string_view metric_name(const AnyMetric& metric) {
  return std::visit([](const auto& m) { return m.kName; }, metric);
}

string metric_parameters(const AnyMetric& metric) {
  return std::visit([](const auto& m) { return parameters_of(m); }, metric);
}

}  // namespace pmesh
