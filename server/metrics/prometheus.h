// The text that /metrics answers (Prometheus text format 0.0.4).
#pragma once

#include <cstddef>
#include <string>

#include "server/lod/lod_service.h"
#include "server/metrics/metrics.h"

namespace pmesh {

inline constexpr std::string_view kPrometheusType = "text/plain; version=0.0.4; charset=utf-8";

/// Reads the process's memory, descriptors and processor time from /proc too; what cannot be read
/// is left out. Threads: any.
std::string prometheus_text(const Metrics& metrics, const LodStatistics& lod, std::size_t meshes);

}  // namespace pmesh
