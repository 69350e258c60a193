#include <gtest/gtest.h>

#include "core/metrics/table.h"

namespace pmesh {
namespace {

TEST(MetricTable, MakesEveryMetricItLists) {
  for (const MetricRow& row : metric_table()) {
    const Result<AnyMetric> metric = make_metric(row.name);
    ASSERT_TRUE(metric) << row.name;
    EXPECT_EQ(metric_name(*metric), row.name);
  }
}

TEST(MetricTable, ParametersRoundTrip) {
  const Result<AnyMetric> metric = make_metric("melod", "lambda=12.5");
  ASSERT_TRUE(metric);
  EXPECT_EQ(metric_parameters(*metric), "lambda=12.5");
  EXPECT_EQ(metric_parameters(*make_metric("melod")), "lambda=10");
}

TEST(MetricTable, RefusesUnknownMetrics) {
  const Result<AnyMetric> metric = make_metric("melodie");
  ASSERT_FALSE(metric);
  EXPECT_EQ(metric.error().code, ErrorCode::usage);
  EXPECT_TRUE(metric.error().message.starts_with("unknown metric 'melodie' (known: "));
}

TEST(MetricTable, RefusesBadParameters) {
  for (const char* text : {"lamda=1", "lambda", "lambda=", "lambda=x", "lambda=1x", "lambda=nan",
                           "lambda=-1", "=1", "lambda=1;2", ","}) {
    EXPECT_FALSE(make_metric("melod", text)) << text;
  }
}

}  // namespace
}  // namespace pmesh
