#include "core/draco/encode.h"

namespace pmesh {

std::unique_ptr<draco::Mesh> make_draco_faces(std::uint32_t vertices,
                                              const std::vector<Triangle>& triangles) {
  auto mesh = std::make_unique<draco::Mesh>();
  mesh->set_num_points(vertices);
  mesh->SetNumFaces(triangles.size());
  for (std::uint32_t f = 0; f < triangles.size(); ++f) {
    const auto [a, b, c] = triangles[f];
    mesh->SetFace(draco::FaceIndex(f),
                  {draco::PointIndex(a), draco::PointIndex(b), draco::PointIndex(c)});
  }
  return mesh;
}

Result<Bytes> run_draco(draco::ExpertEncoder& encoder) {
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeToBuffer(&buffer);
  if (!status.ok()) return runtime_error("Draco: " + status.error_msg_string());
  return Bytes(buffer.data(), buffer.data() + buffer.size());
}

}  // namespace pmesh
