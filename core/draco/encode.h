// What both rooms that write Draco share: a triangle mesh as Draco's own, and its bytes.
//
// Threads: pure functions. They throw std::bad_alloc for want of memory, as Draco does.
#pragma once

#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include <draco/attributes/point_attribute.h>
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/base/vec3.h"
#include "core/mesh/indexed_mesh.h"

namespace pmesh {

/// Points and faces, without attributes.
std::unique_ptr<draco::Mesh> make_draco_faces(std::uint32_t vertices,
                                              const std::vector<Triangle>& triangles);

/// A mesh whose one attribute, with the id 0, is the positions of its vertices.
template <class T>
std::unique_ptr<draco::Mesh> make_draco_mesh(const std::vector<Vec3<T>>& positions,
                                             const std::vector<Triangle>& triangles) {
  constexpr draco::DataType kType = std::is_same_v<T, std::int32_t> ? draco::DT_INT32
                                    : std::is_same_v<T, float>      ? draco::DT_FLOAT32
                                                                    : draco::DT_FLOAT64;
  static_assert(kType != draco::DT_FLOAT64 || std::is_same_v<T, double>);
  const auto vertices = static_cast<std::uint32_t>(positions.size());
  auto mesh = make_draco_faces(vertices, triangles);
  draco::GeometryAttribute attribute;
  attribute.Init(draco::GeometryAttribute::POSITION, nullptr, 3, kType, false, sizeof(Vec3<T>), 0);
  const int id = mesh->AddAttribute(attribute, true, vertices);
  for (draco::AttributeValueIndex v(0); v < vertices; ++v) {
    mesh->attribute(id)->SetAttributeValue(v, &positions[v.value()]);
  }
  return mesh;
}

/// Runs an encoder that is set up. Fails (runtime) with what Draco says.
Result<Bytes> run_draco(draco::ExpertEncoder& encoder);

}  // namespace pmesh
